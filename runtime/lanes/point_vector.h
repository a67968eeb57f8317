#pragma once
// Points in space, one per lane, and what is nearest on an edge: runtime/contact/nearest_points.h without branches.

#include "runtime/lanes/projection_vector.h"

namespace ergon::lanes {
namespace {

struct Point {
  Real x, y, z;
};
inline Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Point operator*(Real s, const Point& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Real dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Point select(Mask m, const Point& a, const Point& b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}

// Coordinates of vertices one after the other; `first`: of the pairs.
template <int kPairs>
inline Point point_of(const double (*coordinate)[kPairs], int vertex, int first) {
  return {load(coordinate[3 * vertex] + first), load(coordinate[3 * vertex + 1] + first),
          load(coordinate[3 * vertex + 2] + first)};
}

template <int kPairs>
inline void gather(const double* x, int vertex, int to, int at, double (*coordinate)[kPairs]) {
  const double* from = x + 3 * static_cast<long>(vertex);
  for (int k = 0; k < 3; ++k) coordinate[3 * to + k][at] = from[k];
}

// What is behind the last pair repeats it.
inline int padded(int count) { return (count + kWidth - 1) / kWidth * kWidth; }

struct OnEdge {
  Real gap2, part;
  Point at;
};

// The point of the edge from a to b = a + along that is nearest to the origin, counted from the nearer end.
inline OnEdge on_edge(const Point& a, const Point& b, const Point& along) {
  const Real zero = splat(0), from_a = zero - dot(a, along), from_b = dot(b, along);
  const Mask near_a = less(from_a, from_b);
  const Real away = select(near_a, from_a, from_b);
  const Real part =
      select(near_a, select(less(zero, from_a), splat(3), splat(1)), select(less(zero, from_b), splat(3), splat(2)));
  // A NaN, of an edge without length, stays one.
  const Real fraction = select(less(away, zero), zero, away) / (from_a + from_b);
  const Real step = select(near_a, fraction, zero - fraction);
  const Point at = select(near_a, a, b) + step * along;
  return {dot(at, at), part, at};
}

}  // namespace
}  // namespace ergon::lanes
