#pragma once
// The projection, declared in projection.h.

#include "runtime/lanes/projection_ql.h"
#include "runtime/lanes/projection_tridiagonal.h"

namespace ergon::lanes {
namespace {

template <int N>
void project_lanes(double* packed, Negative mode, unsigned lanes) {
  constexpr int kEntries = N * (N + 1) / 2;
  Tridiagonal<N> t;
  Real largest = splat(0);
  Mask chosen = from_bits(lanes);
  Mask finite = chosen;
  for (int i = 0; i < kEntries; ++i) {
    Real a = abs(load(packed + i * kWidth));
    largest = max(a, largest);
    finite = both(finite, less(a, splat(__builtin_inf())));
  }
  if (!any(finite)) return;
  largest = max(largest, splat(1e-290));
  Real scale = 1 / largest;
  for (int i = 0; i < kEntries; ++i) t.u[i] = select(finite, load(packed + i * kWidth) * scale, splat(0));
  tridiagonalise(t);

  Real z[N][N];
  for (int c = 0; c < N; ++c) {
    for (int r = 0; r < N; ++r) z[c][r] = splat(r == c);
    apply_reflections(t, z[c]);
  }
  ql_iterate<N>(t.d, t.e, z);
  Real factor = largest * (mode == Negative::clamp ? 1.0 : 2.0);
  for (int c = 0; c < N; ++c) {
    Real weight = select(less(t.d[c], splat(0)), -t.d[c] * factor, splat(0));
    for (int i = 0; i < N; ++i) {
      Real w = weight * z[c][i];
      for (int j = 0; j <= i; ++j) {
        double* entry = packed + (i * (i + 1) / 2 + j) * kWidth;
        store(entry, select(finite, load(entry) + w * z[c][j], load(entry)));
      }
    }
  }
}

}  // namespace
}  // namespace ergon::lanes
