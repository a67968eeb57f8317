#pragma once
// Squared distances of what is given in doubles, without rounding.

#include <gmpxx.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>

namespace ergon::exact {

using Point = std::array<mpq_class, 3>;

inline Point point(const Eigen::Vector3d& p) { return {mpq_class(p.x()), mpq_class(p.y()), mpq_class(p.z())}; }
inline Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline mpq_class dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline mpq_class point_edge(const Point& p, const Point& e0, const Point& e1) {
  const Point e = minus(e1, e0), d = minus(p, e0);
  const mpq_class along = dot(d, e), length2 = dot(e, e);
  if (along <= 0) return dot(d, d);
  if (along >= length2) return dot(minus(p, e1), minus(p, e1));
  return dot(d, d) - along * along / length2;
}

inline mpq_class point_triangle(const Point& p, const Point& t0, const Point& t1, const Point& t2) {
  const mpq_class sides = std::min({point_edge(p, t0, t1), point_edge(p, t1, t2), point_edge(p, t2, t0)});
  const Point n = cross(minus(t1, t0), minus(t2, t0));
  const mpq_class n2 = dot(n, n);
  if (n2 == 0) return sides;
  const auto left = [&](const Point& a, const Point& b) { return dot(n, cross(minus(b, a), minus(p, a))) >= 0; };
  if (!left(t0, t1) || !left(t1, t2) || !left(t2, t0)) return sides;
  const mpq_class height = dot(n, minus(p, t0));
  return height * height / n2;
}

inline mpq_class edge_edge(const Point& a0, const Point& a1, const Point& b0, const Point& b1) {
  const mpq_class ends =
      std::min({point_edge(a0, b0, b1), point_edge(a1, b0, b1), point_edge(b0, a0, a1), point_edge(b1, a0, a1)});
  const Point a = minus(a1, a0), b = minus(b1, b0), from = minus(b0, a0), n = cross(a, b);
  const mpq_class n2 = dot(n, n);
  if (n2 == 0) return ends;
  const mpq_class s = dot(cross(from, b), n), t = dot(cross(from, a), n);
  if (s < 0 || s > n2 || t < 0 || t > n2) return ends;
  const mpq_class height = dot(n, from);
  return height * height / n2;
}

}  // namespace ergon::exact
