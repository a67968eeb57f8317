#include "tools/exact_collision.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/exact_polynomial.h"

// Two primitives that touch are in one plane then: times of contact are among the roots of the determinant of the
// differences of their corners. Where that is always zero, they are apart in one plane until a corner of one comes onto
// a side of the other.

namespace ergon {
namespace {

using Eigen::Vector3d;
using exact::Polynomial;
using exact::Root;

using Path = std::array<Polynomial, 3>;  // over time in [0, 1], which stands for [0, until]

Path operator-(const Path& a, const Path& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Polynomial dot(const Path& a, const Path& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Path cross(const Path& a, const Path& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// A double is mantissa*2^exponent.
struct Whole {
  mpz_class mantissa;
  long exponent;
  explicit Whole(double value) {
    int e = 0;
    mantissa = std::ldexp(std::frexp(value, &e), 53);
    exponent = value == 0 ? 0 : e - 53;
  }
};
long least_exponent(const Vector3d* x, const Vector3d* motion, double until) {
  long least = 0;
  for (int k = 0; k < 4; ++k) {
    for (int i = 0; i < 3; ++i) {
      least = std::min({least, Whole(x[k](i)).exponent, Whole(motion[k](i)).exponent + Whole(until).exponent});
    }
  }
  return least;
}
// Positions over 2^least.
Path path(const Vector3d& x, const Vector3d& motion, double until, long least) {
  Path result;
  const Whole end(until);
  for (int i = 0; i < 3; ++i) {
    const Whole from(x(i)), by(motion(i));
    const mpz_class start = from.mantissa << static_cast<unsigned long>(from.exponent - least);
    const mpz_class along = mpz_class(by.mantissa * end.mantissa)
                            << static_cast<unsigned long>(std::max(0L, by.exponent + end.exponent - least));
    result[static_cast<size_t>(i)] = Polynomial({start, along});
  }
  return result;
}

// The origin is on the segment from a to b: they are on one line with it and do not lie to one side.
struct OnSegment {
  Path area;
  Polynomial side;
  OnSegment(const Path& a, const Path& b) : area(cross(a, b)), side(dot(a, b)) {}
  template <class Sign>
  bool holds(const Sign& sign) const {
    return sign(area[0]) == 0 && sign(area[1]) == 0 && sign(area[2]) == 0 && sign(side) <= 0;
  }
  // Zero at least where this begins to hold; zero itself when it holds always or never.
  const Polynomial& event() const {
    for (const Polynomial& component : area) {
      if (!component.zero()) return component;
    }
    return side;
  }
};

// Contact is that the plane holds and either the insides meet (the normal is not zero, all of `inside` at least 0) or
// an end or a corner lies on a segment.
struct Contact {
  Polynomial plane;
  Path normal;
  std::vector<Polynomial> inside;
  std::vector<OnSegment> segments;

  template <class Sign>
  bool holds(const Sign& sign) const {
    if (sign(plane) != 0) return false;
    const auto nonzero = [&](const Polynomial& f) { return sign(f) != 0; };
    const auto positive = [&](const Polynomial& f) { return sign(f) >= 0; };
    if (std::any_of(normal.begin(), normal.end(), nonzero) && std::all_of(inside.begin(), inside.end(), positive)) {
      return true;
    }
    return std::any_of(segments.begin(), segments.end(), [&](const OnSegment& s) { return s.holds(sign); });
  }

  bool happens() const {
    const auto at = [&](int t) { return holds([&](const Polynomial& f) { return f.sign_at(t, 0); }); };
    if (at(0) || at(1)) return true;
    const auto at_a_root = [](const Polynomial& of, const auto& what) {
      if (of.degree() == 0) return false;
      const std::vector<Root> all = exact::roots(of);
      return std::any_of(all.begin(), all.end(), [&](const Root& root) {
        return what.holds([&](const Polynomial& f) { return exact::sign_at(f, root); });
      });
    };
    if (!plane.zero()) return at_a_root(plane, *this);
    return std::any_of(segments.begin(), segments.end(), [&](const OnSegment& s) { return at_a_root(s.event(), s); });
  }
};

double determinant(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return a.x() * (b.y() * c.z() - b.z() * c.y()) + a.y() * (b.z() * c.x() - b.x() * c.z()) +
         a.z() * (b.x() * c.y() - b.y() * c.x());
}

// Whether the determinant of a, b, c, moving by da, db, dc, surely keeps its sign: its four coefficients over
// Bernstein's polynomials, each a mean of determinants, are on one side of zero by more than their rounding.
bool keeps_apart(const Vector3d (&d)[3], const Vector3d (&e)[3]) {
  double size = 1;
  for (int k = 0; k < 3; ++k) size *= std::max(d[k].lpNorm<1>(), e[k].lpNorm<1>());
  const double error = 0x1p-40 * size;
  const double b[4] = {
      determinant(d[0], d[1], d[2]),
      (determinant(e[0], d[1], d[2]) + determinant(d[0], e[1], d[2]) + determinant(d[0], d[1], e[2])) / 3,
      (determinant(d[0], e[1], e[2]) + determinant(e[0], d[1], e[2]) + determinant(e[0], e[1], d[2])) / 3,
      determinant(e[0], e[1], e[2])};
  return (b[0] > error && b[1] > error && b[2] > error && b[3] > error) ||
         (b[0] < -error && b[1] < -error && b[2] < -error && b[3] < -error);
}

// The same for three differences of points; pairs: from, to. Far from the origin, and where motion is much larger than
// what it leads to, x + until*motion is rounded by more than the differences are.
bool surely_apart(const Vector3d* x, const Vector3d* motion, double until, const int (&pairs)[3][2]) {
  Vector3d d[3], e[3];
  for (int k = 0; k < 3; ++k) {
    d[k] = x[pairs[k][1]] - x[pairs[k][0]];
    const Vector3d by = until * (motion[pairs[k][1]] - motion[pairs[k][0]]);
    e[k] = d[k] + by;
    if (by.lpNorm<1>() > 64 * e[k].lpNorm<1>() || d[k].lpNorm<1>() > 64 * e[k].lpNorm<1>()) return false;
  }
  return keeps_apart(d, e);
}

}  // namespace

bool point_triangle_collides(const Vector3d* x, const Vector3d* motion, double until) {
  if (surely_apart(x, motion, until, {{0, 1}, {0, 2}, {0, 3}})) return false;
  const long least = least_exponent(x, motion, until);
  const auto from_p = [&](int k) { return path(x[k], motion[k], until, least) - path(x[0], motion[0], until, least); };
  const Path a = from_p(1), b = from_p(2), c = from_p(3);
  Contact contact;
  contact.normal = cross(b - a, c - a);
  contact.plane = dot(a, contact.normal);
  contact.inside = {dot(contact.normal, cross(b, c)), dot(contact.normal, cross(c, a)),
                    dot(contact.normal, cross(a, b))};
  contact.segments = {{a, b}, {b, c}, {c, a}};
  return contact.happens();
}

bool edge_edge_collides(const Vector3d* x, const Vector3d* motion, double until) {
  if (surely_apart(x, motion, until, {{0, 1}, {0, 2}, {2, 3}})) return false;
  Path at[4];
  const long least = least_exponent(x, motion, until);
  for (int k = 0; k < 4; ++k) at[k] = path(x[k], motion[k], until, least);
  const Path a = at[1] - at[0], b = at[3] - at[2], from = at[2] - at[0];
  Contact contact;
  contact.normal = cross(a, b);
  contact.plane = dot(from, contact.normal);
  const Polynomial n2 = dot(contact.normal, contact.normal), s = dot(cross(from, b), contact.normal),
                   t = dot(cross(from, a), contact.normal);
  contact.inside = {s, n2 - s, t, n2 - t};
  contact.segments = {{at[2] - at[0], at[3] - at[0]},
                      {at[2] - at[1], at[3] - at[1]},
                      {at[0] - at[2], at[1] - at[2]},
                      {at[0] - at[3], at[1] - at[3]}};
  return contact.happens();
}

}  // namespace ergon
