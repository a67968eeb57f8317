#pragma once
// Nearest points of points, edges and triangles in arithmetic of any precision. Every point that is found lies on its
// primitive and the nearest of several such is taken, so that the distance is never too small by more than rounding,
// whatever the shape.

#include <Eigen/Core>
#include <type_traits>

namespace ergon::nearest {

template <class T>
struct Vector {
  T x, y, z;
};
template <class T>
inline Vector<T> operator+(const Vector<T>& a, const Vector<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
inline Vector<T> operator-(const Vector<T>& a, const Vector<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
inline Vector<T> operator*(const T& s, const Vector<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
inline T dot(const Vector<T>& a, const Vector<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
inline Vector<T> cross(const Vector<T>& a, const Vector<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
// Differences are formed first, of what is given: far from the origin they lose nothing.
template <class T>
inline Vector<T> from_to(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {T(b.x()) - T(a.x()), T(b.y()) - T(a.y()), T(b.z()) - T(a.z())};
}

// The point of an edge or a triangle that is nearest to the origin: `at` is where it is. Parts are those of
// runtime/contact/distance.h.
template <class T, int corners>
struct Nearest {
  T gap2{};
  unsigned part = 0;
  T weight[corners]{};
  Vector<T> at{};
};

// The edge from a to b; along = b - a.
template <class T>
inline Nearest<T, 2> on_edge(const Vector<T>& a, const Vector<T>& b, const Vector<T>& along) {
  const T zero(0.0), one(1.0);
  const T from_a = -dot(a, along), from_b = dot(b, along);
  if (!(from_a > zero)) return {dot(a, a), 1, {one, zero}, a};
  if (!(from_b > zero)) return {dot(b, b), 2, {zero, one}, b};
  // Counted from the nearer end, whose distance is rounded less.
  const T scale = one / (from_a + from_b);
  const bool near_a = from_a < from_b;
  const T less = (near_a ? from_a : from_b) * scale;
  const Vector<T> at = near_a ? a + less * along : b - less * along;
  return {dot(at, at), 3, {near_a ? one - less : less, near_a ? less : one - less}, at};
}

// Whether the angle of two vectors, with the square of their cross product and the product of their squares, is so far
// from zero that what is nearest within their span is known as well as what is nearest on one of them.
template <class T>
inline bool far_from_parallel(const T& normal2, const T& lengths2) {
  return normal2 > T(0x1p-16) * lengths2;
}

// The triangle (a, b, c); ab = b - a, bc = c - b, ca = a - c.
template <class T>
inline Nearest<T, 3> on_triangle(const Vector<T>& a, const Vector<T>& b, const Vector<T>& c, const Vector<T>& ab,
                                 const Vector<T>& bc, const Vector<T>& ca) {
  const T zero(0.0);
  const Vector<T> normal = cross(ab, bc);
  const T wa = dot(normal, cross(b, bc)), wb = dot(normal, cross(c, ca)), wc = dot(normal, cross(a, ab));
  Nearest<T, 3> face{};
  const bool inside = wa > zero && wb > zero && wc > zero;
  if (inside) {
    const T scale = T(1.0) / (wa + wb + wc);
    face = {zero, 7, {scale * wa, scale * wb, scale * wc}, {}};
    face.at = face.weight[0] * a + face.weight[1] * b + face.weight[2] * c;
    if constexpr (!std::is_same_v<T, double>) {
      // Slivers: what is left along the face is solved for once more.
      const T da = scale * dot(normal, cross(face.at, bc)), db = scale * dot(normal, cross(face.at, ca));
      face.weight[0] = face.weight[0] + da;
      face.weight[1] = face.weight[1] + db;
      face.weight[2] = face.weight[2] - da - db;
      face.at = face.at + da * ca - db * bc;
    }
    face.gap2 = dot(face.at, face.at);
    if (far_from_parallel(dot(normal, normal), dot(ab, ab) * dot(bc, bc))) return face;
  }
  const Nearest<T, 2> sides[3] = {on_edge(a, b, ab), on_edge(b, c, bc), on_edge(c, a, ca)};
  int best = 0;
  if (sides[1].gap2 < sides[best].gap2) best = 1;
  if (sides[2].gap2 < sides[best].gap2) best = 2;
  if (inside && face.gap2 < sides[best].gap2) return face;
  const Nearest<T, 2>& side = sides[best];
  Nearest<T, 3> result{side.gap2, 0, {zero, zero, zero}, side.at};
  const int first = best, second = (best + 1) % 3;
  result.weight[first] = side.weight[0];
  result.weight[second] = side.weight[1];
  result.part = (side.part & 1u) << first | (side.part >> 1) << second;
  return result;
}

// The nearest points of two edges; `at` leads from that of a to that of b.
template <class T>
struct NearestOfEdges {
  T gap2{};
  unsigned part_a = 0, part_b = 0;
  T weight_a[2]{}, weight_b[2]{};
  Vector<T> at{};
};

// xy leads from end x of a to end y of b; a and b lead along the edges.
template <class T>
inline NearestOfEdges<T> of_edges(const Vector<T>& from00, const Vector<T>& from01, const Vector<T>& from10,
                                  const Vector<T>& from11, const Vector<T>& a, const Vector<T>& b) {
  const T zero(0.0), one(1.0);
  // The insides: dot(from, a) = dot(from, b) = 0 for from = from00 - s*a + t*b, solved with the common normal.
  const Vector<T> normal = cross(a, b);
  const T n2 = dot(normal, normal);
  const T s = dot(cross(from00, b), normal), t = dot(cross(from00, a), normal);
  NearestOfEdges<T> inside{};
  const bool within = s > zero && t > zero && s < n2 && t < n2;
  if (within) {
    const T scale = one / n2, ws = s * scale, wt = t * scale;
    // From the nearer ends.
    const bool second_a = ws > T(0.5), second_b = wt > T(0.5);
    const Vector<T>& base = second_a ? (second_b ? from11 : from10) : (second_b ? from01 : from00);
    inside = {zero, 3, 3, {one - ws, ws}, {one - wt, wt}, {}};
    inside.at = base - (second_a ? ws - one : ws) * a + (second_b ? wt - one : wt) * b;
    if constexpr (!std::is_same_v<T, double>) {
      // Nearly parallel edges: what is left along them is solved for once more.
      const T ds = scale * dot(cross(inside.at, b), normal), dt = scale * dot(cross(inside.at, a), normal);
      inside.weight_a[0] = inside.weight_a[0] - ds;
      inside.weight_a[1] = inside.weight_a[1] + ds;
      inside.weight_b[0] = inside.weight_b[0] - dt;
      inside.weight_b[1] = inside.weight_b[1] + dt;
      inside.at = inside.at - ds * a + dt * b;
    }
    inside.gap2 = dot(inside.at, inside.at);
    if (far_from_parallel(n2, dot(a, a) * dot(b, b))) return inside;
  }
  // Each end with the other edge.
  const Vector<T> minus_a{-a.x, -a.y, -a.z};
  const Nearest<T, 2> ends[4] = {on_edge(from00, from01, b), on_edge(from10, from11, b),
                                 on_edge(from00, from10, minus_a), on_edge(from01, from11, minus_a)};
  int best = 0;
  for (int i = 1; i < 4; ++i) {
    if (ends[i].gap2 < ends[best].gap2) best = i;
  }
  if (within && inside.gap2 < ends[best].gap2) return inside;
  const Nearest<T, 2>& end = ends[best];
  NearestOfEdges<T> result{end.gap2, 0, 0, {zero, zero}, {zero, zero}, end.at};
  const int corner = best & 1;
  auto& own = best < 2 ? result.weight_a : result.weight_b;
  auto& other = best < 2 ? result.weight_b : result.weight_a;
  own[corner] = one;
  other[0] = end.weight[0];
  other[1] = end.weight[1];
  (best < 2 ? result.part_a : result.part_b) = 1u << corner;
  (best < 2 ? result.part_b : result.part_a) = end.part;
  return result;
}

}  // namespace ergon::nearest
