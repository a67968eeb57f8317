#pragma once
// All eigenvalues and eigenvectors of a symmetric tridiagonal matrix per lane, by QL with explicit shifts (Parlett
// 1998, The Symmetric Eigenvalue Problem, chapter 8). It establishes eigenvectors orthogonal to rounding whatever the
// eigenvalues are. Lanes need no masks: an off-diagonal entry set to zero splits the matrix, and a sweep acts on each
// part.

#include "runtime/lanes/projection_vector.h"

namespace ergon::lanes {
namespace {

// On entry the tridiagonal matrix (diagonal d, e[i] between i and i + 1, with a bound of its norm) and an orthogonal Q,
// column c at z[c]. On return e is zero, d the eigenvalues in no order, z[c] = Q times the eigenvector of d[c].
template <int N>
inline void ql_iterate(Real* d, Real* e, Real norm, Real (*z)[N]) {
  const Real negligible = 2.3e-16 * norm;
  for (int sweep = 0; sweep < 30 * N; ++sweep) {
    // The first entry that is not negligible, lane by lane, and the 2x2 matrix around it.
    Real d0 = splat(0), d1 = splat(0), e0 = splat(0);
    int first = N;
    for (int i = N - 2; i >= 0; --i) {
      Mask active = less(negligible, abs(e[i]));
      e[i] = select(active, e[i], splat(0));
      d0 = select(active, d[i], d0);
      d1 = select(active, d[i + 1], d1);
      e0 = select(active, e[i], e0);
      if (any(active)) first = i;
    }
    if (first == N) return;
    // Wilkinson's shift: the eigenvalue of the 2x2 matrix nearer to d0.
    Real half = 0.5 * (d1 - d0);
    Real root = sqrt(half * half + e0 * e0);
    Real denominator = abs(half) + root;
    denominator = select(less(splat(0), denominator), denominator, splat(1));
    Real ratio = e0 * (e0 / denominator);
    Real shift = d0 - select(less(half, splat(0)), -ratio, ratio);

    Real p = d[N - 1] - shift, c = splat(1), s = splat(0);
    for (int i = N - 2; i >= first; --i) {
      // A lane that is done must not be turned by rotations that are one but for rounding.
      const Mask coupled = less(splat(0), abs(e[i]));
      Real di = d[i] - shift;
      Real g = c * e[i];
      Real h = c * p;
      Real squared = p * p + select(coupled, e[i] * e[i], splat(1));
      Real inverse = rsqrt(squared);
      if (i < N - 2) e[i + 1] = s * select(coupled, squared * inverse, p);
      c = select(coupled, p * inverse, splat(1));
      s = e[i] * inverse;
      p = c * di - s * g;
      d[i + 1] = shift + (h + s * (c * g + s * di));
      Real* low = z[i];
      Real* high = z[i + 1];
      for (int k = 0; k < N; ++k) {
        Real f = high[k];
        high[k] = s * low[k] + c * f;
        low[k] = c * low[k] - s * f;
      }
    }
    e[first] = s * p;
    d[first] = shift + c * p;
  }
}

}  // namespace
}  // namespace ergon::lanes
