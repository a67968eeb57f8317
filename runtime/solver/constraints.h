#pragma once
// Constraints that a step keeps within a tolerance, whatever the stiffness of their laws: the method of multipliers
// around a step's solves. It establishes that a step that is accepted ends with every constraint within its tolerance.
//
// The law is an augmented energy (symbolic/augmented.h), which says with the lag `constraint_shift` what c is and needs
// no code of its own: for value(c + shift) the force on c at c = 0 is value'(shift), and c is what the law's renewed
// shift differs from the one it has by. After a solve whose c is too large each shift grows by its c; one whose c did
// not fall enough is hardened too, by `constraint_hardening`, with its force as it is. Shift and hardening last from
// step to step, as parts of the state. Source: Nocedal, Wright 2006, Numerical Optimization, 2nd ed., section 17.3.

#include <string>
#include <vector>

#include "runtime/system.h"

namespace ergon {

struct Constraint {
  int potential = 0;
  double tolerance = 0;  // of |c|, in its unit
  std::string unit{};    // of c, for messages
};

// The stencil or point of quadrature that is furthest beyond its tolerance.
struct Violation {
  int constraint = 0;  // among those given
  int stencil = 0;
  double value = 0;   // |c|
  double excess = 0;  // |c| over its tolerance; 1 or less: all constraints are kept
};

class Constraints {
 public:
  Constraints() = default;
  // Throws InputError for a tolerance that is not positive, and a potential whose law is not augmented.
  Constraints(System& system, std::vector<Constraint> constraints);

  bool empty() const { return all_.empty(); }
  // Shift and hardening as the system's potentials have them now: `internal` as in State, empty for none yet.
  void start(System& system, const std::vector<StencilData>& internal);
  // At positions x.
  Violation violation(System& system, const Eigen::Matrix3Xd& x) const;
  // After a solve that ended in x: shifts all that are given, hardens what did not fall enough since the call before.
  // Returns by how much the energy of the state changed, J.
  double tighten(System& system, const Eigen::Matrix3Xd& x);
  // What the state keeps of a potential: its shifts as they are, not renewed once more.
  void keep(int potential, StencilData& internal) const;
  // "the constraint of joined_points in stencil 3 (vertices 4, 5) is off by 0.0021 m, above its tolerance of 0.001 m".
  std::string describe(System& system, const Violation& violation) const;

 private:
  struct Kept {
    Constraint constraint;
    StencilData lags;          // shift and hardening, of every stencil
    std::vector<double> size;  // |c| of every stencil after the last solve; empty in a step's first
  };
  std::vector<Kept> all_;
};

}  // namespace ergon
