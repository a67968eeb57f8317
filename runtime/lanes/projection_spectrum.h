#pragma once
// The projection, declared in projection.h: A + sum over negative eigenpairs of |x| z z'. It establishes that only
// these pairs are computed (those of -A where they are fewer), that each is checked, and that the lanes in which the
// check fails, which takes a multiple eigenvalue, are done by QL.

#include "runtime/lanes/projection_eigenvalues.h"
#include "runtime/lanes/projection_eigenvectors.h"
#include "runtime/lanes/projection_ql.h"
#include "runtime/lanes/projection_small.h"
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
    Mask bad = both(from_bits(pairs.wanted[j]), negate(less(splat(0.7), squared)));
    parallel = either(parallel, bad);
    Real inverse = rsqrt(max(squared, splat(1e-20)));
#pragma GCC unroll 12
    for (int k = 0; k < N; ++k) z[k] *= inverse;
  }
  return bits(parallel);
}

// A tridiagonal matrix, or minus it in the lanes `flipped`, with the fewer eigenvalues below zero.
template <int N>
struct Oriented {
  Real d[N], e[N], squares[N];
  Real norm;      // not below the largest absolute eigenvalue
  Real noise;     // an eigenvalue between -noise and noise counts as zero
  Real negative;  // number of eigenvalues below -noise
  Mask flipped;
  Real mirror;              // -1 where flipped, else 1
  Characteristic at_noise;  // of the matrix before it was flipped, at -noise or, where flipped, at noise
};

// Returns false when no lane has a negative eigenvalue.
template <int N>
inline bool orient(const Tridiagonal<N>& t, Oriented<N>& o) {
  // Where an off-diagonal entry is zero the sequence of minors could vanish; what is added is nothing beside 1.
#pragma GCC unroll 12
  for (int i = 0; i < N - 1; ++i) {
    o.e[i] = copysign(max(abs(t.e[i]), splat(2e-17)), t.e[i]);
    o.squares[i] = o.e[i] * o.e[i];
  }
  o.norm = splat(0);
#pragma GCC unroll 12
  for (int i = 0; i < N; ++i) {
    Real row = abs(t.d[i]) + (i > 0 ? abs(o.e[i - 1]) : splat(0)) + (i < N - 1 ? abs(o.e[i]) : splat(0));
    o.norm = max(o.norm, row);
  }
  o.noise = 1e-15 * o.norm + 1e-16;
  const Characteristic below = characteristic<N>(t.d, o.squares, -o.noise);
  const Characteristic above = characteristic<N>(t.d, o.squares, o.noise);
  if (!any(less(splat(0.5), below.below))) return false;
  const Real positive = N - above.below;
  o.flipped = less(positive, below.below);
  o.negative = min(positive, below.below);
  o.mirror = select(o.flipped, splat(-1), splat(1));
  o.at_noise = {select(o.flipped, above.p, below.p), select(o.flipped, above.p1, below.p1),
                select(o.flipped, above.p2, below.p2), o.negative};
#pragma GCC unroll 12
  for (int i = 0; i < N; ++i) {
    o.d[i] = o.mirror * t.d[i];
    if (i < N - 1) o.e[i] = o.mirror * o.e[i];
  }
  return true;
}

// Returns the lanes in which the pairs are not accurate. Orthonormal vectors with small residuals whose number is that
// of the negative eigenvalues are all there are.
template <int N>
inline unsigned find_lowest_pairs(const Oriented<N>& o, LowestPairs<N>& pairs) {
  unsigned open[LowestPairs<N>::kMost];
  for (int j = 0; j < LowestPairs<N>::kMost; ++j) {
    open[j] = pairs.wanted[j] = bits(less(splat(j + 0.5), o.negative));
    if (open[j]) pairs.count = j + 1;
  }
  const Real bound = -1.01 * o.norm - 1e-3;
  unsigned failed = lowest_eigenvalues<N>(o.d, o.squares, bound, -o.noise, o.at_noise, o.mirror, o.negative,
                                          pairs.count, open, pairs.x);
  for (int attempt = 0; attempt < 3; ++attempt) {
    unsigned inaccurate = 0;
    for (int j = 0; j < pairs.count; ++j) {
      const TwistedResult t = twisted_eigenvector<N>(o.d, o.e, o.squares, pairs.x[j], pairs.z[j]);
      const Mask wanted = from_bits(pairs.wanted[j]);
      inaccurate |= pairs.wanted[j] & ~bits(less(t.residual, 8e-16 * o.norm));
      pairs.x[j] = select(wanted, pairs.x[j] + t.correction, splat(0));
      failed |= pairs.wanted[j] & ~bits(less(pairs.x[j], o.noise));
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
void project_by_ql(double* packed, const Tridiagonal<N>& t, Real norm, Mask chosen, Real factor) {
  Real d[N], e[N], z[N][N];
  for (int c = 0; c < N; ++c) {
    d[c] = t.d[c];
    e[c] = t.e[c];
    for (int r = 0; r < N; ++r) z[c][r] = splat(r == c);
    apply_reflections(t, z[c]);
  }
  ql_iterate<N>(d, e, norm, z);
  for (int c = 0; c < N; ++c) {
    add_outer<N>(packed, select(chosen, max(-d[c], splat(0)) * factor, splat(0)), z[c]);
  }
}

// The same from the pairs of T or, in the lanes `flipped`, of -T.
template <int N>
void project_by_pairs(double* packed, const Tridiagonal<N>& t, Negative mode, Mask chosen, Mask flipped, Real factor,
                      LowestPairs<N>& pairs) {
  flipped = both(flipped, chosen);
  if (any(flipped)) {
    const Real rest = splat(mode == Negative::clamp ? 0.0 : -1.0);
    for (int i = 0; i < N * (N + 1) / 2; ++i) {
      Real a = load(packed + i * kWidth);
      store(packed + i * kWidth, select(flipped, rest * a, a));
    }
  }
  for (int j = 0; j < pairs.count; ++j) {
    Real* z = pairs.z[j];
    // A vector that was rejected may hold NaN.
    const Mask used = both(chosen, from_bits(pairs.wanted[j]));
#pragma GCC unroll 12
    for (int k = 0; k < N; ++k) z[k] = select(used, z[k], splat(0));
    apply_reflections(t, z);
    add_outer<N>(packed, max(-pairs.x[j], splat(0)) * factor, z);
  }
}

template <int N>
void project_by_tridiagonal(double* packed, Negative mode, unsigned lanes) {
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
  largest = select(chosen, max(largest, splat(1e-290)), splat(1));
  Real scale = 1 / largest;
#pragma GCC unroll 78
  for (int i = 0; i < kEntries; ++i) t.u[i] = select(chosen, load(packed + i * kWidth) * scale, splat(0));
  tridiagonalise(t);

  Oriented<N> o;
  if (!orient(t, o)) return;
  LowestPairs<N> pairs;
  const unsigned failed = find_lowest_pairs(o, pairs);
  const Real factor = largest * (mode == Negative::clamp ? 1.0 : 2.0);
  project_by_pairs<N>(packed, t, mode, both(chosen, from_bits(~failed)), o.flipped, factor, pairs);
  const Mask rest = both(chosen, from_bits(failed));
  if (any(rest)) project_by_ql<N>(packed, t, o.norm, rest, factor);
}

template <int N>
void project_lanes(double* packed, Negative mode, unsigned lanes) {
  if constexpr (N == 1) {
    project_1(packed, mode == Negative::absolute, lanes);
  } else if constexpr (N == 2) {
    project_2(packed, mode == Negative::absolute, lanes);
  } else if constexpr (N == 3) {
    project_3(packed, mode == Negative::absolute, lanes);
  } else {
    project_by_tridiagonal<N>(packed, mode, lanes);
  }
}

}  // namespace
}  // namespace ergon::lanes
