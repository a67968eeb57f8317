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

// Row i of the matrix in t.u, which is packed; rows i + 1 and up are done.
template <int N, int i>
inline void reflect_row(Tridiagonal<N>& t) {
  Real* a = t.u;
  Real* u = a + i * (i + 1) / 2;  // until its last entry is changed, x = row i without its diagonal
  // With u = x + s e, e the last unit vector, A u = A x + s A e and u'A u = x'A x + s (2 e'A x + s e'A e): only s has
  // to wait for the norm of x.
  Real product[i];
#pragma GCC unroll 12
  for (int r = 0; r < i; ++r) {
    product[r] = splat(0);
#pragma GCC unroll 12
    for (int c = 0; c < i; ++c) product[r] += (c <= r ? a[r * (r + 1) / 2 + c] : a[c * (c + 1) / 2 + r]) * u[c];
  }
  const Real* column = a + (i - 1) * i / 2;
  const Real curvature = dot<i>(u, product);
  Real squared = dot<i>(u, u);
  // What is smaller has lost its digits to underflow, and is nothing beside 1.
  const Mask regular = less(splat(1e-280), squared);
  squared = max(squared, splat(1e-280));
  const Real norm = squared * rsqrt(squared);
  const Real last = u[i - 1];
  const Real s = copysign(norm, last);
  const Real scale = select(regular, 1 / (squared + abs(last) * norm), splat(0));
  t.scale[i] = scale;
  t.e[i - 1] = select(regular, -s, splat(0));
  u[i - 1] = last + s;

  const Real half = (0.5 * scale * scale) * (curvature + s * (2 * product[i - 1] + s * column[i - 1]));
  Real p[i];
#pragma GCC unroll 12
  for (int r = 0; r < i; ++r) p[r] = scale * (product[r] + s * column[r]) - half * u[r];
#pragma GCC unroll 12
  for (int r = i - 1; r >= 0; --r) {
#pragma GCC unroll 12
    for (int c = 0; c <= r; ++c) a[r * (r + 1) / 2 + c] -= u[r] * p[c] + p[r] * u[c];
  }
  if constexpr (i > 2) reflect_row<N, i - 1>(t);
}

// On entry the matrix stands in t.u, packed, no entry above 1; it is replaced by the Householder vectors.
template <int N>
inline void tridiagonalise(Tridiagonal<N>& t) {
  t.e[N - 1] = splat(0);
  if constexpr (N > 2) reflect_row<N, N - 1>(t);
  if constexpr (N > 1) t.e[0] = t.u[1];
#pragma GCC unroll 12
  for (int i = 0; i < N; ++i) t.d[i] = t.u[i * (i + 3) / 2];
}

// y -> Q y for each of `count` vectors, from reflection i on.
template <int N, int i = 2>
inline void apply_reflections(const Tridiagonal<N>& t, Real (*y)[N], int count) {
  if constexpr (i < N) {
    const Real* u = t.u + i * (i + 1) / 2;
    for (int k = 0; k < count; ++k) {
      const Real s = dot<i>(u, y[k]) * t.scale[i];
#pragma GCC unroll 12
      for (int j = 0; j < i; ++j) y[k][j] -= s * u[j];
    }
    apply_reflections<N, i + 1>(t, y, count);
  }
}

}  // namespace
}  // namespace ergon::lanes
