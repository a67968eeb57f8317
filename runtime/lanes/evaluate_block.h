#pragma once
// Moves data between vertices and lanes: gathers positions, adds gradients and 3x3 blocks. Included only by files in
// runtime/lanes. Lanes are added one after the other, so a sum has the same order for every number of threads.

#include "runtime/lanes/lanes.h"
#include "runtime/lanes/projection_vector.h"

namespace ergon::lanes {
namespace {

// The row of one vertex: x, y, z and padding.
typedef double Row __attribute__((vector_size(32), may_alias));
typedef double Pair __attribute__((vector_size(16), aligned(8), may_alias));

struct Vector3 {
  Real c[3];
};

inline Row load_row(const double* rows, int vertex) {
  return *reinterpret_cast<const Row*>(rows + 4 * static_cast<long>(vertex));
}

inline void add_row(double* rows, int vertex, Row value) {
  *reinterpret_cast<Row*>(rows + 4 * static_cast<long>(vertex)) += value;
}

#if ERGON_LANES == 8

inline Vector3 gather(const double* rows, const int* vertices) {
  Real pair[4];
  for (int l = 0; l < 4; ++l) {
    const Row low = load_row(rows, vertices[l]), high = load_row(rows, vertices[l + 4]);
    pair[l] = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
  }
  const Real xz01 = __builtin_shufflevector(pair[0], pair[1], 0, 8, 2, 10, 4, 12, 6, 14);
  const Real xz23 = __builtin_shufflevector(pair[2], pair[3], 0, 8, 2, 10, 4, 12, 6, 14);
  const Real y01 = __builtin_shufflevector(pair[0], pair[1], 1, 9, 3, 11, 5, 13, 7, 15);
  const Real y23 = __builtin_shufflevector(pair[2], pair[3], 1, 9, 3, 11, 5, 13, 7, 15);
  return {{__builtin_shufflevector(xz01, xz23, 0, 1, 8, 9, 4, 5, 12, 13),
           __builtin_shufflevector(y01, y23, 0, 1, 8, 9, 4, 5, 12, 13),
           __builtin_shufflevector(xz01, xz23, 2, 3, 10, 11, 6, 7, 14, 15)}};
}

inline void scatter(double* rows, const int* vertices, int count, const Vector3& v) {
  const Real zero{};
  const Real xy_even = __builtin_shufflevector(v.c[0], v.c[1], 0, 8, 2, 10, 4, 12, 6, 14);
  const Real xy_odd = __builtin_shufflevector(v.c[0], v.c[1], 1, 9, 3, 11, 5, 13, 7, 15);
  const Real z_even = __builtin_shufflevector(v.c[2], zero, 0, 8, 2, 10, 4, 12, 6, 14);
  const Real z_odd = __builtin_shufflevector(v.c[2], zero, 1, 9, 3, 11, 5, 13, 7, 15);
  alignas(64) double lane[32];
  store(lane, __builtin_shufflevector(xy_even, z_even, 0, 1, 8, 9, 2, 3, 10, 11));         // lanes 0 and 2
  store(lane + 8, __builtin_shufflevector(xy_odd, z_odd, 0, 1, 8, 9, 2, 3, 10, 11));       // 1 and 3
  store(lane + 16, __builtin_shufflevector(xy_even, z_even, 4, 5, 12, 13, 6, 7, 14, 15));  // 4 and 6
  store(lane + 24, __builtin_shufflevector(xy_odd, z_odd, 4, 5, 12, 13, 6, 7, 14, 15));    // 5 and 7
  for (int l = 0; l < count; ++l) {
    const int place = 16 * (l >> 2) + 8 * (l & 1) + 4 * ((l >> 1) & 1);
    add_row(rows, vertices[l], *reinterpret_cast<const Row*>(lane + place));
  }
}

#elif ERGON_LANES == 4

inline Vector3 gather(const double* rows, const int* vertices) {
  const Row r0 = load_row(rows, vertices[0]), r1 = load_row(rows, vertices[1]);
  const Row r2 = load_row(rows, vertices[2]), r3 = load_row(rows, vertices[3]);
  const Row xz01 = __builtin_shufflevector(r0, r1, 0, 4, 2, 6), xz23 = __builtin_shufflevector(r2, r3, 0, 4, 2, 6);
  const Row y01 = __builtin_shufflevector(r0, r1, 1, 5, 3, 7), y23 = __builtin_shufflevector(r2, r3, 1, 5, 3, 7);
  return {{__builtin_shufflevector(xz01, xz23, 0, 1, 4, 5), __builtin_shufflevector(y01, y23, 0, 1, 4, 5),
           __builtin_shufflevector(xz01, xz23, 2, 3, 6, 7)}};
}

inline void scatter(double* rows, const int* vertices, int count, const Vector3& v) {
  const Real zero{};
  const Real xy_even = __builtin_shufflevector(v.c[0], v.c[1], 0, 4, 2, 6);
  const Real xy_odd = __builtin_shufflevector(v.c[0], v.c[1], 1, 5, 3, 7);
  const Real z_even = __builtin_shufflevector(v.c[2], zero, 0, 4, 2, 6);
  const Real z_odd = __builtin_shufflevector(v.c[2], zero, 1, 5, 3, 7);
  const Row lane[4] = {
      __builtin_shufflevector(xy_even, z_even, 0, 1, 4, 5), __builtin_shufflevector(xy_odd, z_odd, 0, 1, 4, 5),
      __builtin_shufflevector(xy_even, z_even, 2, 3, 6, 7), __builtin_shufflevector(xy_odd, z_odd, 2, 3, 6, 7)};
  for (int l = 0; l < count; ++l) add_row(rows, vertices[l], lane[l]);
}

#else

inline Vector3 gather(const double* rows, const int* vertices) {
  const double* row = rows + 4 * static_cast<long>(vertices[0]);
  return {{row[0], row[1], row[2]}};
}

inline void scatter(double* rows, const int* vertices, int, const Vector3& v) {
  double* row = rows + 4 * static_cast<long>(vertices[0]);
  for (int c = 0; c < 3; ++c) row[c] += v.c[c];
}

#endif

// Exchanges block and transpose in the lanes whose slot says so; returns them as bits.
inline unsigned transpose_where_needed(Real* block, const int* slots) {
  unsigned lanes = 0;
  for (int l = 0; l < kWidth; ++l) lanes |= (slots[l] >= 0 ? static_cast<unsigned>(slots[l]) & 1u : 0u) << l;
  if (lanes == 0) return 0;
  const Mask turned = from_bits(lanes);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < r; ++c) {
      const Real lower = block[3 * c + r], upper = block[3 * r + c];
      block[3 * c + r] = select(turned, upper, lower);
      block[3 * r + c] = select(turned, lower, upper);
    }
  }
  return lanes;
}

// Adds a 3x3 block per lane, column by column, to the matrix. `diagonal`: only the lower triangle.
template <bool diagonal>
inline __attribute__((always_inline)) void scatter_block(double* values, const int* slots, const int* strides,
                                                         int count, const Real* block) {
#if ERGON_LANES == 1
  (void)count;
  if (slots[0] == kFixedSlot) return;
  double* place = values + 3 * static_cast<long>(slots[0] >> 1);
  for (int c = 0; c < 3; ++c, place += strides[0]) {
    for (int r = diagonal ? c : 0; r < 3; ++r) place[r] += block[3 * c + r];
  }
#else
  // Rows 0 and 1 of a column are adjacent in the matrix: interleave them so that they move as one.
  alignas(64) double pairs[3][2 * kWidth], thirds[3][kWidth];
  for (int c = 0; c < 3; ++c) {
    const Real first = block[3 * c], second = block[3 * c + 1];
#if ERGON_LANES == 8
    store(pairs[c], __builtin_shufflevector(first, second, 0, 8, 2, 10, 4, 12, 6, 14));
    store(pairs[c] + 8, __builtin_shufflevector(first, second, 1, 9, 3, 11, 5, 13, 7, 15));
#else
    store(pairs[c], __builtin_shufflevector(first, second, 0, 4, 2, 6));
    store(pairs[c] + 4, __builtin_shufflevector(first, second, 1, 5, 3, 7));
#endif
    store(thirds[c], block[3 * c + 2]);
  }
  for (int l = 0; l < count; ++l) {
    if (slots[l] == kFixedSlot) continue;
    double* place = values + 3 * static_cast<long>(slots[l] >> 1);
    const int at = kWidth * (l & 1) + (l & ~1);
    for (int c = 0; c < 3; ++c, place += strides[l]) {
      if (!diagonal || c == 0) {
        *reinterpret_cast<Pair*>(place) += *reinterpret_cast<const Pair*>(pairs[c] + at);
      } else if (c == 1) {
        place[1] += pairs[c][at + 1];
      }
      place[2] += thirds[c][l];
    }
  }
#endif
}

}  // namespace
}  // namespace ergon::lanes
