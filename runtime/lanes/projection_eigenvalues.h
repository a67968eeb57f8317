#pragma once
// The lowest eigenvalues of a symmetric tridiagonal matrix per lane, all at once, by Laguerre's iteration inside
// brackets (Li and Zeng 1994, The Laguerre iteration in solving the symmetric tridiagonal eigenproblem, revisited, SIAM
// J. Sci. Comput. 15(5)). It establishes brackets that shrink: a Laguerre step with multiplicity r, from a point
// between which and eigenvalue j there are r - 1 others, moves towards eigenvalue j and does not pass it.

#include "runtime/lanes/projection_vector.h"

namespace ergon::lanes {
namespace {

// det(T - x), its first derivative and half its second, and the number of eigenvalues below x.
struct Characteristic {
  Real p, p1, p2;
  Real below;
};

// squares[i] = e[i]^2 is not zero: then no two neighbours in the sequence of minors vanish.
template <int N>
inline Characteristic characteristic(const Real* d, const Real* squares, Real x) {
  Real t = d[0] - x;
  Real before = splat(1), before1 = splat(0), before2 = splat(0);
  Real p = t, p1 = splat(-1), p2 = splat(0);
  Real signs = half_sign_product(p, before);
#pragma GCC unroll 12
  for (int i = 1; i < N; ++i) {
    t = d[i] - x;
    Real next = t * p - squares[i - 1] * before;
    Real next1 = t * p1 - (p + squares[i - 1] * before1);
    Real next2 = t * p2 - (p1 + squares[i - 1] * before2);
    signs += half_sign_product(next, p);
    before = p, before1 = p1, before2 = p2;
    p = next, p1 = next1, p2 = next2;
  }
  return {p, p1, p2, 0.5 * N - signs};
}

// The length of the step of multiplicity r, upwards for side = 1 and downwards for side = -1.
// With y_i = 1/(x_i - x) over the eigenvalues x_i, of which r have y_i >= y: given the sums of y_i and y_i^2, y is
// largest when these r are equal and so are the others, and 1/y is the step.
template <int N>
inline Real laguerre_step(const Characteristic& f, Real r, Real side) {
  Real discriminant = (N - 1.0) * f.p1 * f.p1 - (2.0 * N) * f.p2 * f.p;
  Real root = sqrt(max(discriminant * (N - r) * r, splat(0)));
  return (N * f.p * r) / (copysign(root, f.p) - side * f.p1 * r);
}

// Sets x[j] to eigenvalue j (0 is the lowest) in the lanes open[j], j < count, and to zero elsewhere. `negative` is the
// number of eigenvalues below `limit` < 0, of which j is one; `bound` is below all. `at_limit` is the characteristic of
// T at limit or, in lanes where mirror is -1 instead of 1, that of -T at -limit. Returns the lanes in which something
// did not converge, which clusters cause.
template <int N>
inline unsigned lowest_eigenvalues(const Real* d, const Real* squares, Real bound, Real limit,
                                   const Characteristic& at_limit, Real mirror, Real negative, int count,
                                   unsigned* open, Real* x) {
  Real low[N / 2] = {}, high[N / 2] = {}, last[N / 2] = {};
  Characteristic start = characteristic<N>(d, squares, bound);
  for (int j = 0; j < count; ++j) {
    Mask chosen = from_bits(open[j]);
    last[j] = laguerre_step<N>(start, splat(j + 1), splat(1));
    low[j] = select(chosen, bound + last[j], splat(0));
    high[j] = select(chosen, limit - laguerre_step<N>(at_limit, max(negative - j, splat(1)), -mirror), splat(0));
    x[j] = low[j];
    if (j > 0) {
      x[j] = 0.5 * (low[j] + high[j]);
      last[j] = splat(0);
    }
  }
  unsigned any_open = 0;
  for (int iteration = 0; iteration < 12; ++iteration) {
    any_open = 0;
    for (int j = 0; j < count; ++j) {
      if (open[j] == 0) continue;
      Characteristic f = characteristic<N>(d, squares, x[j]);
      Real r = j + 1 - f.below;
      Mask up = less(splat(0.5), r);
      Real side = select(up, splat(1), splat(-1));
      r = select(up, r, 1 - r);
      Real step = laguerre_step<N>(f, r, side);
      Real y = x[j] + side * step;
      low[j] = select(up, max(y, low[j]), low[j]);
      high[j] = select(up, high[j], min(y, high[j]));
      // Near a simple eigenvalue the error after a step is about step * (step/last)^3. Steps that shrink slowly crawl
      // along a cluster; the brackets' geometric mean leaves one around zero.
      Mask simple = less(r, splat(1.5));
      Mask done = both(simple, less_equal(step * step * step * step, 1e-15 * (last[j] * last[j] * last[j])));
      done = either(done, less(high[j] - low[j], splat(1e-15)));
      simple = both(simple, negate(both(less(splat(0), last[j]), less(0.3 * last[j], step))));
      last[j] = select(simple, step, splat(0));
      Real next = select(either(simple, done), y, -sqrt(low[j] * high[j]));
      x[j] = select(from_bits(open[j]), next, x[j]);
      open[j] &= ~bits(done);
      any_open |= open[j];
    }
    if (any_open == 0) break;
  }
  return any_open;
}

}  // namespace
}  // namespace ergon::lanes
