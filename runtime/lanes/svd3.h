#pragma once
// Singular value decomposition of one 3x3 matrix per lane. Included only by files in runtime/lanes. It establishes
// F = U diag(s) V' with rotations U and V, without a branch and to a few units in the last place of the largest
// singular value, whatever the singular values are: equal, zero, or with det(F) < 0.

#include "runtime/lanes/projection_isolated.h"
#include "runtime/lanes/projection_vector.h"

namespace ergon::lanes {
namespace {

// u[i], v[i]: columns of U and V, right-handed. s[0] >= s[1] >= |s[2]| up to rounding; s[2] has the sign of det(F).
struct Svd3 {
  Vector u[3], v[3];
  Real s[3];
};

// The rotation by b that takes the off-diagonal entry of a symmetric 2x2 matrix away: tan(2 b) = y/x of its difference
// of diagonal entries x and twice that entry, y. The larger eigenvalue belongs to (c, s).
struct PlaneTurn {
  Real c, s;
};

inline PlaneTurn plane_turn(Real x, Real y) {
  const Real hypotenuse = x * x + y * y;
  const Mask turned = less(splat(kNegligible), hypotenuse);
  const Real inverse = rsqrt(max(hypotenuse, splat(kNegligible)));
  const Real cos_2b = select(turned, abs(x) * inverse, splat(1)), sin_2b = select(turned, abs(y) * inverse, splat(0));
  const Real larger_squared = 0.5 + 0.5 * cos_2b;
  const Real inverse_larger = rsqrt(larger_squared);
  const Real larger = larger_squared * inverse_larger, smaller = 0.5 * sin_2b * inverse_larger;
  const Mask first = less_equal(splat(0), x);
  return {select(first, larger, smaller), copysign(select(first, smaller, larger), y)};
}

// M = R(a) diag(s0, s1) R(b)' with rotations by the angles a and b, s0 >= |s1|.
struct PlaneSvd {
  Real cos_a, sin_a, cos_b, sin_b, s0, s1;
};

inline PlaneSvd plane_svd(Real m00, Real m01, Real m10, Real m11) {
  const PlaneTurn b =
      plane_turn((m00 * m00 + m10 * m10) - (m01 * m01 + m11 * m11), 2 * (m00 * m01 + m10 * m11));  // of M'M
  PlaneSvd r;
  r.cos_b = b.c;
  r.sin_b = b.s;
  const Real p0 = m00 * r.cos_b + m01 * r.sin_b, p1 = m10 * r.cos_b + m11 * r.sin_b;
  const Real squared = p0 * p0 + p1 * p1;
  const Mask regular = less(splat(kNegligible), squared);
  const Real inverse_length = rsqrt(max(squared, splat(kNegligible)));
  r.cos_a = select(regular, p0 * inverse_length, splat(1));
  r.sin_a = select(regular, p1 * inverse_length, splat(0));
  r.s0 = r.cos_a * p0 + r.sin_a * p1;
  const Real q0 = m01 * r.cos_b - m00 * r.sin_b, q1 = m11 * r.cos_b - m10 * r.sin_b;
  r.s1 = r.cos_a * q1 - r.sin_a * q0;
  return r;
}

// F by columns. An isolated eigenvector v of F'F and the matching direction u of F v leave a 2x2 matrix on their
// complements. If v belongs to the largest singular value, u = F v/|F v|; otherwise that is the smallest and the others
// are large, so the normal to the images of v's complement, cof(F) v, is as accurate. What is neglected, u' F w and,
// for w normal to v, is below rounding beside the largest singular value because v' F'F w is beside its square. Not
// finite in, not finite out.
inline Svd3 svd3(const Vector& f0, const Vector& f1, const Vector& f2) {
  Real size = max(max(abs(f0.x), abs(f0.y)), abs(f0.z));
  size = max(max(max(abs(f1.x), abs(f1.y)), abs(f1.z)), size);
  size = max(max(max(max(abs(f2.x), abs(f2.y)), abs(f2.z)), size), splat(kNegligible));
  const Real scale = 1 / size;
  const Vector g[3] = {scale * f0, scale * f1, scale * f2};
  const auto image = [&](const Vector& w) { return w.x * g[0] + w.y * g[1] + w.z * g[2]; };

  const Real third = splat(1.0 / 3.0);
  const Isolated isolated =
      isolated_eigenvector({third * dot(g[0], g[0]), third * dot(g[1], g[0]), third * dot(g[1], g[1]),
                            third * dot(g[2], g[0]), third * dot(g[2], g[1]), third * dot(g[2], g[2])});
  Vector v[3], u[3];
  v[0] = isolated.v;
  frame(v[0], v[1], v[2]);
  const Vector m0 = image(v[0]), m1 = image(v[1]), m2 = image(v[2]);
  u[0] = select(isolated.highest, m0, cross(m1, m2));
  const Real squared = dot(u[0], u[0]);
  u[0] = select(less(splat(kNegligible), squared), rsqrt(max(squared, splat(kNegligible))) * u[0],
                Vector{splat(1), splat(0), splat(0)});
  frame(u[0], u[1], u[2]);
  const PlaneSvd r = plane_svd(dot(u[1], m1), dot(u[1], m2), dot(u[2], m1), dot(u[2], m2));

  const Real s0 = size * dot(u[0], m0), s1 = size * r.s0, s2 = size * r.s1;
  const Vector u1 = r.cos_a * u[1] + r.sin_a * u[2], u2 = r.cos_a * u[2] + (-r.sin_a) * u[1];
  const Vector v1 = r.cos_b * v[1] + r.sin_b * v[2], v2 = r.cos_b * v[2] + (-r.sin_b) * v[1];
  const Mask highest = isolated.highest;
  return {{select(highest, u[0], u1), select(highest, u1, u2), select(highest, u2, u[0])},
          {select(highest, v[0], v1), select(highest, v1, v2), select(highest, v2, v[0])},
          {select(highest, s0, s1), select(highest, s1, s2), select(highest, s2, s0)}};
}

}  // namespace
}  // namespace ergon::lanes
