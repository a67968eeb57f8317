#pragma once
// The test for definiteness: LDL^T over lanes, declared in projection.h.

#include "runtime/lanes/projection_vector.h"

namespace ergon::lanes {
namespace {

template <int N>
unsigned definite(const Scalar* packed) {
  Real a[N * (N + 1) / 2];
#pragma GCC unroll 78
  for (int i = 0; i < N * (N + 1) / 2; ++i) a[i] = load(packed + i * kWidth);
  Real largest = splat(0);
#pragma GCC unroll 12
  for (int i = 0; i < N; ++i) largest = max(a[i * (i + 3) / 2], largest);
  // The second term lets a zero matrix pass.
  Real shift = largest * (kShift * N) + kNegligible;
  Mask good = less(largest, splat(kHuge));
#pragma GCC unroll 12
  for (int k = 0; k < N; ++k) {
    Real pivot = a[k * (k + 3) / 2] + shift;
    good = both(good, less(splat(0), pivot));
    if (k == N - 1) break;
    Real inverse = 1 / pivot;
#pragma GCC unroll 12
    for (int i = k + 1; i < N; ++i) {
      Real l = a[i * (i + 1) / 2 + k] * inverse;
#pragma GCC unroll 12
      for (int j = k + 1; j <= i; ++j) a[i * (i + 1) / 2 + j] -= l * a[j * (j + 1) / 2 + k];
    }
  }
  return bits(good);
}

}  // namespace
}  // namespace ergon::lanes
