#include "runtime/contact/ccd.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/contact/nearest_points.h"
#include "runtime/double_double.h"

// The distance of two convex primitives is that of the origin from the hull of the differences of their corners,
// from[k] + t*rate[k]. Across any direction n it is at least the least of dot(n, from[k] + t*rate[k])/|n|. Any n gives
// a true bound; that of the nearest points, or of the normal that holds them, gives a tight one. Two planes are tried
// from a time on at which all is known to be apart, and the one that lasts longer is taken:
// - n at rest: sums that are linear in time, above the limit in between two times where they are so;
// - n that turns with the parts, n0 + t*n1 with |n0| = 1 and dot(n0, n1) = 0: |n| <= 1 + |n1|^2 t^2/2, so that sums of
//   second order in time are to stay above zero. It lasts up to |n1| t = 1 at most.
// All rounding is in the dot products, which start from differences of what is given: with |n| <= 2 and t <= 1 it is
// below rounding<T>*(|from| + |rate|), that of times included, which has been added to the limit. Roots are rounded
// down.

namespace ergon {
namespace {

using nearest::Vector;

constexpr double kUnit = 0x1p-53;
// Each sum above is of products that are rounded up to five times before and five times while they are summed.
template <class T>
constexpr double rounding = std::is_same_v<T, double> ? 0x1p-47 : 0x1p-93;
constexpr double kLess = 1 - 16 * kUnit, kMore = 1 + 16 * kUnit;
constexpr double kGain = 0x1p-12;  // of the step: what is not worth another round
constexpr int kRounds = 128;
constexpr double kLonger = 2;  // than any step

template <class T, int corners>
struct Hull {
  Vector<T> from[corners], rate[corners];
};
template <class T, int corners>
struct Now {  // at some time
  Vector<T> at[corners];
  double distance2 = 0;           // of a point of the hull from the origin
  Vector<T> direction{}, turn{};  // of any length; the rate of change of the direction, where the parts make it turn
};

template <class T>
double length1(const Vector<T>& a) {
  return std::abs(static_cast<double>(a.x)) + std::abs(static_cast<double>(a.y)) + std::abs(static_cast<double>(a.z));
}
template <class T>
Vector<T> flip(const Vector<T>& a) {
  return {-a.x, -a.y, -a.z};
}
// Where the gap is far below the size of the parts, the difference of nearest points has lost its direction. The normal
// of the parts has not.
template <class T, int corners>
void along_normal(const Vector<T>& between, const Vector<T>& a, const Vector<T>& b, const Vector<T>& rate_a,
                  const Vector<T>& rate_b, Now<T, corners>& now) {
  now.direction = nearest::cross(a, b);
  now.turn = nearest::cross(rate_a, b) + nearest::cross(a, rate_b);
  if (nearest::dot(between, now.direction) < T(0.0)) {
    now.direction = flip(now.direction);
    now.turn = flip(now.turn);
  }
}
template <class T, int corners>
void off_edge(const Vector<T>& between, const Vector<T>& edge, const Vector<T>& rate, Now<T, corners>& now) {
  const T length2 = nearest::dot(edge, edge);
  if (!(length2 > T(0.0))) return;
  const T scale = T(1.0) / length2;
  now.direction = between - (scale * nearest::dot(between, edge)) * edge;
  now.turn = (-(scale * nearest::dot(now.direction, rate))) * edge;
}

template <class T>
void find_direction(const Hull<T, 1>&, Now<T, 1>& now) {
  now.direction = now.at[0];
  now.distance2 = static_cast<double>(nearest::dot(now.at[0], now.at[0]));
}

template <class T>
void find_direction(const Hull<T, 2>& hull, Now<T, 2>& now) {
  const Vector<T> edge = now.at[1] - now.at[0];
  const auto found = nearest::on_edge(now.at[0], now.at[1], edge);
  now.distance2 = static_cast<double>(found.gap2);
  now.direction = found.at;
  if (found.part == 3) off_edge(found.at, edge, hull.rate[1] - hull.rate[0], now);
}

template <class T>
void find_direction(const Hull<T, 3>& hull, Now<T, 3>& now) {
  const Vector<T> side[3] = {now.at[1] - now.at[0], now.at[2] - now.at[1], now.at[0] - now.at[2]};
  const auto found = nearest::on_triangle(now.at[0], now.at[1], now.at[2], side[0], side[1], side[2]);
  now.distance2 = static_cast<double>(found.gap2);
  now.direction = found.at;
  const auto rate = [&](int k) { return hull.rate[(k + 1) % 3] - hull.rate[k]; };
  if (found.part == 7) along_normal(found.at, side[0], side[1], rate(0), rate(1), now);
  if (found.part == 3) off_edge(found.at, side[0], rate(0), now);
  if (found.part == 6) off_edge(found.at, side[1], rate(1), now);
  if (found.part == 5) off_edge(found.at, side[2], rate(2), now);
}

// Corners: a0 to b0, a0 to b1, a1 to b0, a1 to b1.
template <class T>
void find_direction(const Hull<T, 4>& hull, Now<T, 4>& now) {
  const Vector<T> a = now.at[0] - now.at[2], b = now.at[1] - now.at[0];
  const Vector<T> rate_a = hull.rate[0] - hull.rate[2], rate_b = hull.rate[1] - hull.rate[0];
  const auto found = nearest::of_edges(now.at[0], now.at[1], now.at[2], now.at[3], a, b);
  now.distance2 = static_cast<double>(found.gap2);
  now.direction = found.at;
  if (found.part_a == 3 && found.part_b == 3) {
    along_normal(found.at, a, b, rate_a, rate_b, now);
  } else if (found.part_a == 3) {
    off_edge(found.at, a, rate_a, now);
  } else if (found.part_b == 3) {
    off_edge(found.at, b, rate_b, now);
  }
}

// A time up to which c + b*t + a*t^2 stays above zero, for c > 0, that is not needlessly below the first root.
double first_root(double a, double b, double c) {
  const double square = b * b, product = 4 * a * c;
  if (a >= 0) {
    if (b >= 0 || product > kMore * square) return std::numeric_limits<double>::infinity();
    return kLess * 2 * c / (std::sqrt(std::max(0.0, square - product) + 8 * kUnit * square) - b);
  }
  const double root = std::sqrt(square - product);
  return kLess * (b > 0 ? (b + root) / (-2 * a) : 2 * c / (root - b));
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
    Now<T, corners> now;
    for (int k = 0; k < corners; ++k) now.at[k] = hull.from[k] + T(step) * hull.rate[k];
    find_direction(hull, now);
    if (round == 0) {
      const double gap = kMore * std::sqrt(now.distance2) + error;  // not below the true one
      const double target = query.separation + query.kept * std::max(0.0, gap - query.separation);
      limit = kMore * target + error;  // kMore: also of |n|
      // Twice the digits where rounding is a large part of the way there is.
      if (std::is_same_v<T, double> && !(error < 0x1p-10 * (gap - target))) return {};
    }
    const double length2 = static_cast<double>(nearest::dot(now.direction, now.direction));
    if (!(length2 > std::numeric_limits<double>::min())) return {round > 0, step};
    const T scale(1 / std::sqrt(length2));
    const Vector<T> n0 = scale * now.direction;
    double start[corners], rate[corners], lasts = kLonger;
    for (int k = 0; k < corners; ++k) {
      start[k] = static_cast<double>(nearest::dot(n0, now.at[k]) - T(limit));
      rate[k] = static_cast<double>(nearest::dot(n0, hull.rate[k]));
      if (!(start[k] > 0)) return {round > 0, step};
      if (start[k] < -rate[k] * lasts) lasts = kLess * (start[k] / -rate[k]);
    }
    if (kLess * (step + lasts) < query.at_most) {
      const Vector<T> n1 = scale * now.turn - (scale * nearest::dot(n0, now.turn)) * n0;
      const double turn2 = static_cast<double>(nearest::dot(n1, n1));
      double turning = std::min(kLonger, kLess / std::sqrt(turn2));
      for (int k = 0; k < corners; ++k) {
        const double first = rate[k] + static_cast<double>(nearest::dot(n1, now.at[k]));
        const double second = static_cast<double>(nearest::dot(n1, hull.rate[k])) - kMore * limit * turn2 / 2;
        turning = std::min(turning, first_root(second, first, start[k]));
      }
      lasts = std::max(lasts, turning);
    }
    const double next = kLess * (step + lasts);
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
