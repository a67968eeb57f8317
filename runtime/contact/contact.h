#pragma once
// What Newton's method and a time step ask of contact, whatever the shapes in contact are. It establishes that every
// state that is evaluated has exactly the stencils that are within the activation distance there, and that no state
// between two iterates is in penetration.

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

namespace ergon {

struct ContactStatus {
  bool reached = false;  // something was within dhat since begin_step
  int active = 0;        // pairs within dhat at the last set_active
  int rubbing = 0;       // pairs with a friction force
  double smallest_gap =
      std::numeric_limits<double>::infinity();  // m; +inf where nothing is within dhat (of grounds: none)
  double stiffness = 0;                         // of the barriers, largest; in the unit of their law
  double energy_added = 0;                      // J, by changes of stiffness since begin_step
};

// Between two lags of friction: the sum of the changes of normal forces and the sum of these, N.
struct FrictionChange {
  double change = 0;
  double sum = 0;
  double fraction() const { return change == 0 ? 0 : sum > 0 ? change / sum : 1; }
};

// On every vertex of the system, N.
struct ContactForces {
  Eigen::Matrix3Xd normal;  // of the barriers
  Eigen::Matrix3Xd friction;
};

class Contact {
 public:
  virtual ~Contact() = default;

  // Before the solve of a step of dt seconds from (x, v): chooses the barriers' stiffness where it is still open.
  virtual void begin_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& v, double dt) = 0;

  // Normal forces at x become those of friction, which opposes the displacement from xlag within dt.
  virtual FrictionChange lag_friction(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& xlag, double dt) = 0;

  // Gives the barrier potentials the stencils that are active at x. Called before each evaluation.
  virtual void set_active(const Eigen::Matrix3Xd& x) = 0;

  // A fraction in [0, 1] such that x + t*direction is free of penetration for all t up to it.
  virtual double largest_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) = 0;

  // The largest change of an active gap along the direction, as a fraction of that gap. Newton's method is near its
  // limit only where this is small: next to a barrier it doubles the gap by a step of the length of the gap, however
  // far the limit.
  virtual double gap_change(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) = 0;

  // Called after each accepted iterate. True when the barrier's stiffness was changed, so that energies computed before
  // no longer compare.
  virtual bool adapt(const Eigen::Matrix3Xd& x) = 0;

  // Around the Hessian of a Newton step at x, and once the whole step from x is known: what keeps such steps from going
  // past where friction brings things to rest (friction_secants.h). Energies and gradients do not change. Nothing where
  // there is no friction.
  virtual void begin_hessian(const Eigen::Matrix3Xd&) {}
  virtual void end_hessian() {}
  virtual void judge_step(const Eigen::Matrix3Xd&, const Eigen::Matrix3Xd&) {}

  virtual bool owns(int potential) const = 0;  // index in the system: its lags are set here
  virtual bool rubs(int potential) const = 0;  // of those it owns: friction
  virtual bool has_friction() const = 0;       // some pair has a coefficient of friction
  virtual ContactStatus status(const Eigen::Matrix3Xd& x) = 0;
  // What was left out, "part: reason".
  virtual std::vector<std::string> skipped() const = 0;
};

}  // namespace ergon
