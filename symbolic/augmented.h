#pragma once
// A constraint that is kept however soft its law is: the augmented Lagrangian of an energy that tells what it draws to
// 0 (`constraint c = ...`). Of value(c) it makes (1 + hardening)*value(c + shift), with two lags of each stencil or
// point of quadrature that the energy renews itself and that start at 0: `constraint_shift` (shape and unit of c),
// which becomes c + shift, and `constraint_hardening` (1), which stays as it is. For value = k/2*c^2 and hardening 0
// that is k/2*c^2 + lambda*c and a constant, with the multiplier lambda = k*shift, and the update lambda + k*c. Source:
// Nocedal, Wright 2006, Numerical Optimization, 2nd ed., section 17.3. The runtime that renews them is
// runtime/solver/constraints.h.

#include "symbolic/energy.h"

namespace ergon {

// Throws std::invalid_argument for an energy without a constraint, SourceError where it declares one of these names.
Energy augmented(const Energy& energy);

// The let of the constraint; it has the shape and unit of c. Null without one.
const Let* constraint_of(const Energy& energy);

}  // namespace ergon
