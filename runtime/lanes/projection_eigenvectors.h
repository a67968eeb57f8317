#pragma once
// Eigenvectors of a symmetric tridiagonal matrix per lane, from twisted factorisations (Dhillon and Parlett 2004,
// Multiple representations to compute orthogonal eigenvectors of symmetric tridiagonal matrices, Linear Algebra Appl.
// 387): the factorisations from the first row down and from the last row up meet in the row where their residual gamma
// is least, and (T - x) z = gamma e there. It establishes what each vector's residual is.

#include "runtime/lanes/projection_vector.h"

namespace ergon::lanes {
namespace {

struct TwistedResult {
  Real residual;    // norm of (T - x) z
  Real correction;  // x + correction is the Rayleigh quotient
};

// Writes a unit vector z, the last step of inverse iteration at x. e[i] is not zero, squares[i] = e[i]^2.
template <int N>
inline TwistedResult twisted_eigenvector(const Real* d, const Real* e, const Real* squares, Real x, Real* z) {
  // Keeps a pivot from being zero.
  const Real tiny = splat(1e-30);
  Real down[N], up[N];  // pivots of the factorisations from the first row and from the last
  Real down_ratio[N], up_ratio[N];
  down[0] = d[0] - x;
  up[N - 1] = d[N - 1] - x;
#pragma GCC unroll 12
  for (int i = 0; i + 1 < N; ++i) {
    Real inverse = 1 / (down[i] + tiny);
    down_ratio[i] = e[i] * inverse;
    down[i + 1] = (d[i + 1] - x) - squares[i] * inverse;
    int k = N - 1 - i;
    inverse = 1 / (up[k] + tiny);
    up_ratio[k] = e[k - 1] * inverse;
    up[k - 1] = (d[k - 1] - x) - squares[k - 1] * inverse;
  }
  Real gamma[N];
  Real size[2] = {splat(1e300), splat(1e300)};
#pragma GCC unroll 12
  for (int i = 0; i < N; ++i) {
    gamma[i] = down[i] + (up[i] - (d[i] - x));
    size[i & 1] = min(abs(gamma[i]), size[i & 1]);
  }
  const Real least = min(size[0], size[1]);
  Real signed_least = splat(0);
  Mask here[N];
  Mask found = less(splat(1), splat(0));
#pragma GCC unroll 12
  for (int i = 0; i < N; ++i) {
    const Mask equal = less_equal(abs(gamma[i]), least);
    here[i] = both(equal, negate(found));
    found = either(found, equal);
    signed_least = select(equal, gamma[i], signed_least);
  }
  Real tail = select(here[0], splat(1), splat(0));
  z[0] = tail;
#pragma GCC unroll 12
  for (int i = 1; i < N; ++i) z[i] = tail = select(here[i], splat(1), -up_ratio[i] * tail);
  Real head = splat(0);
  Real sum[2] = {splat(0), splat(0)};
#pragma GCC unroll 12
  for (int i = N - 1; i >= 0; --i) {
    if (i < N - 1) head = -down_ratio[i] * head;
    z[i] += head;
    head = select(here[i], splat(1), head);
    sum[i & 1] += z[i] * z[i];
  }
  Real inverse = rsqrt(sum[0] + sum[1]);
#pragma GCC unroll 12
  for (int i = 0; i < N; ++i) z[i] *= inverse;
  return {least * inverse, signed_least * inverse * inverse};
}

}  // namespace
}  // namespace ergon::lanes
