#include "runtime/contact/step_bound.h"

#include <algorithm>

#include "runtime/contact/ccd.h"

namespace ergon {
namespace {

using Step = double (*)(const CcdQuery&);

// Gathers the vertices of one pair after the other.
template <size_t count, class Vertices>
double over_pairs(const std::vector<std::array<int, 2>>& pairs, const CollisionSurface& surface,
                  const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction, double kept, double longest,
                  const Step& step, int second, const Vertices& vertices) {
  double best = longest;
  const auto size = static_cast<std::ptrdiff_t>(pairs.size());
#pragma omp parallel reduction(min : best)
  {
    double own = longest;
#pragma omp for schedule(static) nowait
    for (std::ptrdiff_t i = 0; i < size; ++i) {
      const auto& pair = pairs[static_cast<size_t>(i)];
      const std::array<int, count> v = vertices(static_cast<size_t>(pair[0]), static_cast<size_t>(pair[1]));
      Eigen::Vector3d at[count], motion[count];
      for (size_t k = 0; k < count; ++k) {
        at[k] = x.col(v[k]);
        motion[k] = direction.col(v[k]);
      }
      const int object_a = surface.object[static_cast<size_t>(v[0])];
      const int object_b = surface.object[static_cast<size_t>(v[static_cast<size_t>(second)])];
      own = std::min(own, step({at, motion, surface.offset(object_a, object_b), kept, own}));
    }
    best = std::min(best, own);
  }
  return best;
}

}  // namespace

double largest_step(const CollisionSurface& surface, const Candidates& candidates, const Eigen::Matrix3Xd& x,
                    const Eigen::Matrix3Xd& direction, double kept) {
  const auto& points = surface.points;
  const auto& edges = surface.edges;
  const auto& triangles = surface.triangles;
  double step = 1;
  step = over_pairs<4>(candidates.point_triangle, surface, x, direction, kept, step, point_triangle_step, 1,
                       [&](size_t p, size_t t) {
                         return std::array<int, 4>{points[p], triangles[t][0], triangles[t][1], triangles[t][2]};
                       });
  step = over_pairs<4>(candidates.edge_edge, surface, x, direction, kept, step, edge_edge_step, 2,
                       [&](size_t a, size_t b) {
                         return std::array<int, 4>{edges[a][0], edges[a][1], edges[b][0], edges[b][1]};
                       });
  step = over_pairs<3>(candidates.point_edge, surface, x, direction, kept, step, point_edge_step, 1,
                       [&](size_t p, size_t e) {
                         return std::array<int, 3>{points[p], edges[e][0], edges[e][1]};
                       });
  return over_pairs<2>(candidates.point_point, surface, x, direction, kept, step, point_point_step, 1,
                       [&](size_t p, size_t q) {
                         return std::array<int, 2>{points[p], points[q]};
                       });
}

}  // namespace ergon
