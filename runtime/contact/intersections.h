#pragma once
// Exact test for intersections of a surface: every edge against every triangle that it may meet, in arithmetic without
// rounding. Coplanar and touching primitives count as intersecting; those that share a vertex are not tested.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "runtime/contact/box_tree.h"
#include "runtime/contact/collision_surface.h"
#include "runtime/contact/pair_list.h"

namespace ergon {

struct Intersection {
  std::array<int, 2> edge;  // vertices of the system
  std::array<int, 3> triangle;
};

// Keeps its trees from state to state.
class IntersectionFinder {
 public:
  // `surface` must outlive this. What is in it may not change, but for which objects meet.
  explicit IntersectionFinder(const CollisionSurface& surface);
  IntersectionFinder(const IntersectionFinder&) = delete;
  IntersectionFinder& operator=(const IntersectionFinder&) = delete;

  // x: 3 x vertices of the system, m. Ordered by edge, then triangle. Throws InputError for a position that is not
  // finite.
  std::vector<Intersection> find(const Eigen::Matrix3Xd& x);

 private:
  const CollisionSurface* surface_;
  BoxTree edges_, triangles_;
  PairList near_;
  std::vector<std::array<int, 2>> pairs_, meeting_;
};

// The same of one state.
std::vector<Intersection> find_intersections(const CollisionSurface& surface, const Eigen::Matrix3Xd& x);

}  // namespace ergon
