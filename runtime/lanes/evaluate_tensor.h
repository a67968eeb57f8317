#pragma once
// One column of the element matrix of an element whose shape functions are products over three axes (Hex27), one axis
// after the other: 486 multiplications for each component where the sum over all points takes 2,187. Included only by
// files in runtime/lanes.

#include "runtime/lanes/evaluate_shape.h"

namespace ergon::lanes {
namespace {

// out[i] = (or +=) sum_p m[p][i] in[p] for three values, `step` apart.
template <bool Add>
inline void transpose_times(const double* m, const Real* in, Real* out, int step) {
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    Real sum = Add ? out[i * step] + splat(m[i]) * in[0] : splat(m[i]) * in[0];
    sum += splat(m[3 + i]) * in[step];
    sum += splat(m[6 + i]) * in[2 * step];
    out[i * step] = sum;
  }
}

// Component (row, column) of the blocks (a, b) for all a: sum over points p and axes i of (gradient of the shape
// function of a along i at p) half[p][i]. `half` is [27][3], of vectors. Where a < b, this is component (column, row)
// of (b, a): of components beside the diagonal one of two is enough, and of those on it one of (a, b) and (b, a).
inline void add_tensor_rows(const Stencils& s, const Scalar* half, int b, int row, int column, Scalar* element) {
  // Points instead of nodes first: there, a gradient along an axis takes only the points of that line.
  const double *between = s.axis, *values = s.axis + 9;
  const auto at = [half](int p, int i) { return load(half + (3L * p + i) * kWidth); };
  Real sum[27];
#pragma GCC unroll 9
  for (int line = 0; line < 9; ++line) {
    const Real along[3] = {at(line, 2), at(line + 9, 2), at(line + 18, 2)};
    Real summed[3];
    transpose_times<false>(between, along, summed, 1);
    for (int k = 0; k < 3; ++k) sum[line + 9 * k] = summed[k];
  }
  for (int k = 0; k < 3; ++k) {
    Real plane[9], in[9];
#pragma GCC unroll 9
    for (int i = 0; i < 9; ++i) plane[i] = sum[9 * k + i];
#pragma GCC unroll 9
    for (int i = 0; i < 9; ++i) in[i] = at(9 * k + i, 0);
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) transpose_times<true>(between, in + 3 * i, plane + 3 * i, 1);
#pragma GCC unroll 9
    for (int i = 0; i < 9; ++i) in[i] = at(9 * k + i, 1);
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) transpose_times<true>(between, in + i, plane + i, 3);
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) transpose_times<false>(values, plane + 3 * i, in + 3 * i, 1);
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) transpose_times<false>(values, in + i, sum + 9 * k + i, 3);
  }
  for (int line = 0; line < 9; ++line) {
    const int* const nodes = s.axis_nodes + line;
    if (row == column && nodes[0] < b && nodes[9] < b && nodes[18] < b) continue;
    Real summed[3];
    const Real in[3] = {sum[line], sum[line + 9], sum[line + 18]};
    transpose_times<false>(values, in, summed, 1);
#pragma GCC unroll 3
    for (int k = 0; k < 3; ++k) {
      const int a = nodes[9 * k];
      if (a >= b) store(element + (9L * (a * (a + 1) / 2 + b) + 3 * column + row) * kWidth, summed[k]);
      if (a <= b && row != column) {
        store(element + (9L * (b * (b + 1) / 2 + a) + 3 * row + column) * kWidth, summed[k]);
      }
    }
  }
}

}  // namespace
}  // namespace ergon::lanes
