#pragma once
// Exact test for intersections of a surface: every edge against every triangle that it may meet, in arithmetic without
// rounding. Coplanar and touching primitives count as intersecting; those that share a vertex are not tested.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "runtime/contact/collision_surface.h"

namespace ergon {

struct Intersection {
  std::array<int, 2> edge;  // vertices of the system
  std::array<int, 3> triangle;
};

// x: 3 x vertices of the system, m. Ordered by edge, then triangle.
std::vector<Intersection> find_intersections(const CollisionSurface& surface, const Eigen::Matrix3Xd& x);

}  // namespace ergon
