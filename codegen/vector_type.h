#pragma once

namespace ergon {

// The vectors that a kernel is emitted for.
struct VectorType {
  int lanes = 1;        // doubles: 1, 2, 4 or 8; floats: 1, 4, 8 or 16
  bool single = false;  // floats

  VectorType(int count, bool floats = false) : lanes(count), single(floats) {}  // NOLINT: a number of doubles is one
  int bytes() const { return lanes * (single ? 4 : 8); }
  bool usable() const { return lanes == 1 || bytes() == 16 || bytes() == 32 || bytes() == 64; }
  const char* real() const { return single ? "float" : "double"; }
};

}  // namespace ergon
