#pragma once
// The projection, declared in projection.h: A + sum over negative eigenpairs of |x| z z'. It establishes that only
// these pairs are computed (those of -A where they are fewer), that each is checked, and that the lanes in which the
// check fails, which takes a multiple eigenvalue, are done by QL.

#include "runtime/lanes/projection_eigenvalues.h"
#include "runtime/lanes/projection_eigenvectors.h"
#include "runtime/lanes/projection_ql.h"
#include "runtime/lanes/projection_tridiagonal.h"

namespace ergon::lanes {
namespace {

// The lowest eigenpairs of a tridiagonal matrix per lane, mapped back by its reflections.
template <int N>
struct LowestPairs {
  static constexpr int kMost = N / 2;
  int count = 0;           // largest over the lanes
  unsigned wanted[kMost];  // lanes that have pair j
  Real x[kMost];           // zero in other lanes
  Real z[kMost][N];
};

// Orthonormalises the vectors in order. Returns the lanes in which two were nearly parallel.
template <int N>
inline unsigned orthonormalise(LowestPairs<N>& pairs) {
  Mask parallel = from_bits(0);
  if (LowestPairs<N>::kMost == 1) return 0;
  for (int j = 1; j < pairs.count; ++j) {
    Real* z = pairs.z[j];
    Real dots[LowestPairs<N>::kMost];
    for (int i = 0; i < j; ++i) {
      Real dot[2] = {splat(0), splat(0)};
#pragma GCC unroll 12
      for (int k = 0; k < N; ++k) dot[k & 1] += pairs.z[i][k] * z[k];
      dots[i] = dot[0] + dot[1];
    }
    for (int i = 0; i < j; ++i) {
#pragma GCC unroll 12
      for (int k = 0; k < N; ++k) z[k] -= dots[i] * pairs.z[i][k];
    }
    Real sum[2] = {splat(0), splat(0)};
#pragma GCC unroll 12
    for (int k = 0; k < N; ++k) sum[k & 1] += z[k] * z[k];
    Real squared = sum[0] + sum[1];
    Mask bad = both(from_bits(pairs.wanted[j]), negate(less(splat(0.25), squared)));
    parallel = either(parallel, bad);
    Real inverse = rsqrt(max(squared, splat(1e-20)));
#pragma GCC unroll 12
    for (int k = 0; k < N; ++k) z[k] *= inverse;
  }
  return bits(parallel);
}

// Returns the lanes in which the pairs are not accurate.
template <int N>
inline unsigned find_lowest_pairs(const Real* d, const Real* e, const Real* squares, const Characteristic& zero,
                                  Real mirror, Real negative, LowestPairs<N>& pairs) {
  Real bound = splat(0);
#pragma GCC unroll 12
  for (int i = 0; i < N; ++i) {
    Real radius = (i > 0 ? abs(e[i - 1]) : splat(0)) + (i < N - 1 ? abs(e[i]) : splat(0));
    bound = min(bound, d[i] - radius);
  }
  unsigned open[LowestPairs<N>::kMost];
  for (int j = 0; j < pairs.count; ++j) open[j] = pairs.wanted[j];
  unsigned failed =
      lowest_eigenvalues<N>(d, squares, bound * 1.01 - 1e-3, zero, mirror, negative, pairs.count, open, pairs.x);
  for (int attempt = 0; attempt < 3; ++attempt) {
    unsigned inaccurate = 0;
    for (int j = 0; j < pairs.count; ++j) {
      TwistedResult t = twisted_eigenvector<N>(d, e, squares, pairs.x[j], pairs.z[j]);
      inaccurate |= pairs.wanted[j] & ~bits(less(t.residual, splat(2e-15)));
      pairs.x[j] = select(from_bits(pairs.wanted[j]), pairs.x[j] + t.correction, splat(0));
    }
    if ((inaccurate & ~failed) == 0) break;
    if (attempt == 2) failed |= inaccurate;
  }
  return failed | orthonormalise(pairs);
}

// packed += weight z z'.
template <int N>
inline void add_outer(double* packed, Real weight, const Real* z) {
#pragma GCC unroll 12
  for (int i = 0; i < N; ++i) {
    Real w = weight * z[i];
#pragma GCC unroll 12
    for (int j = 0; j <= i; ++j) {
      double* entry = packed + (i * (i + 1) / 2 + j) * kWidth;
      store(entry, load(entry) + w * z[j]);
    }
  }
}

// Adds factor times |x| z z' over the negative eigenvalues x of T in the chosen lanes.
template <int N>
void project_by_ql(double* packed, const Tridiagonal<N>& t, Mask chosen, Real factor) {
  Real d[N], e[N], z[N][N];
  for (int c = 0; c < N; ++c) {
    d[c] = t.d[c];
    e[c] = t.e[c];
    for (int r = 0; r < N; ++r) z[c][r] = splat(r == c);
    apply_reflections(t, z[c]);
  }
  ql_iterate<N>(d, e, z);
  for (int c = 0; c < N; ++c) {
    add_outer<N>(packed, select(chosen, max(-d[c], splat(0)) * factor, splat(0)), z[c]);
  }
}

// The same from the pairs of T or, in the lanes `flipped`, of -T.
template <int N>
void project_by_pairs(double* packed, Negative mode, Mask chosen, Mask flipped, Real factor,
                      const LowestPairs<N>& pairs) {
  flipped = both(flipped, chosen);
  if (any(flipped)) {
    const Real rest = splat(mode == Negative::clamp ? 0.0 : -1.0);
    for (int i = 0; i < N * (N + 1) / 2; ++i) {
      Real a = load(packed + i * kWidth);
      store(packed + i * kWidth, select(flipped, rest * a, a));
    }
  }
  for (int j = 0; j < pairs.count; ++j) {
    add_outer<N>(packed, select(chosen, max(-pairs.x[j], splat(0)) * factor, splat(0)), pairs.z[j]);
  }
}

template <int N>
void project_lanes(double* packed, Negative mode, unsigned lanes) {
  constexpr int kEntries = N * (N + 1) / 2;
  Tridiagonal<N> t;
  Real largest = splat(0), sum = splat(0);
#pragma GCC unroll 78
  for (int i = 0; i < kEntries; ++i) {
    Real a = abs(load(packed + i * kWidth));
    largest = max(a, largest);
    sum += a;
  }
  // A NaN or an infinity makes the sum one.
  Mask chosen = both(from_bits(lanes), less(sum, splat(__builtin_inf())));
  largest = max(largest, splat(1e-290));
  if constexpr (N == 1) {
    Real a = load(packed);
    store(packed, select(chosen, mode == Negative::clamp ? max(a, splat(0)) : abs(a), a));
    return;
  }
  Real scale = 1 / largest;
#pragma GCC unroll 78
  for (int i = 0; i < kEntries; ++i) t.u[i] = select(chosen, load(packed + i * kWidth) * scale, splat(0));
  tridiagonalise(t);

  // An off-diagonal entry that is not zero splits nothing; what is added is nothing beside 1.
  Real d[N], e[N], squares[N];
#pragma GCC unroll 12
  for (int i = 0; i < N - 1; ++i) {
    e[i] = copysign(max(abs(t.e[i]), splat(2e-17)), t.e[i]);
    squares[i] = e[i] * e[i];
  }
  const Characteristic zero = characteristic<N>(t.d, squares, splat(0));
  Real below = zero.below;
  if (!any(less(splat(0.5), below))) return;
  Mask flipped = less(splat(N / 2 + 0.5), below);
  below = select(flipped, N - below, below);
#pragma GCC unroll 12
  for (int i = 0; i < N; ++i) {
    d[i] = select(flipped, -t.d[i], t.d[i]);
    if (i < N - 1) e[i] = select(flipped, -e[i], e[i]);
  }
  LowestPairs<N> pairs;
  for (int j = 0; j < LowestPairs<N>::kMost; ++j) {
    pairs.wanted[j] = bits(less(splat(j + 0.5), below));
    if (pairs.wanted[j]) pairs.count = j + 1;
  }
  unsigned failed = find_lowest_pairs<N>(d, e, squares, zero, select(flipped, splat(-1), splat(1)), below, pairs);
  for (int j = 0; j < pairs.count; ++j) apply_reflections(t, pairs.z[j]);

  Real factor = largest * (mode == Negative::clamp ? 1.0 : 2.0);
  project_by_pairs<N>(packed, mode, both(chosen, from_bits(~failed)), flipped, factor, pairs);
  Mask rest = both(chosen, from_bits(failed));
  if (any(rest)) project_by_ql<N>(packed, t, rest, factor);
}

}  // namespace
}  // namespace ergon::lanes
