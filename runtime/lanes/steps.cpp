// The first planes between pairs of primitives that move, for one vector width. The argument, and what is said of
// rounding, is that of runtime/contact/ccd.cpp.

#include "runtime/lanes/steps.h"

#include "runtime/lanes/point_vector.h"

namespace ergon::lanes {

#define ERGON_JOIN(a, b) a##b
#define ERGON_STEPS(width) ERGON_JOIN(step_operations_, width)
const StepOperations& ERGON_STEPS(ERGON_LANES)();

namespace {

constexpr double kRounding = 0x1p-48;
constexpr double kMore = 1 + 0x1p-49;
constexpr double kTiny = 0x1p-1000;

inline Real length1(const Point& a) { return abs(a.x) + abs(a.y) + abs(a.z); }

// Lanes whose hull of from[k] + t*rate[k] stays on its side of the plane across n up to at_most; gap2: of some point of
// the hull at the start.
template <int corners>
inline Mask stays_apart(const Point (&from)[corners], const Point (&rate)[corners], const Point& n, Real gap2,
                        Real separation, const StepTask& task) {
  const Real zero = splat(0);
  Real size = length1(from[0]), speed = length1(rate[0]);
  for (int k = 1; k < corners; ++k) {
    size = max(size, length1(from[k]));
    speed = max(speed, length1(rate[k]));
  }
  const Real error = splat(kRounding) * (size + speed), gap = splat(kMore) * sqrt(gap2) + error;
  const Real target = separation + splat(task.kept) * max(zero, gap - separation);
  const Real limit = splat(kMore) * target + error, length2 = dot(n, n);
  const Point unit = (splat(1) / sqrt(length2)) * n;
  Mask apart = both(less(splat(kTiny), length2), less(error, splat(0x1p-10) * (gap - target)));
  for (int k = 0; k < corners; ++k) {
    const Real start = dot(unit, from[k]) - limit, end = start + splat(task.at_most) * dot(unit, rate[k]);
    apart = both(apart, both(less(zero, start), less(zero, end)));
  }
  return apart;
}

inline Point along_normal(const Point& at, const Point& normal) {
  const Real s = copysign(splat(1), dot(at, normal));
  return s * normal;
}

// Lists the lanes that are not set.
inline int list(unsigned free, int first, int count, int left, StepRoom& room) {
  for (unsigned open = ~free & kAllLanes; open != 0; open &= open - 1) {
    const int i = first + __builtin_ctz(open);
    if (i < count) room.left[left++] = i;
  }
  return left;
}

int point_triangle(const StepTask& task, const int* points, const int (*triangles)[3], const int (*pairs)[2], int count,
                   StepRoom& room) {
  const int all = padded(count);
  for (int i = 0; i < all; ++i) {
    const int* pair = pairs[i < count ? i : count - 1];
    const int* triangle = triangles[pair[1]];
    const int vertices[4] = {points[pair[0]], triangle[0], triangle[1], triangle[2]};
    for (int k = 0; k < 4; ++k) {
      gather(task.x, vertices[k], k, i, room.coordinate);
      gather(task.direction, vertices[k], k, i, room.motion);
    }
  }
  for (int i = count; i < all; ++i) room.separation[i] = room.separation[count - 1];
  int left = 0;
  for (int i = 0; i < all; i += kWidth) {
    const Point p = point_of(room.coordinate, 0, i), move = point_of(room.motion, 0, i);
    Point from[3], rate[3];
    for (int k = 0; k < 3; ++k) {
      from[k] = point_of(room.coordinate, k + 1, i) - p;
      rate[k] = point_of(room.motion, k + 1, i) - move;
    }
    const Point &a = from[0], &b = from[1], &c = from[2], ab = b - a, bc = c - b, ca = a - c;
    const OnEdge first = on_edge(a, b, ab), second = on_edge(b, c, bc), third = on_edge(c, a, ca);
    Mask nearer = less(second.gap2, first.gap2);
    Real gap2 = select(nearer, second.gap2, first.gap2);
    Point n = select(nearer, second.at, first.at);
    nearer = less(third.gap2, gap2);
    gap2 = select(nearer, third.gap2, gap2);
    n = select(nearer, third.at, n);
    const Point normal = cross(ab, bc);
    const Real zero = splat(0), wa = dot(normal, cross(b, bc)), wb = dot(normal, cross(c, ca)),
               wc = dot(normal, cross(a, ab));
    const Real scale = splat(1) / (wa + wb + wc);
    const Point at = (scale * wa) * a + (scale * wb) * b + (scale * wc) * c;
    const Real face = dot(at, at);
    const Mask inside = both(both(less(zero, wa), less(zero, wb)), both(less(zero, wc), less(face, gap2)));
    gap2 = select(inside, face, gap2);
    n = select(inside, along_normal(at, normal), n);
    const Mask apart = stays_apart(from, rate, n, gap2, load(room.separation + i), task);
    left = list(bits(apart), i, count, left, room);
  }
  return left;
}

int edge_edge(const StepTask& task, const int (*edges)[2], const int (*pairs)[2], int count, StepRoom& room) {
  const int all = padded(count);
  for (int i = 0; i < all; ++i) {
    const int* pair = pairs[i < count ? i : count - 1];
    for (int k = 0; k < 4; ++k) {
      gather(task.x, edges[pair[k / 2]][k % 2], k, i, room.coordinate);
      gather(task.direction, edges[pair[k / 2]][k % 2], k, i, room.motion);
    }
  }
  for (int i = count; i < all; ++i) room.separation[i] = room.separation[count - 1];
  const Real zero = splat(0), half = splat(0.5), one = splat(1);
  int left = 0;
  for (int i = 0; i < all; i += kWidth) {
    Point from[4], rate[4];
    for (int k = 0; k < 4; ++k) {
      from[k] = point_of(room.coordinate, 2 + k % 2, i) - point_of(room.coordinate, k / 2, i);
      rate[k] = point_of(room.motion, 2 + k % 2, i) - point_of(room.motion, k / 2, i);
    }
    const Point a = from[0] - from[2], b = from[1] - from[0], minus_a = from[2] - from[0];
    const OnEdge ends[4] = {on_edge(from[0], from[1], b), on_edge(from[2], from[3], b),
                            on_edge(from[0], from[2], minus_a), on_edge(from[1], from[3], minus_a)};
    Real gap2 = ends[0].gap2;
    Point n = ends[0].at;
    for (int k = 1; k < 4; ++k) {
      const Mask nearer = less(ends[k].gap2, gap2);
      gap2 = select(nearer, ends[k].gap2, gap2);
      n = select(nearer, ends[k].at, n);
    }
    const Point normal = cross(a, b);
    const Real n2 = dot(normal, normal), s = dot(cross(from[0], b), normal), t = dot(cross(from[0], a), normal);
    const Real ws = s / n2, wt = t / n2;
    const Mask second_a = less(half, ws), second_b = less(half, wt);
    const Point base = select(second_a, select(second_b, from[3], from[2]), select(second_b, from[1], from[0]));
    const Point at = base - select(second_a, ws - one, ws) * a + select(second_b, wt - one, wt) * b;
    const Real within = dot(at, at);
    const Mask inside =
        both(both(both(less(zero, s), less(zero, t)), both(less(s, n2), less(t, n2))), less(within, gap2));
    gap2 = select(inside, within, gap2);
    n = select(inside, along_normal(at, normal), n);
    const Mask apart = stays_apart(from, rate, n, gap2, load(room.separation + i), task);
    left = list(bits(apart), i, count, left, room);
  }
  return left;
}

}  // namespace

const StepOperations& ERGON_STEPS(ERGON_LANES)() {
  static const StepOperations operations{point_triangle, edge_edge};
  return operations;
}

}  // namespace ergon::lanes
