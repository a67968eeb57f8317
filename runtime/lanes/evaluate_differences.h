#pragma once
// Element matrices of stencils whose q is the differences between one point, the apex, and each other point: their
// blocks are those of the q-Hessian itself, and minus sums of these for the apex. Included only by files in
// runtime/lanes.

#include "runtime/lanes/evaluate_shape.h"

namespace ergon::lanes {
namespace {

// The apex and, for each vector of q, the point that it leads to, or from if the sign is negative.
struct Differences {
  bool apply = false;
  int apex = 0;
  int tip[kMaxVectors] = {};
  double sign[kMaxVectors] = {};
};

template <class S>
inline Differences find_differences(const Stencils& s) {
  Differences d;
  const int n = S::points(s);
  if (S::kSource != Source::kernel || n != S::kVectors + 1) return d;
  const auto weight = [&](int k, int a) { return s.weights[k * n + a]; };
  const auto in_all = [&](int a) {
    for (int k = 0; k < S::kVectors; ++k) {
      if (weight(k, a) == 0) return false;
    }
    return true;
  };
  while (d.apex < n && !in_all(d.apex)) ++d.apex;
  if (d.apex == n) return d;
  unsigned tips = 0;
  for (int k = 0; k < S::kVectors; ++k) {
    d.sign[k] = -weight(k, d.apex);
    for (int a = 0; a < n; ++a) {
      if (a == d.apex || weight(k, a) == 0) continue;
      if (d.tip[k] != 0 || tips >> a & 1 || weight(k, a) != d.sign[k]) return d;
      d.tip[k] = a + 1;
      tips |= 1u << a;
    }
    if (d.tip[k] == 0 || (d.sign[k] != 1 && d.sign[k] != -1)) return d;
  }
  for (int k = 0; k < S::kVectors; ++k) --d.tip[k];
  d.apply = true;
  return d;
}

// As element_matrix in runtime/lanes/evaluate_hessian.h, from one packed q-Hessian.
template <class S>
inline void difference_matrix(const Differences& d, const Scalar* packed, Scalar* element) {
  // Stores a block of rows of point a and columns of point b; those above the diagonal are kept transposed.
  const auto put = [&](int a, int b, const Real(&block)[3][3]) {
    const bool below = a >= b;
    Scalar* out = element + 9L * (below ? a * (a + 1) / 2 + b : b * (b + 1) / 2 + a) * kWidth;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) store(out + (below ? 3 * c + r : 3 * r + c) * kWidth, block[r][c]);
    }
  };
  Real corner[3][3] = {};
#pragma GCC unroll 4
  for (int l = 0; l < S::kVectors; ++l) {
    Real sum[3][3] = {};
#pragma GCC unroll 4
    for (int k = 0; k < S::kVectors; ++k) {
      const Scalar sign = d.sign[k] * d.sign[l];
      Real block[3][3];
#pragma GCC unroll 3
      for (int r = 0; r < 3; ++r) {
#pragma GCC unroll 3
        for (int c = 0; c < 3; ++c) {
          const int i = 3 * k + r, j = 3 * l + c;
          block[r][c] = sign * load(packed + (i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i) * kWidth);
          sum[r][c] -= block[r][c];
        }
      }
      if (k >= l) put(d.tip[k], d.tip[l], block);
    }
    put(d.apex, d.tip[l], sum);
#pragma GCC unroll 3
    for (int r = 0; r < 3; ++r) {
#pragma GCC unroll 3
      for (int c = 0; c < 3; ++c) corner[r][c] -= sum[r][c];
    }
  }
  put(d.apex, d.apex, corner);
}

}  // namespace
}  // namespace ergon::lanes
