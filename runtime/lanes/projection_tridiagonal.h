#pragma once
// Householder reduction of a symmetric matrix to tridiagonal form, one matrix per lane (Golub and Van Loan 2013, Matrix
// Computations, section 8.3.1). It establishes A = Q T Q', Q = H[N-1] ... H[2], H[i] = I - scale[i] u[i] u[i]'.

#include "runtime/lanes/projection_vector.h"

namespace ergon::lanes {
namespace {

template <int N>
struct Tridiagonal {
  Real d[N];                // diagonal of T
  Real e[N];                // e[i] = T(i + 1, i); e[N - 1] = 0
  Real u[N * (N + 1) / 2];  // u[i](j) at i*(i + 1)/2 + j, j < i
  Real scale[N];            // of H[i], i >= 2
};

// On entry the matrix stands in t.u, packed, no entry above 1; it is replaced by the Householder vectors.
template <int N>
inline void tridiagonalise(Tridiagonal<N>& t) {
  Real* a = t.u;
  t.e[N - 1] = splat(0);
#pragma GCC unroll 12
  for (int i = N - 1; i >= 2; --i) {
    Real* u = a + i * (i + 1) / 2;
    Real sum[2] = {splat(0), splat(0)};
#pragma GCC unroll 12
    for (int j = 0; j < i; ++j) sum[j & 1] += u[j] * u[j];
    Real squared = sum[0] + sum[1];
    // What is smaller has lost its digits to underflow, and is nothing beside 1.
    Mask regular = less(splat(1e-280), squared);
    squared = select(regular, squared, splat(1));
    Real norm = squared * rsqrt(squared);
    Real last = u[i - 1];
    Real signed_norm = select(less(last, splat(0)), -norm, norm);
    Real scale = select(regular, 1 / (squared + abs(last) * norm), splat(0));
    t.e[i - 1] = select(regular, -signed_norm, splat(0));
    u[i - 1] = last + signed_norm;
    t.scale[i] = scale;

    Real p[N];
#pragma GCC unroll 12
    for (int r = 0; r < i; ++r) {
      Real s = splat(0);
#pragma GCC unroll 12
      for (int c = 0; c < i; ++c) s += (c <= r ? a[r * (r + 1) / 2 + c] : a[c * (c + 1) / 2 + r]) * u[c];
      p[r] = s * scale;
    }
    Real dot[2] = {splat(0), splat(0)};
#pragma GCC unroll 12
    for (int j = 0; j < i; ++j) dot[j & 1] += u[j] * p[j];
    Real half = (dot[0] + dot[1]) * (scale * 0.5);
#pragma GCC unroll 12
    for (int j = 0; j < i; ++j) p[j] -= half * u[j];
#pragma GCC unroll 12
    for (int r = 0; r < i; ++r) {
#pragma GCC unroll 12
      for (int c = 0; c <= r; ++c) a[r * (r + 1) / 2 + c] -= u[r] * p[c] + p[r] * u[c];
    }
  }
  if constexpr (N > 1) t.e[0] = a[1];
#pragma GCC unroll 12
  for (int i = 0; i < N; ++i) t.d[i] = a[i * (i + 3) / 2];
}

// y -> Q y.
template <int N>
inline void apply_reflections(const Tridiagonal<N>& t, Real* y) {
#pragma GCC unroll 12
  for (int i = 2; i < N; ++i) {
    const Real* u = t.u + i * (i + 1) / 2;
    Real sum[2] = {splat(0), splat(0)};
#pragma GCC unroll 12
    for (int j = 0; j < i; ++j) sum[j & 1] += u[j] * y[j];
    Real s = (sum[0] + sum[1]) * t.scale[i];
#pragma GCC unroll 12
    for (int j = 0; j < i; ++j) y[j] -= s * u[j];
  }
}

}  // namespace
}  // namespace ergon::lanes
