#pragma once
// Boxes that hold the points of a surface during a straight motion, with room to spare. It establishes when a later
// motion stays within them: then primitives that come near each other on it have boxes that meet.

#include <Eigen/Core>
#include <vector>

#include "runtime/contact/box_tree.h"
#include "runtime/contact/collision_surface.h"

namespace ergon {

class MotionBoxes {
 public:
  explicit MotionBoxes(const CollisionSurface& surface);

  // Vertices of the system have numbers of their own here, in the order of surface.points; -1: it is no point.
  int number_of(int vertex) const { return number_[static_cast<size_t>(vertex)]; }

  // Whether boxes were made that hold each point, by half of reach and its radius, on the way from x0 to x1.
  bool hold(const Eigen::Matrix3Xd& x0, const Eigen::Matrix3Xd& x1, double reach) const;

  // Makes boxes for this motion that leave each point `slack` and a quarter of its motion (m) to spare. Throws
  // InputError for a point without finite position.
  void make(const Eigen::Matrix3Xd& x0, const Eigen::Matrix3Xd& x1, double reach, double slack);

  const std::vector<IntegerBox>& boxes() const { return boxes_; }  // in units of the smallest cube around all

 private:
  double half(double reach, int vertex) const;

  const CollisionSurface* surface_;
  std::vector<int> number_;
  struct Box {
    Eigen::Vector3d lower, upper;  // m
  };
  std::vector<Box> held_;  // per point
  std::vector<IntegerBox> boxes_;
};

}  // namespace ergon
