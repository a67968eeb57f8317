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
  int count = 0;                // largest over the lanes
  unsigned wanted[kMost] = {};  // lanes that have pair j
  Real x[kMost];                // zero in other lanes
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
  const Real below = eigenvalues_below<N>(t.d, o.squares, -o.noise);
  const Real positive = N - eigenvalues_below<N>(t.d, o.squares, o.noise);
  o.flipped = less(positive, below);
  o.negative = min(positive, below);
  const Real mirror = select(o.flipped, splat(-1), splat(1));
#pragma GCC unroll 12
  for (int i = 0; i < N; ++i) {
    o.d[i] = mirror * t.d[i];
    if (i < N - 1) o.e[i] = mirror * o.e[i];
  }
  return any(less(splat(0.5), below));
}

// A group of matrices, one per lane, that is projected.
template <int N>
struct ProjectionGroup {
  double* packed;
  unsigned lanes;

  Tridiagonal<N> t;
  Oriented<N> o;
  LowestPairs<N> pairs;
  Mask chosen;      // lanes that are asked for and finite
  Real largest;     // entry of A; t is A/largest
  unsigned failed;  // lanes whose pairs are not accurate

  Real bound() const { return 1.01 * o.norm + 1e-3; }  // above all eigenvalues of o and -o
};

template <int N>
inline void want_pairs(ProjectionGroup<N>& g) {
  for (int j = 0; j < LowestPairs<N>::kMost; ++j) {
    g.pairs.wanted[j] = bits(less(splat(j + 0.5), g.o.negative));
    if (g.pairs.wanted[j]) g.pairs.count = j + 1;
  }
}

// From the eigenvalues in pairs.x to pairs. Orthonormal vectors with small residuals whose number is that of the
// negative eigenvalues are all there are.
template <int N>
inline void find_vectors(ProjectionGroup<N>& g) {
  const Oriented<N>& o = g.o;
  LowestPairs<N>& pairs = g.pairs;
  for (int attempt = 0; attempt < 3; ++attempt) {
    unsigned inaccurate = 0;
    for (int j = 0; j < pairs.count; ++j) {
      const TwistedResult t = twisted_eigenvector<N>(o.d, o.e, o.squares, pairs.x[j], pairs.z[j]);
      const Mask wanted = from_bits(pairs.wanted[j]);
      inaccurate |= pairs.wanted[j] & ~bits(less(t.residual, 8e-16 * o.norm));
      pairs.x[j] = select(wanted, pairs.x[j] + t.correction, splat(0));
      g.failed |= pairs.wanted[j] & ~bits(less(pairs.x[j], -0.5 * o.noise));
    }
    if ((inaccurate & ~g.failed) == 0) break;
    if (attempt == 2) g.failed |= inaccurate;
  }
  g.failed |= orthonormalise(pairs);
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

// packed += v y y' + w z z'.
template <int N>
inline void add_outer(double* packed, Real v, const Real* y, Real w, const Real* z) {
#pragma GCC unroll 12
  for (int i = 0; i < N; ++i) {
    const Real vy = v * y[i], wz = w * z[i];
#pragma GCC unroll 12
    for (int j = 0; j <= i; ++j) {
      double* entry = packed + (i * (i + 1) / 2 + j) * kWidth;
      store(entry, load(entry) + vy * y[j] + wz * z[j]);
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
    apply_reflections(t, z + c, 1);
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
  Real weight[LowestPairs<N>::kMost];
  for (int j = 0; j < pairs.count; ++j) {
    // A vector that was rejected may hold NaN.
    const Mask used = both(chosen, from_bits(pairs.wanted[j]));
#pragma GCC unroll 12
    for (int k = 0; k < N; ++k) pairs.z[j][k] = select(used, pairs.z[j][k], splat(0));
    weight[j] = max(-pairs.x[j], splat(0)) * factor;
  }
  apply_reflections(t, pairs.z, pairs.count);
  int j = 0;
  for (; j + 1 < pairs.count; j += 2) add_outer<N>(packed, weight[j], pairs.z[j], weight[j + 1], pairs.z[j + 1]);
  if (j < pairs.count) add_outer<N>(packed, weight[j], pairs.z[j]);
}

// Returns false when no lane has a negative eigenvalue.
template <int N>
bool reduce(ProjectionGroup<N>& g) {
  constexpr int kEntries = N * (N + 1) / 2;
  Real largest = splat(0), sum = splat(0);
#pragma GCC unroll 78
  for (int i = 0; i < kEntries; ++i) {
    Real a = abs(load(g.packed + i * kWidth));
    largest = max(a, largest);
    sum += a;
  }
  // A NaN or an infinity makes the sum one.
  g.chosen = both(from_bits(g.lanes), less(sum, splat(__builtin_inf())));
  g.largest = select(g.chosen, max(largest, splat(1e-290)), splat(1));
  const Real scale = 1 / g.largest;
#pragma GCC unroll 78
  for (int i = 0; i < kEntries; ++i) {
    g.t.u[i] = select(g.chosen, load(g.packed + i * kWidth) * scale, splat(0));
  }
  tridiagonalise(g.t);
  if (!orient(g.t, g.o)) return false;
  want_pairs(g);
  return true;
}

template <int N>
void add_pairs(ProjectionGroup<N>& g, Negative mode) {
  find_vectors(g);
  const Real factor = g.largest * (mode == Negative::clamp ? 1.0 : 2.0);
  project_by_pairs<N>(g.packed, g.t, mode, both(g.chosen, from_bits(~g.failed)), g.o.flipped, factor, g.pairs);
  const Mask rest = both(g.chosen, from_bits(g.failed));
  if (any(rest)) project_by_ql<N>(g.packed, g.t, g.o.norm, rest, factor);
}

template <int N>
void project_lanes(double* first, unsigned first_lanes, double* second, unsigned second_lanes, Negative mode) {
  if constexpr (N <= 3) {
    project_lanes<N>(first, mode, first_lanes);
    project_lanes<N>(second, mode, second_lanes);
  } else {
    ProjectionGroup<N> groups[2];
    groups[0].packed = first, groups[0].lanes = first_lanes;
    groups[1].packed = second, groups[1].lanes = second_lanes;
    const bool negative[2] = {reduce(groups[0]), reduce(groups[1])};
    lowest_eigenvalues<N, 2>(groups);
    for (int g = 0; g < 2; ++g) {
      if (negative[g]) add_pairs(groups[g], mode);
    }
  }
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
    ProjectionGroup<N> group;
    group.packed = packed, group.lanes = lanes;
    if (!reduce(group)) return;
    lowest_eigenvalues<N, 1>(&group);
    add_pairs(group, mode);
  }
}

}  // namespace
}  // namespace ergon::lanes
