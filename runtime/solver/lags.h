#pragma once
// The lags that a time step sets, found by their names in kernels: see time_step.h.

#include <Eigen/Core>
#include <string>
#include <string_view>

#include "runtime/potential.h"

namespace ergon {

bool has_lag(const ErgonKernel& kernel, std::string_view name);

// Whether some point of its stencils has a lag of that point's name with this ending.
bool has_vector_lag(const Potential& potential, const std::string& ending);

// Gives each of these its point's column of the field.
void set_vector_lags(Potential& potential, const std::string& ending, const Eigen::Matrix3Xd& field);

}  // namespace ergon
