// Distances of pairs of primitives, for one vector width.

#include "runtime/lanes/distances.h"

#include "runtime/lanes/point_vector.h"

namespace ergon::lanes {

#define ERGON_JOIN(a, b) a##b
#define ERGON_DISTANCES(width) ERGON_JOIN(distance_operations_, width)
const DistanceOperations& ERGON_DISTANCES(ERGON_LANES)();

namespace {

constexpr double kNear = 0x1p-36;  // of the size squared: below it runtime/contact/distance.cpp takes twice the digits

inline void keep(int first, Real gap2, Real part, Real size2, DistanceRoom& room) {
  store(room.gap2 + first, select(less_equal(splat(kNear) * size2, gap2), gap2, splat(-1)));
  store(room.part + first, part);
}

void point_triangle(const double* x, const int* points, const int (*triangles)[3], const int (*pairs)[2], int count,
                    DistanceRoom& room) {
  const int all = padded(count);
  for (int i = 0; i < all; ++i) {
    const int* pair = pairs[i < count ? i : count - 1];
    const int* triangle = triangles[pair[1]];
    gather(x, points[pair[0]], 0, i, room.coordinate);
    for (int k = 0; k < 3; ++k) gather(x, triangle[k], 1 + k, i, room.coordinate);
  }
  const Real zero = splat(0);
  for (int i = 0; i < all; i += kWidth) {
    const Point p = point_of(room.coordinate, 0, i), t0 = point_of(room.coordinate, 1, i),
                t1 = point_of(room.coordinate, 2, i), t2 = point_of(room.coordinate, 3, i);
    const Point a = t0 - p, b = t1 - p, c = t2 - p, ab = t1 - t0, bc = t2 - t1, ca = t0 - t2;
    const OnEdge first = on_edge(a, b, ab), second = on_edge(b, c, bc), third = on_edge(c, a, ca);
    // Ends 1, 2, 3 of the sides become corners: (1, 2, 3), (2, 4, 6), (4, 1, 5).
    const Real second_part = second.part + second.part;
    const Real third_part =
        select(less(third.part, splat(1.5)), splat(4), select(less(third.part, splat(2.5)), splat(1), splat(5)));
    Mask nearer = less(second.gap2, first.gap2);
    Real gap2 = select(nearer, second.gap2, first.gap2), part = select(nearer, second_part, first.part);
    nearer = less(third.gap2, gap2);
    gap2 = select(nearer, third.gap2, gap2);
    part = select(nearer, third_part, part);
    const Point normal = cross(ab, bc);
    const Real wa = dot(normal, cross(b, bc)), wb = dot(normal, cross(c, ca)), wc = dot(normal, cross(a, ab));
    const Real scale = splat(1) / (wa + wb + wc);
    const Point at = (scale * wa) * a + (scale * wb) * b + (scale * wc) * c;
    const Real face = dot(at, at);
    nearer = both(both(less(zero, wa), less(zero, wb)), both(less(zero, wc), less(face, gap2)));
    gap2 = select(nearer, face, gap2);
    part = select(nearer, splat(7), part);
    // A NaN in any of them asks for more digits.
    const Real sum = first.gap2 + second.gap2 + third.gap2;
    keep(i, select(less_equal(zero, sum), gap2, sum), part, max(max(dot(a, a), dot(b, b)), dot(c, c)), room);
  }
}

void edge_edge(const double* x, const int (*edges)[2], const int (*pairs)[2], int count, DistanceRoom& room) {
  const int all = padded(count);
  for (int i = 0; i < all; ++i) {
    const int* pair = pairs[i < count ? i : count - 1];
    for (int k = 0; k < 4; ++k) gather(x, edges[pair[k / 2]][k % 2], k, i, room.coordinate);
  }
  const Real zero = splat(0), half = splat(0.5), one = splat(1);
  for (int i = 0; i < all; i += kWidth) {
    const Point a0 = point_of(room.coordinate, 0, i), a1 = point_of(room.coordinate, 1, i),
                b0 = point_of(room.coordinate, 2, i), b1 = point_of(room.coordinate, 3, i);
    const Point from00 = b0 - a0, from01 = b1 - a0, from10 = b0 - a1, from11 = b1 - a1, a = a1 - a0, b = b1 - b0;
    const Point minus_a = {zero - a.x, zero - a.y, zero - a.z};
    const OnEdge ends[4] = {on_edge(from00, from01, b), on_edge(from10, from11, b), on_edge(from00, from10, minus_a),
                            on_edge(from01, from11, minus_a)};
    const Real part_of[4] = {splat(1) + splat(4) * ends[0].part, splat(2) + splat(4) * ends[1].part,
                             ends[2].part + splat(4), ends[3].part + splat(8)};
    Real gap2 = ends[0].gap2, part = part_of[0], sum = gap2;
    for (int k = 1; k < 4; ++k) {
      const Mask nearer = less(ends[k].gap2, gap2);
      gap2 = select(nearer, ends[k].gap2, gap2);
      part = select(nearer, part_of[k], part);
      sum += ends[k].gap2;
    }
    const Point normal = cross(a, b);
    const Real n2 = dot(normal, normal), s = dot(cross(from00, b), normal), t = dot(cross(from00, a), normal);
    const Real scale = one / n2, ws = s * scale, wt = t * scale;
    const Mask second_a = less(half, ws), second_b = less(half, wt);
    const Point base = select(second_a, select(second_b, from11, from10), select(second_b, from01, from00));
    const Point at = base - select(second_a, ws - one, ws) * a + select(second_b, wt - one, wt) * b;
    const Real inside = dot(at, at);
    const Mask within = both(both(less(zero, s), less(zero, t)), both(less(s, n2), less(t, n2)));
    const Mask nearer = both(within, less(inside, gap2));
    gap2 = select(nearer, inside, gap2);
    part = select(nearer, splat(15), part);
    keep(i, select(less_equal(zero, sum), gap2, sum), part, max(dot(a, a), dot(b, b)), room);
    store(room.sine2 + i, n2);
  }
}

}  // namespace

const DistanceOperations& ERGON_DISTANCES(ERGON_LANES)() {
  static const DistanceOperations operations{point_triangle, edge_edge};
  return operations;
}

}  // namespace ergon::lanes
