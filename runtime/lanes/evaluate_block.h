#pragma once
// Moves data between lanes and memory: gathers positions, adds gradients and 3x3 blocks. Included only by files in
// runtime/lanes. Lanes are added one after the other, so a sum has the same order for every number of threads.

#include "runtime/lanes/lanes.h"
#include "runtime/lanes/projection_vector.h"

namespace ergon::lanes {
namespace {

// x, y, z of one vertex, or one column of a 3x3 block, and padding.
typedef double Row __attribute__((vector_size(32), may_alias));
typedef double Pair __attribute__((vector_size(16), aligned(8), may_alias));

struct Vector3 {
  Real c[3];
};

inline Row& row_at(double* rows, long place) { return *reinterpret_cast<Row*>(rows + place); }
inline Row row_at(const double* rows, long place) { return *reinterpret_cast<const Row*>(rows + place); }

// gather: the rows of W vertices as three vectors. to_rows: the way back, padded with zero.
#ifdef ERGON_SINGLE

#include "runtime/lanes/evaluate_block_single.h"

#elif ERGON_LANES == 8

inline Vector3 gather(const double* rows, const int* vertices) {
  Real pair[4];
  for (int l = 0; l < 4; ++l) {
    const Row low = row_at(rows, 4L * vertices[l]), high = row_at(rows, 4L * vertices[l + 4]);
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

inline void to_rows(Real x, Real y, Real z, Row* lane) {
  const Real zero{};
  const Real xy_even = __builtin_shufflevector(x, y, 0, 8, 2, 10, 4, 12, 6, 14);
  const Real xy_odd = __builtin_shufflevector(x, y, 1, 9, 3, 11, 5, 13, 7, 15);
  const Real z_even = __builtin_shufflevector(z, zero, 0, 8, 2, 10, 4, 12, 6, 14);
  const Real z_odd = __builtin_shufflevector(z, zero, 1, 9, 3, 11, 5, 13, 7, 15);
  const Real rows04 = __builtin_shufflevector(xy_even, z_even, 0, 1, 8, 9, 4, 5, 12, 13);
  const Real rows26 = __builtin_shufflevector(xy_even, z_even, 2, 3, 10, 11, 6, 7, 14, 15);
  const Real rows15 = __builtin_shufflevector(xy_odd, z_odd, 0, 1, 8, 9, 4, 5, 12, 13);
  const Real rows37 = __builtin_shufflevector(xy_odd, z_odd, 2, 3, 10, 11, 6, 7, 14, 15);
  const Real pairs[4] = {rows04, rows15, rows26, rows37};
  for (int l = 0; l < 4; ++l) {
    lane[l] = __builtin_shufflevector(pairs[l], pairs[l], 0, 1, 2, 3);
    lane[l + 4] = __builtin_shufflevector(pairs[l], pairs[l], 4, 5, 6, 7);
  }
}

#elif ERGON_LANES == 4

inline Vector3 gather(const double* rows, const int* vertices) {
  const Row r0 = row_at(rows, 4L * vertices[0]), r1 = row_at(rows, 4L * vertices[1]);
  const Row r2 = row_at(rows, 4L * vertices[2]), r3 = row_at(rows, 4L * vertices[3]);
  const Row xz01 = __builtin_shufflevector(r0, r1, 0, 4, 2, 6), xz23 = __builtin_shufflevector(r2, r3, 0, 4, 2, 6);
  const Row y01 = __builtin_shufflevector(r0, r1, 1, 5, 3, 7), y23 = __builtin_shufflevector(r2, r3, 1, 5, 3, 7);
  return {{__builtin_shufflevector(xz01, xz23, 0, 1, 4, 5), __builtin_shufflevector(y01, y23, 0, 1, 4, 5),
           __builtin_shufflevector(xz01, xz23, 2, 3, 6, 7)}};
}

inline void to_rows(Real x, Real y, Real z, Row* lane) {
  const Real zero{};
  const Real xy_even = __builtin_shufflevector(x, y, 0, 4, 2, 6), xy_odd = __builtin_shufflevector(x, y, 1, 5, 3, 7);
  const Real z_even = __builtin_shufflevector(z, zero, 0, 4, 2, 6),
             z_odd = __builtin_shufflevector(z, zero, 1, 5, 3, 7);
  lane[0] = __builtin_shufflevector(xy_even, z_even, 0, 1, 4, 5);
  lane[1] = __builtin_shufflevector(xy_odd, z_odd, 0, 1, 4, 5);
  lane[2] = __builtin_shufflevector(xy_even, z_even, 2, 3, 6, 7);
  lane[3] = __builtin_shufflevector(xy_odd, z_odd, 2, 3, 6, 7);
}

#elif ERGON_LANES == 2

// Two lanes are half a row: rows are moved in halves.
inline Vector3 gather(const double* rows, const int* vertices) {
  const double *first = rows + 4L * vertices[0], *second = rows + 4L * vertices[1];
  const Real xy0 = load(first), xy1 = load(second);
  return {{__builtin_shufflevector(xy0, xy1, 0, 2), __builtin_shufflevector(xy0, xy1, 1, 3),
           __builtin_shufflevector(load(first + 2), load(second + 2), 0, 2)}};
}

inline void to_rows(Real x, Real y, Real z, Row* lane) {
  const Real zero{};
  double* const rows = reinterpret_cast<double*>(lane);
  store(rows, __builtin_shufflevector(x, y, 0, 2));
  store(rows + 2, __builtin_shufflevector(z, zero, 0, 2));
  store(rows + 4, __builtin_shufflevector(x, y, 1, 3));
  store(rows + 6, __builtin_shufflevector(z, zero, 1, 3));
}

#else

inline Vector3 gather(const double* rows, const int* vertices) {
  const Scalar* row = rows + 4L * vertices[0];
  return {{row[0], row[1], row[2]}};
}

inline void to_rows(Real x, Real y, Real z, Row* lane) { lane[0] = Row{x, y, z, 0}; }

#endif

// Adds a vector per lane to the rows of the first `count` lanes' vertices.
inline void scatter(double* rows, const int* vertices, int count, const Vector3& v) {
  Row lane[kWidth];
  to_rows(v.c[0], v.c[1], v.c[2], lane);
  if (count == kWidth) {
    for (int l = 0; l < kWidth; ++l) row_at(rows, 4L * vertices[l]) += lane[l];
  } else {
    for (int l = 0; l < count; ++l) row_at(rows, 4L * vertices[l]) += lane[l];
  }
}

// Adds a 3x3 block per lane, given column by column as nine vectors, to the sums of a chunk.
inline void add_block(double* sums, const int* slots, const Scalar* block) {
  for (int c = 0; c < 3; ++c, block += 3 * kWidth) {
    Row lane[kWidth];
    to_rows(load(block), load(block + kWidth), load(block + 2 * kWidth), lane);
    for (int l = 0; l < kWidth; ++l) row_at(sums, slots[l] + 4 * c) += lane[l];
  }
}

// Exchanges block and transpose in the given lanes.
inline void transpose_lanes(Scalar* block, unsigned lanes) {
  const Mask turned = from_bits(lanes);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < r; ++c) {
      Scalar* const lower = block + (3 * c + r) * kWidth;
      Scalar* const upper = block + (3 * r + c) * kWidth;
      const Real a = load(lower), b = load(upper);
      store(lower, select(turned, b, a));
      store(upper, select(turned, a, b));
    }
  }
}

// Moves the sums of a chunk to the matrix and leaves zeros.
inline void flush_sums(double* sums, const ChunkBlocks& blocks, double* values) {
  constexpr int kAhead = 64;
  for (int i = 0; i < blocks.count; ++i, sums += kSumDoubles) {
    if (i + kAhead < blocks.count) {
      const double* ahead = values + blocks.offset[i + kAhead];
      const long stride = __builtin_abs(blocks.stride[i + kAhead]);
      for (int c = 0; c < 3; ++c) __builtin_prefetch(ahead + c * stride, 1);
    }
    double* place = values + blocks.offset[i];
    const bool stored = blocks.stride[i] < 0;
    const long stride = __builtin_abs(blocks.stride[i]);
    for (int c = 0; c < 3; ++c, place += stride) {
      const Pair old = stored ? Pair{} : *reinterpret_cast<const Pair*>(place);
      const double last = stored ? 0 : place[2];
      *reinterpret_cast<Pair*>(place) = old + *reinterpret_cast<const Pair*>(sums + 4 * c);
      place[2] = last + sums[4 * c + 2];
      row_at(sums, 4 * c) = Row{};
    }
  }
  for (int c = 0; c < 3; ++c) row_at(sums, 4 * c) = Row{};
}

}  // namespace
}  // namespace ergon::lanes
