#pragma once
// Small vibrations about an equilibrium.

#include <vector>

#include "tools/verify/model.h"

namespace ergon {

// The lowest angular frequencies, rad/s, ascending: K u = omega^2 M u with the tangent at model.x and a mass matrix,
// kg, over vertices. Subspace iteration: Bathe 1996, Finite Element Procedures. Throws std::runtime_error where the
// tangent is not positive definite.
std::vector<double> lowest_frequencies(Model& model, const CoupledMass::Matrix& mass, int count);

}  // namespace ergon
