#pragma once
// What Newton's method asks of contact, whatever the shapes in contact are. It establishes that every state that is
// evaluated has exactly the stencils that are within the activation distance there, and that no state between two
// iterates is in penetration.

#include <Eigen/Core>

namespace ergon {

class Contact {
 public:
  virtual ~Contact() = default;

  // Gives the barrier potentials the stencils that are active at x. Called before each evaluation.
  virtual void set_active(const Eigen::Matrix3Xd& x) = 0;

  // A fraction in (0, 1] such that x + t*direction is free of penetration for all t up to it.
  virtual double largest_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) = 0;

  // The largest change of an active gap along the direction, as a fraction of that gap. Newton's method is near its
  // limit only where this is small: next to a barrier it doubles the gap by a step of the length of the gap, however
  // far the limit.
  virtual double gap_change(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) = 0;

  // Called after each accepted iterate. True when the barrier's stiffness was changed, so that energies computed before
  // no longer compare.
  virtual bool adapt(const Eigen::Matrix3Xd& x) = 0;
};

}  // namespace ergon
