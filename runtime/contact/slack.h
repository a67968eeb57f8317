#pragma once
// How much farther than asked candidates reach, so that they stay good for what is asked next. The aim is that a list
// serves through the iterations of a time step: one that served few requests, and would have served the next with twice
// the slack, is followed by one with more; one that served many, or that no slack would have saved, by one with less.

#include <Eigen/Core>

#include "runtime/contact/collision_surface.h"

namespace ergon {

class Slack {
 public:
  // Before each request, whether or not the present list serves it.
  void ask(double reach);

  // m: the largest reach lately asked for. Requests of active sets and of steps alternate and differ in it.
  double reach() const { return reach_; }

  // m: for a list that is made at x. `motion`: the mean of the points' motion against their objects; `excess`: by how
  // much the last list missed this motion, m.
  double next(const CollisionSurface& surface, const Eigen::Matrix3Xd& x, double motion, double excess);

 private:
  double reach_ = 0, motion_ = 0;
  double factor_ = 1;
  long requests_ = 0;  // since the last list
  double slack_ = 0;
};

}  // namespace ergon
