#pragma once
// Of pairs whose boxes meet, those that are near enough to come within reach while each point stays in its box. Boxes
// of edges and triangles that lie askew are mostly empty: about half of the pairs go.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "runtime/contact/collision_surface.h"
#include "runtime/contact/motion_boxes.h"

namespace ergon {

class NearPairs {
 public:
  explicit NearPairs(const CollisionSurface& surface) : surface_(&surface) {}

  // From now on for boxes made at x, which must outlive the calls below.
  void prepare(const MotionBoxes& motion, const Eigen::Matrix3Xd& x);

  // Moves those to keep to the front, in their order, and returns how many there are. drift: m, how far the objects of
  // these pairs may be displaced against each other.
  long keep_point_triangle(std::array<int, 2>* pairs, long count, double drift) const;
  long keep_edge_edge(std::array<int, 2>* pairs, long count, double drift) const;

 private:
  const CollisionSurface* surface_;
  const Eigen::Matrix3Xd* x_ = nullptr;
  // m, per primitive: how far from where it is now a part of it may act.
  const std::vector<double>* points_ = nullptr;
  std::vector<double> edges_, triangles_;
};

}  // namespace ergon
