#pragma once
// Small vibrations about an equilibrium.

#include <vector>

#include "tools/verify/model.h"

namespace ergon {

// The lowest angular frequencies, rad/s, ascending: K u = omega^2 M u with the tangent at model.x and lumped masses, kg
// per vertex. Subspace iteration: Bathe 1996, Finite Element Procedures. Throws std::runtime_error where
// the tangent is not positive definite.
std::vector<double> lowest_frequencies(Model& model, const Eigen::VectorXd& mass, int count);

}  // namespace ergon
