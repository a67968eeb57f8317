#include "runtime/contact/ccd.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/contact/nearest_points.h"
#include "runtime/double_double.h"

// The distance of two convex primitives is that of the origin from the hull of the differences of their corners,
// from[k] + t*rate[k]. For any direction n, |n| <= 1, it is at least the least of dot(n, from[k]) + t*dot(n, rate[k]):
// linear functions of time, so that where they are above the limit at t and at t1, the distance is so in between. Any n
// gives a true bound; that of the nearest points gives a tight one. All rounding is in the dot products, which start
// from differences of what is given and are therefore off by at most rounding<T>*(|from| + |rate|), and in |n|.

namespace ergon {
namespace {

using nearest::Vector;

constexpr double kUnit = 0x1p-53;
// Each of the sums above has two roundings of differences and products and up to five of sums; nearest points have
// some more.
template <class T>
constexpr double rounding = std::is_same_v<T, double> ? 0x1p-48 : 0x1p-94;
constexpr double kLess = 1 - 16 * kUnit, kMore = 1 + 16 * kUnit;
constexpr double kGain = 0x1p-12;  // of the step: what is not worth another round
constexpr int kRounds = 128;

template <class T, int corners>
struct Hull {
  Vector<T> from[corners], rate[corners];
};
template <class T>
struct Toward {
  double distance2 = 0;  // from the origin
  Vector<T> direction{};
};

template <class T>
double length1(const Vector<T>& a) {
  return std::abs(static_cast<double>(a.x)) + std::abs(static_cast<double>(a.y)) + std::abs(static_cast<double>(a.z));
}
template <class T>
Vector<T> flip(const Vector<T>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class T>
Vector<T> at_time(const Vector<T>& from, const Vector<T>& rate, const T& t) {
  return from + t * rate;
}

// Where the gap is far below the size of the parts, the difference of nearest points has lost its direction. The normal
// of the parts has not.
template <class T>
Vector<T> along_normal(const Vector<T>& at, const Vector<T>& normal) {
  return nearest::dot(at, normal) < T(0.0) ? flip(normal) : normal;
}
template <class T>
Vector<T> off_edge(const Vector<T>& at, const Vector<T>& along) {
  const T length2 = nearest::dot(along, along);
  if (!(length2 > T(0.0))) return at;
  return at - (nearest::dot(at, along) / length2) * along;
}

template <class T>
Toward<T> toward(const Hull<T, 1>& hull, const T& t) {
  const Vector<T> at = at_time(hull.from[0], hull.rate[0], t);
  return {static_cast<double>(nearest::dot(at, at)), at};
}

template <class T>
Toward<T> toward(const Hull<T, 2>& hull, const T& t) {
  const Vector<T> a = at_time(hull.from[0], hull.rate[0], t), b = at_time(hull.from[1], hull.rate[1], t);
  const auto found = nearest::on_edge(a, b, b - a);
  return {static_cast<double>(found.gap2), found.part == 3 ? off_edge(found.at, b - a) : found.at};
}

template <class T>
Toward<T> toward(const Hull<T, 3>& hull, const T& t) {
  const Vector<T> a = at_time(hull.from[0], hull.rate[0], t), b = at_time(hull.from[1], hull.rate[1], t),
                  c = at_time(hull.from[2], hull.rate[2], t);
  const Vector<T> ab = b - a, bc = c - b, ca = a - c;
  const auto found = nearest::on_triangle(a, b, c, ab, bc, ca);
  Toward<T> result{static_cast<double>(found.gap2), found.at};
  if (found.part == 7) result.direction = along_normal(found.at, nearest::cross(ab, bc));
  if (found.part == 3) result.direction = off_edge(found.at, ab);
  if (found.part == 6) result.direction = off_edge(found.at, bc);
  if (found.part == 5) result.direction = off_edge(found.at, ca);
  return result;
}

// Corners: a0 to b0, a0 to b1, a1 to b0, a1 to b1.
template <class T>
Toward<T> toward(const Hull<T, 4>& hull, const T& t) {
  Vector<T> at[4];
  for (int k = 0; k < 4; ++k) at[k] = at_time(hull.from[k], hull.rate[k], t);
  const Vector<T> a = at[0] - at[2], b = at[1] - at[0];
  const auto found = nearest::of_edges(at[0], at[1], at[2], at[3], a, b);
  Toward<T> result{static_cast<double>(found.gap2), found.at};
  if (found.part_a == 3 && found.part_b == 3) {
    result.direction = along_normal(found.at, nearest::cross(a, b));
  } else if (found.part_a == 3) {
    result.direction = off_edge(found.at, a);
  } else if (found.part_b == 3) {
    result.direction = off_edge(found.at, b);
  }
  return result;
}

// A step and whether the start could be shown to be apart.
struct Step {
  bool shown = false;
  double step = 0;
};

template <class T, int corners>
Step search(const Hull<T, corners>& hull, const CcdQuery& query) {
  double size = 0, speed = 0;
  for (int k = 0; k < corners; ++k) {
    size = std::max(size, length1(hull.from[k]));
    speed = std::max(speed, length1(hull.rate[k]));
  }
  const double error = rounding<T> * (size + speed);
  double limit = 0, step = 0;
  for (int round = 0; round < kRounds; ++round) {
    const Toward<T> found = toward(hull, T(step));
    if (round == 0) {
      const double gap = kMore * std::sqrt(found.distance2) + error;  // not below the true one
      const double target = query.separation + query.kept * std::max(0.0, gap - query.separation);
      limit = kMore * target + error;  // kMore: also of |n|
      // Twice the digits where rounding is a large part of the way there is.
      if (std::is_same_v<T, double> && !(error < 0x1p-10 * (gap - target))) return {};
    }
    const Vector<T>& n = found.direction;
    const double length2 = static_cast<double>(nearest::dot(n, n));
    if (!(length2 > std::numeric_limits<double>::min())) return {round > 0, step};
    const Vector<T> unit = T(1 / std::sqrt(length2)) * n;
    double next = 1;
    for (int k = 0; k < corners; ++k) {
      const T start = nearest::dot(unit, hull.from[k]) - T(limit), rate = nearest::dot(unit, hull.rate[k]);
      if (!(static_cast<double>(start + T(step) * rate) > 0)) return {round > 0, step};
      const double distance = static_cast<double>(start), approach = -static_cast<double>(rate);
      if (distance < next * approach) next = kLess * (distance / approach);
    }
    if (next >= query.at_most) return {true, query.at_most};
    if (next - step <= kGain * next) return {true, std::max(next, step)};
    step = next;
  }
  return {true, step};
}

template <int corners, class MakeHull>
double step_of(const CcdQuery& query, const MakeHull& hull) {
  const Step step = search<double, corners>(hull(double()), query);
  if (step.shown) return step.step;
  return search<DoubleDouble, corners>(hull(DoubleDouble()), query).step;
}

}  // namespace

double point_point_step(const CcdQuery& q) {
  return step_of<1>(q, [&]<class T>(T) {
    return Hull<T, 1>{{nearest::from_to<T>(q.x[0], q.x[1])}, {nearest::from_to<T>(q.motion[0], q.motion[1])}};
  });
}

double point_edge_step(const CcdQuery& q) {
  return step_of<2>(q, [&]<class T>(T) {
    const auto pairs = [](const Eigen::Vector3d* v, Vector<T>* d) {
      for (int k = 0; k < 2; ++k) d[k] = nearest::from_to<T>(v[0], v[k + 1]);
    };
    Hull<T, 2> hull;
    pairs(q.x, hull.from);
    pairs(q.motion, hull.rate);
    return hull;
  });
}

double point_triangle_step(const CcdQuery& q) {
  return step_of<3>(q, [&]<class T>(T) {
    const auto pairs = [](const Eigen::Vector3d* v, Vector<T>* d) {
      for (int k = 0; k < 3; ++k) d[k] = nearest::from_to<T>(v[0], v[k + 1]);
    };
    Hull<T, 3> hull;
    pairs(q.x, hull.from);
    pairs(q.motion, hull.rate);
    return hull;
  });
}

double edge_edge_step(const CcdQuery& q) {
  return step_of<4>(q, [&]<class T>(T) {
    const auto pairs = [](const Eigen::Vector3d* v, Vector<T>* d) {
      for (int k = 0; k < 4; ++k) d[k] = nearest::from_to<T>(v[k / 2], v[2 + k % 2]);
    };
    Hull<T, 4> hull;
    pairs(q.x, hull.from);
    pairs(q.motion, hull.rate);
    return hull;
  });
}

}  // namespace ergon
