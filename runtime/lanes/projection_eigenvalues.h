#pragma once
// The lowest eigenvalues of symmetric tridiagonal matrices, one per lane, one after the other from below, by Laguerre's
// iteration on the characteristic polynomial without the roots found before (Parlett 1964, Laguerre's method applied to
// the matrix eigenvalue problem, Math. Comp. 18). It establishes, from a point below all eigenvalues, approximations
// that one step of inverse iteration makes exact, also beside a cluster around zero; a cluster of wanted eigenvalues
// converges slowly and is reported.

#include "runtime/lanes/projection_vector.h"

namespace ergon::lanes {
namespace {

// det(T - x), its first derivative and half its second.
struct Characteristic {
  Real p, p1, p2;
};

// squares[i] = e[i]^2.
template <int N>
inline Characteristic characteristic(const Real* d, const Real* squares, Real x) {
  Real t = d[0] - x;
  Real before = splat(1), before1 = splat(0), before2 = splat(0);
  Real p = t, p1 = splat(-1), p2 = splat(0);
#pragma GCC unroll 12
  for (int i = 1; i < N; ++i) {
    t = d[i] - x;
    const Real next = t * p - squares[i - 1] * before;
    const Real next1 = t * p1 - (p + squares[i - 1] * before1);
    const Real next2 = t * p2 - (p1 + squares[i - 1] * before2);
    before = p, before1 = p1, before2 = p2;
    p = next, p1 = next1, p2 = next2;
  }
  return {p, p1, p2};
}

// The number of eigenvalues below x. squares[i] is not zero: then no two neighbours in the sequence of minors vanish.
template <int N>
inline Real eigenvalues_below(const Real* d, const Real* squares, Real x) {
  Real before = splat(1), p = d[0] - x;
  Real signs = half_sign_product(p, before);
#pragma GCC unroll 12
  for (int i = 1; i < N; ++i) {
    const Real next = (d[i] - x) * p - squares[i - 1] * before;
    signs += half_sign_product(next, p);
    before = p;
    p = next;
  }
  return 0.5 * N - signs;
}

// A search for the lowest eigenvalues of one matrix per lane.
template <int N>
struct Laguerre {
  Real at;             // where the iteration is
  Real top;            // not below the largest eigenvalue, and near it
  Mask crowded;        // lanes in which the last step saw two eigenvalues close together
  Real found;          // number of eigenvalues found
  Real lowest[N / 2];  // these, and what is as good as infinite
  unsigned open;       // lanes in which more are wanted

  // From above, where a Laguerre step does not pass the largest eigenvalue. It is taken out of what follows since the
  // Hessians of stencils have one eigenvalue far above all others, which then are a cluster seen from below.
  void start(const Real* d, const Real* squares, Real bound, unsigned lanes) {
    top = bound;
    for (int i = 0; i < 2; ++i) {
      const Characteristic f = characteristic<N>(d, squares, top);
      const Real inverse = 1 / f.p, s1 = f.p1 * inverse, s2 = s1 * s1 - 2 * f.p2 * inverse;
      top -= N / (s1 + sqrt(max((N - 1) * (N * s2 - s1 * s1), splat(0))));
    }
    at = -bound;
    crowded = from_bits(0);
    found = splat(0);
    for (Real& x : lowest) x = splat(1e300);
    open = lanes;
  }

  // With y_i = 1/(x_i - at) over the eigenvalues x_i that were not found yet: given the sums of y_i and of y_i^2, the
  // largest y_i is largest when all others are equal, so that a step of 1/y does not pass the lowest x_i.
  void step(const Real* d, const Real* squares, Real norm, Real wanted) {
    const Characteristic f = characteristic<N>(d, squares, at);
    const Real inverse = 1 / f.p, newton = -f.p1 * inverse, above = 1 / (top - at);
    Real s1 = newton - above, s2 = newton * newton - 2 * f.p2 * inverse - above * above, sign = f.p;
#pragma GCC unroll 6
    for (const Real& x : lowest) {
      const Real y = 1 / (x - at);
      sign = half_sign_product(sign, y);
      s1 -= y;
      s2 -= y * y;
    }
    const Real left = (N - 1) - found;
    // Seen from afar all others are one cluster: what is added outweighs the rounding of s1 and s2 (a thousand times
    // that of p1/p when a lower eigenvalue is taken out beside it), so that none of the cluster is passed.
    // One eigenvalue that was passed lies below.
    const Mask up = less(splat(0), sign);
    const Real side = select(up, splat(1), splat(-1));
    const Real spread = select(both(up, crowded), 0.5 * left - 1, left - 1);
    const Real root = sqrt(max(spread * (left * s2 - s1 * s1), splat(0)) + 1e-10 * (s1 * s1));
    const Real size = left / (side * s1 + root);
    const Real next = at + side * size;
    // Two that lie close together slow the iteration down; a step for two, which does not pass the second, does not.
    // The step is of third order: its error is about itself times the sum of (size/distance)^2 over the others.
    const Real others = s2 * size * size - 1;
    const Mask small = less(size * others, splat(1e-15));
    crowded = less(splat(0.25), others);
    const Mask done = both(small, from_bits(open));
    at = select(from_bits(open), next, at);
    for (int j = 0; j < N / 2; ++j) {
      const Mask here = both(done, both(less(splat(j - 0.5), found), less(found, splat(j + 0.5))));
      lowest[j] = select(here, at, lowest[j]);
    }
    at = select(done, at - 1e-3 * norm, at);
    found = select(done, found + 1, found);
    open &= bits(less(found + 0.5, wanted));
  }
};

// For each of G groups of matrices: finds eigenvalue j (0 is the lowest) in the lanes pairs.wanted[j]; zero elsewhere.
// Sets `failed` to the lanes in which something did not converge. Steps of the groups are taken in turn, so that none
// waits for the other's arithmetic.
template <int N, int G, class Group>
inline void lowest_eigenvalues(Group* groups) {
  constexpr int kSteps = 8;  // for each eigenvalue
  Laguerre<N> search[G];
  int count = 0;
  unsigned open = 0;
  for (int g = 0; g < G; ++g) {
    search[g].start(groups[g].o.d, groups[g].o.squares, groups[g].bound(), groups[g].pairs.wanted[0]);
    open |= search[g].open;
    count = groups[g].pairs.count > count ? groups[g].pairs.count : count;
  }
  for (int iteration = 0; iteration < kSteps * count + 4 && open != 0; ++iteration) {
    open = 0;
#pragma GCC unroll 2
    for (int g = 0; g < G; ++g) {
      search[g].step(groups[g].o.d, groups[g].o.squares, groups[g].o.norm, groups[g].o.negative);
      open |= search[g].open;
    }
  }
  for (int g = 0; g < G; ++g) {
    groups[g].failed = search[g].open;
    for (int j = 0; j < groups[g].pairs.count; ++j) {
      const Mask good = from_bits(groups[g].pairs.wanted[j] & ~search[g].open);
      groups[g].pairs.x[j] = select(good, search[g].lowest[j], splat(0));
    }
  }
}

}  // namespace
}  // namespace ergon::lanes
