#pragma once
// The best separated eigenvector of a symmetric 3x3 matrix per lane, and an orthonormal frame around it. It
// establishes, without a branch and whatever the eigenvalues are, a unit vector whose residual is of the order of
// rounding.

#include "runtime/lanes/projection_vector.h"

namespace ergon::lanes {
namespace {

struct Vector {
  Real x, y, z;
};

inline Real dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector operator*(Real a, const Vector& b) { return {a * b.x, a * b.y, a * b.z}; }
inline Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vector select(Mask m, const Vector& a, const Vector& b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}

struct Symmetric {
  Real a00, a10, a11, a20, a21, a22;
};

inline Vector operator*(const Symmetric& a, const Vector& v) {
  return {a.a00 * v.x + a.a10 * v.y + a.a20 * v.z, a.a10 * v.x + a.a11 * v.y + a.a21 * v.z,
          a.a20 * v.x + a.a21 * v.y + a.a22 * v.z};
}

struct Isolated {
  Vector v;
  Mask highest;  // where v belongs to the largest eigenvalue; elsewhere it belongs to the smallest
};

// Of the largest and the smallest eigenvalue, the one farther from the middle. No entry of A is above 1. With
// q = tr(A)/3, p^2 = |A - q|^2/6, B = (A - q)/p, the eigenvalues of B are 2 cos((acos(det(B)/2) + 2 pi k)/3) (Smith
// 1961, Eigenvalues of a symmetric 3x3 matrix, CACM 4(4)); with the sign of B such that its determinant is positive the
// largest is between sqrt(3) and 2, the others below 0. A vector in the range of the adjugate of B - b, b near that
// eigenvalue, is its eigenvector up to the square of the error of b when the adjugate is applied twice.
inline Isolated isolated_eigenvector(const Symmetric& a) {
  const Real q = (a.a00 + a.a11 + a.a22) * (1.0 / 3.0);
  Symmetric b{a.a00 - q, a.a10, a.a11 - q, a.a20, a.a21, a.a22 - q};
  const Real diagonal = b.a00 * b.a00 + b.a11 * b.a11 + b.a22 * b.a22;
  const Real rest = b.a10 * b.a10 + b.a20 * b.a20 + b.a21 * b.a21;
  const Real squared = diagonal * (1.0 / 6.0) + rest * (1.0 / 3.0);
  Real inverse = rsqrt(max(squared, splat(kNegligible)));
  const Real m0 = b.a11 * b.a22 - b.a21 * b.a21;
  const Real m1 = b.a10 * b.a22 - b.a21 * b.a20;
  const Real m2 = b.a10 * b.a21 - b.a11 * b.a20;
  const Real half_determinant =
      0.5 * ((b.a00 * inverse) * (m0 * inverse) * inverse - (b.a10 * inverse) * (m1 * inverse) * inverse +
             (b.a20 * inverse) * (m2 * inverse) * inverse);
  inverse = copysign(inverse, half_determinant);
  b = {b.a00 * inverse, b.a10 * inverse, b.a11 * inverse, b.a20 * inverse, b.a21 * inverse, b.a22 * inverse};
  // 2 cos(acos(t)/3) on [0, 1], to 4e-9: the polynomial through the Chebyshev points.
  const Real t = min(abs(half_determinant), splat(1)), t2 = t * t, t4 = t2 * t2;
  const Real low =
      (1.7320508111991304 + 0.33333274228899734 * t) + t2 * (-0.096208882905866946 + 0.049208593584658143 * t);
  const Real high =
      (-0.030214550322433354 + 0.018766661141410002 * t) + t2 * (-0.0098593823448592764 + 0.0035297137462336507 * t);
  const Real largest = low + t4 * (high + t4 * -0.00060570840290168017);

  b.a00 -= largest;
  b.a11 -= largest;
  b.a22 -= largest;
  const Symmetric adjugate{b.a11 * b.a22 - b.a21 * b.a21, b.a20 * b.a21 - b.a10 * b.a22, b.a00 * b.a22 - b.a20 * b.a20,
                           b.a10 * b.a21 - b.a20 * b.a11, b.a10 * b.a20 - b.a00 * b.a21, b.a00 * b.a11 - b.a10 * b.a10};
  const Mask first = less(adjugate.a11, adjugate.a00);
  Vector column =
      select(first, Vector{adjugate.a00, adjugate.a10, adjugate.a20}, Vector{adjugate.a10, adjugate.a11, adjugate.a21});
  const Mask last = less(max(adjugate.a00, adjugate.a11), adjugate.a22);
  column = select(last, Vector{adjugate.a20, adjugate.a21, adjugate.a22}, column);
  const Vector v = adjugate * column;
  return {rsqrt(dot(v, v)) * v, less_equal(splat(0), half_determinant)};
}

// Unit vectors b and c that make with the unit vector a a right-handed frame a, b, c (Duff et al. 2017, Building an
// orthonormal basis, revisited, JCGT 6(1)).
inline void frame(const Vector& a, Vector& b, Vector& c) {
  const Real s = copysign(splat(1), a.z);
  const Real k = -1 / (s + a.z);
  const Real xy = a.x * a.y * k;
  b = {1 + s * a.x * a.x * k, s * xy, -s * a.x};
  c = {xy, s + a.y * a.y * k, -a.y};
}

}  // namespace
}  // namespace ergon::lanes
