#include "runtime/contact/step_bound.h"

#include <algorithm>

#include "runtime/contact/ccd.h"
#include "runtime/lanes/lanes.h"
#include "runtime/lanes/steps.h"

namespace ergon {
namespace {

using Pair = std::array<int, 2>;

// Of pairs that are looked at to begin with, so that most others are seen to be free up to their bound at once.
constexpr std::ptrdiff_t kSample = 64;
constexpr std::ptrdiff_t kSerial = 1024;  // pairs: fewer are not worth waking other threads
// Of the largest coordinate: positions x + t*direction are rounded twice, and those of affine bodies gather some
// roundings more until they are made anew from the control points.
constexpr double kRounding = 0x1p-47;

template <size_t N>
const int (*plain(const std::vector<std::array<int, N>>& items))[N] {
  return reinterpret_cast<const int(*)[N]>(items.data());
}

struct Motion {
  const CollisionSurface& surface;
  const Eigen::Matrix3Xd& x;
  const Eigen::Matrix3Xd& direction;
  double kept;
  double rounding;  // m, of distances

  // `second`: the first vertex of the other primitive.
  template <size_t count>
  double step(RestOffsets::Kind kind, const Pair& pair, const std::array<int, count>& v, size_t second,
              double (*of)(const CcdQuery&), double at_most) const {
    Eigen::Vector3d at[count], motion[count];
    for (size_t k = 0; k < count; ++k) {
      at[k] = x.col(v[k]);
      motion[k] = direction.col(v[k]);
    }
    return of({at, motion, surface.offset(kind, pair, v[0], v[second]) + rounding, kept, at_most});
  }
};

// The smallest of at_most and of step(pair, at_most) over every `stride`-th pair. Steps are the smaller of at_most and
// of what they are without it, so that it makes no difference which pair comes first.
template <class Step>
double smallest(const std::vector<Pair>& pairs, std::ptrdiff_t stride, double at_most, const Step& step) {
  const auto count = static_cast<std::ptrdiff_t>(pairs.size());
  double best = at_most;
#pragma omp parallel reduction(min : best) if (count / stride > kSerial)
  {
    double own = at_most;
#pragma omp for schedule(static) nowait
    for (std::ptrdiff_t i = 0; i < count; i += stride) own = step(pairs[static_cast<size_t>(i)], own);
    best = std::min(best, own);
  }
  return best;
}

// The same over all pairs, of which `filter(pairs, count, at_most, room)` leaves some. All pairs are filtered with one
// bound, so that the result does not depend on how they are shared out.
template <class Filter, class Step>
double smallest_of_many(const std::vector<Pair>& pairs, double at_most, const Filter& filter, const Step& step) {
  const double bound = smallest(pairs, kSample, at_most, step);
  if (!(bound > 0)) return 0;
  const auto count = static_cast<std::ptrdiff_t>(pairs.size());
  double best = bound;
#pragma omp parallel reduction(min : best) if (count > kSerial)
  {
    double own = bound;
    lanes::StepRoom room;
#pragma omp for schedule(static) nowait
    for (std::ptrdiff_t first = 0; first < count; first += lanes::kSteps) {
      const Pair* block = pairs.data() + first;
      const int size = static_cast<int>(std::min<std::ptrdiff_t>(lanes::kSteps, count - first));
      const int left = filter(block, size, bound, room);
      for (int i = 0; i < left; ++i) own = step(block[room.left[i]], own);
    }
    best = std::min(best, own);
  }
  return best;
}

double rounding_of(const CollisionSurface& surface, const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) {
  double extent = 0;
  for (const int v : surface.points)
    extent = std::max(extent, (x.col(v).cwiseAbs() + direction.col(v).cwiseAbs()).maxCoeff());
  return kRounding * extent;
}

}  // namespace

double largest_step(const CollisionSurface& surface, const Candidates& candidates, const Eigen::Matrix3Xd& x,
                    const Eigen::Matrix3Xd& direction, double kept) {
  const Motion motion{surface, x, direction, kept, rounding_of(surface, x, direction)};
  const auto& points = surface.points;
  const auto& edges = surface.edges;
  const auto& triangles = surface.triangles;
  const lanes::StepOperations& operations = lanes::step_operations(lanes::best_lanes());
  const auto point = [&](int i) { return points[static_cast<size_t>(i)]; };
  const auto edge = [&](int i) -> const auto& { return edges[static_cast<size_t>(i)]; };
  const auto triangle = [&](int i) -> const auto& { return triangles[static_cast<size_t>(i)]; };

  double step = smallest_of_many(
      candidates.point_triangle, 1,
      [&](const Pair* pairs, int count, double at_most, lanes::StepRoom& room) {
        for (int i = 0; i < count; ++i) {
          room.separation[i] =
              surface.offset(RestOffsets::point_triangle, pairs[i], point(pairs[i][0]), triangle(pairs[i][1])[0]) +
              motion.rounding;
        }
        return operations.point_triangle({x.data(), direction.data(), kept, at_most}, points.data(), plain(triangles),
                                         reinterpret_cast<const int(*)[2]>(pairs), count, room);
      },
      [&](const Pair& pair, double at_most) {
        const auto& t = triangle(pair[1]);
        return motion.step<4>(RestOffsets::point_triangle, pair, {point(pair[0]), t[0], t[1], t[2]}, 1,
                              point_triangle_step, at_most);
      });
  step = smallest_of_many(
      candidates.edge_edge, step,
      [&](const Pair* pairs, int count, double at_most, lanes::StepRoom& room) {
        for (int i = 0; i < count; ++i) {
          room.separation[i] =
              surface.offset(RestOffsets::edge_edge, pairs[i], edge(pairs[i][0])[0], edge(pairs[i][1])[0]) +
              motion.rounding;
        }
        return operations.edge_edge({x.data(), direction.data(), kept, at_most}, plain(edges),
                                    reinterpret_cast<const int(*)[2]>(pairs), count, room);
      },
      [&](const Pair& pair, double at_most) {
        const auto &a = edge(pair[0]), &b = edge(pair[1]);
        return motion.step<4>(RestOffsets::edge_edge, pair, {a[0], a[1], b[0], b[1]}, 2, edge_edge_step, at_most);
      });
  step = smallest(candidates.point_edge, 1, step, [&](const Pair& pair, double at_most) {
    return motion.step<3>(RestOffsets::point_edge, pair, {point(pair[0]), edge(pair[1])[0], edge(pair[1])[1]}, 1,
                          point_edge_step, at_most);
  });
  return smallest(candidates.point_point, 1, step, [&](const Pair& pair, double at_most) {
    return motion.step<2>(RestOffsets::point_point, pair, {point(pair[0]), point(pair[1])}, 1, point_point_step,
                          at_most);
  });
}

}  // namespace ergon
