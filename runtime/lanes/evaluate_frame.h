#pragma once
// Membranes and lines whose kernel is given F - I: their F at rest is a rotation R of the first columns of the
// identity, so the kernel sees R'q, in the axes of the element at rest, and what it gives is turned back to those of
// space. Included only by files in runtime/lanes.

#include "runtime/lanes/evaluate_parts.h"

namespace ergon::lanes {
namespace {

template <class S>
class Frame {
 public:
  static constexpr bool kFlat = S::kDensity && S::kVectors < 3;

  Frame(const Stencils& s, int block, int quadrature) {
    if constexpr (kFlat) {
      if (s.frames == nullptr) return;
      turns_ = true;
      const double* r = s.frames + (static_cast<long>(block) * s.quadrature + quadrature) * 9 * kWidth;
      for (int i = 0; i < 9; ++i) axis_[i] = load(r + i * kWidth);
    }
  }
  bool turns() const { return kFlat && turns_; }

  // Every vector of q, in place.
  void to_element(Scalar* q) const {
    for (int k = 0; turns() && k < S::kVectors; ++k, q += 3 * kWidth) {
      const Real v[3] = {load(q), load(q + kWidth), load(q + 2 * kWidth)};
      for (int c = 0; c < 3; ++c)
        store(q + c * kWidth, axis_[3 * c] * v[0] + axis_[3 * c + 1] * v[1] + axis_[3 * c + 2] * v[2]);
    }
  }
  void to_space(Scalar* q) const {
    for (int k = 0; turns() && k < S::kVectors; ++k, q += 3 * kWidth) {
      const Real v[3] = {load(q), load(q + kWidth), load(q + 2 * kWidth)};
      for (int c = 0; c < 3; ++c) store(q + c * kWidth, axis_[c] * v[0] + axis_[3 + c] * v[1] + axis_[6 + c] * v[2]);
    }
  }
  void to_space(Vector& v) const {
    if (!turns()) return;
    const Vector u = v;
    v.x = axis_[0] * u.x + axis_[3] * u.y + axis_[6] * u.z;
    v.y = axis_[1] * u.x + axis_[4] * u.y + axis_[7] * u.z;
    v.z = axis_[2] * u.x + axis_[5] * u.y + axis_[8] * u.z;
  }
  // A Hessian, packed, whole or in parts.
  void hessian_to_space(const Parts& parts, Scalar* packed) const {
    if (!turns()) return;
    if (parts.count == 0) turn_blocks(packed, S::kVectors);
    for (int part = 0; part < parts.count; ++part)
      turn_blocks(packed + static_cast<long>(parts.first[part]) * kWidth, parts.vectors[part]);
  }

 private:
  // H -> R H R' for every 3x3 block of a lower triangle over `vectors` vectors.
  void turn_blocks(Scalar* packed, int vectors) const {
    for (int i = 0; i < vectors; ++i) {
      for (int j = 0; j <= i; ++j) {
        Real h[3][3], half[3][3];
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c) h[r][c] = load(packed + part_entry(i, j, r, c) * kWidth);
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c) half[r][c] = axis_[r] * h[0][c] + axis_[3 + r] * h[1][c] + axis_[6 + r] * h[2][c];
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < (i == j ? r + 1 : 3); ++c)
            store(packed + part_entry(i, j, r, c) * kWidth,
                  half[r][0] * axis_[c] + half[r][1] * axis_[3 + c] + half[r][2] * axis_[6 + c]);
      }
    }
  }

  bool turns_ = false;
  Real axis_[9] = {};  // of the element, one after the other; the first are its tangents
};

}  // namespace
}  // namespace ergon::lanes
