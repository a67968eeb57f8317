#pragma once
// Singular value decomposition of one 3x2 or 3x1 matrix per lane: the deformation gradient of a membrane or a line.
// Included only by files in runtime/lanes. It establishes F = sum of s_i u_i v_i' with orthonormal u (completed to a
// right-handed frame of space) whatever the singular values are, equal or zero.

#include "runtime/lanes/svd3.h"

namespace ergon::lanes {
namespace {

// u[2] is the normal; v[i] holds x and y of the i-th right singular vector. s[0] >= s[1] >= 0 up to rounding.
struct Svd2 {
  Vector u[3];
  Real v[2][2];
  Real s[2];
};

struct Svd1 {
  Vector u[3];
  Real s[1];
};

// a/|a|, or `otherwise` where a vanishes.
inline Vector direction(const Vector& a, const Vector& otherwise) {
  const Real squared = dot(a, a);
  return select(less(splat(kNegligible), squared), rsqrt(max(squared, splat(kNegligible))) * a, otherwise);
}

// a without its component along the unit vector b.
inline Vector without(const Vector& a, const Vector& b) { return a + (-dot(a, b)) * b; }

inline Svd2 svd2(const Vector& f0, const Vector& f1) {
  Real size = max(max(abs(f0.x), abs(f0.y)), abs(f0.z));
  size = max(max(max(max(abs(f1.x), abs(f1.y)), abs(f1.z)), size), splat(kNegligible));
  const Real scale = 1 / size;
  const Vector g0 = scale * f0, g1 = scale * f1;
  // The longer column spans the plane with what of the other is normal to it; twice, so that rounding of the first time
  // is taken out where they are nearly parallel.
  const Mask first = less_equal(dot(g1, g1), dot(g0, g0));
  const Vector along = direction(select(first, g0, g1), {splat(1), splat(0), splat(0)});
  Vector side, normal;
  frame(along, side, normal);
  const Vector rest = without(select(first, g1, g0), along);
  side = direction(without(direction(rest, side), along), side);
  normal = cross(along, side);
  const PlaneSvd r = plane_svd(dot(along, g0), dot(along, g1), dot(side, g0), dot(side, g1));
  // The sign of the smaller one, negative where `side` belongs to the first column, goes to u.
  const Vector u0 = r.cos_a * along + r.sin_a * side, u1 = r.cos_a * side + (-r.sin_a) * along;
  const Real sign = copysign(splat(1), r.s1);
  return {{u0, sign * u1, sign * normal}, {{r.cos_b, r.sin_b}, {-r.sin_b, r.cos_b}}, {size * r.s0, size * abs(r.s1)}};
}

inline Svd1 svd1(const Vector& f) {
  Real size = max(max(max(abs(f.x), abs(f.y)), abs(f.z)), splat(kNegligible));
  const Vector g = (1 / size) * f;
  Svd1 r;
  r.u[0] = direction(g, {splat(1), splat(0), splat(0)});
  frame(r.u[0], r.u[1], r.u[2]);
  r.s[0] = size * dot(r.u[0], g);
  return r;
}

}  // namespace
}  // namespace ergon::lanes
