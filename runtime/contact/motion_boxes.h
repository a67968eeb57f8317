#pragma once
// Boxes that hold the points of a surface during a straight motion, with room to spare. It establishes when a later
// motion stays within them: then primitives that come near each other on it have boxes that meet.
//
// The boxes of an object move along with its mean motion, so that a body in flight has small ones. Two objects that
// move differently meet where their boxes do at any displacement that they have against each other on the way.

#include <Eigen/Core>
#include <vector>

#include "runtime/contact/box_tree.h"
#include "runtime/contact/collision_surface.h"
#include "runtime/contact/pair_list.h"
#include "runtime/contact/slack.h"

namespace ergon {

class MotionBoxes {
 public:
  explicit MotionBoxes(const CollisionSurface& surface);

  // Vertices of the system have numbers of their own here, in the order of surface.points; -1: it is no point.
  int number_of(int vertex) const { return number_[static_cast<size_t>(vertex)]; }

  // m: how far a point, with half of reach and its radius, leaves its box on the way from x0 to x1, at most. At most 0:
  // the boxes that were made hold this motion; +inf while none were.
  double excess(const Eigen::Matrix3Xd& x0, const Eigen::Matrix3Xd& x1, double reach) const;

  // Makes boxes for this motion, whose excess over the last ones is given, and for the reach that `slack` knows; they
  // leave each point its slack and a quarter of its motion against its object to spare. Throws InputError for a point
  // without finite position.
  void make(const Eigen::Matrix3Xd& x0, const Eigen::Matrix3Xd& x1, double excess, Slack& slack);

  const std::vector<IntegerBox>& boxes() const { return boxes_; }  // in units that fit all into an int
  // m, per point: how far from its start, seen from its object, it may act: its motion, radius and half of reach.
  const std::vector<double>& range() const { return range_; }
  Shift shift(int object_a, int object_b) const;  // on the way
  // Where an object is on the way, in its box or displaced by its motion.
  Shift drift(int object) const;

 private:
  double half(double reach, int vertex) const;
  size_t object_of(int vertex) const { return static_cast<size_t>(surface_->object[static_cast<size_t>(vertex)]); }
  void find_drift(const Eigen::Matrix3Xd& x0, const Eigen::Matrix3Xd& x1);
  // How much of the way the objects have gone, at best.
  double fraction(const Eigen::Matrix3Xd& x) const;
  Shift in_units(const Eigen::Vector3d& move) const;

  const CollisionSurface* surface_;
  std::vector<int> number_;
  std::vector<double> count_;  // points per object
  struct Box {
    Eigen::Vector3d lower, upper;  // m
  };
  std::vector<Box> held_;                       // per point
  std::vector<Eigen::Vector3d> start_, drift_;  // per object: sum of points and mean motion, m
  bool still_ = true;                           // no object has a mean motion
  double reach_ = 0;                            // m
  double units_ = 0;                            // per m
  std::vector<IntegerBox> boxes_;
  std::vector<double> range_;
};

}  // namespace ergon
