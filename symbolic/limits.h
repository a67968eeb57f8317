#pragma once
// How value and derivatives behave as a state is approached: evaluated in 90 digits at 1e-12 and 1e-26 to both sides of
// it, in several directions. What keeps growing, or keeps a difference between the sides, does so in the limit as far
// as these two distances tell.

#include <vector>

#include "symbolic/critical_states.h"

namespace ergon {

// In the order of their weight.
enum class Effect {
  none,
  curvature_jumps,
  curvature_grows,
  gradient_jumps,
  gradient_grows,
  value_jumps,
  value_grows,
  undefined
};

struct Limit {
  Effect effect = Effect::none;
  size_t component = 0;         // of the gradient; of the packed lower triangle of the Hessian
  double below = 0, above = 0;  // on the two sides of a jump; of what grows, at 1e-12 and 1e-26
  ExactInputs nearby;           // the state on the worse side, at 1e-12
};

// The worst of what happens at a state when dofs (or, where `dofs` is false, the other symbols within their ranges)
// vary about it. Sides where a condition does not hold are left out.
Limit limit_at(const Energy& energy, const std::string& case_name, const ExactInputs& state, bool dofs);

// What does not tend to zero as the margin of a condition tends to zero at `state` from its positive side; of a margin
// of `require`: whether the value falls without bound there (value_grows, with `below` the value at 1e-26).
Limit limit_at_boundary(const Energy& energy, const std::string& case_name, const ExactInputs& state,
                        const CriticalTarget& boundary);

}  // namespace ergon
