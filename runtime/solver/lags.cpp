#include "runtime/solver/lags.h"

#include <algorithm>
#include <vector>

namespace ergon {

namespace {

// The columns of one point of every stencil, one after the other.
std::vector<double> gather(const Potential& potential, int point, const Eigen::Matrix3Xd& field) {
  const auto points = static_cast<size_t>(potential.points_per_stencil());
  std::vector<double> values;
  values.reserve(3 * static_cast<size_t>(potential.stencil_count()));
  for (size_t i = static_cast<size_t>(point); i < potential.stencils().size(); i += points) {
    const auto column = field.col(potential.stencils()[i]);
    values.insert(values.end(), column.begin(), column.end());
  }
  return values;
}

}  // namespace

bool has_lag(const ErgonKernel& kernel, std::string_view name) {
  return std::any_of(kernel.inputs, kernel.inputs + kernel.n_inputs,
                     [name](const ErgonInput& input) { return input.role == ERGON_LAG && name == input.name; });
}

bool has_vector_lag(const Potential& potential, const std::string& ending) {
  if (potential.kernel().density || !potential.kernel().point_names) return false;
  for (int point = 0; point < potential.points_per_stencil(); ++point) {
    if (has_lag(potential.kernel(), potential.kernel().point_names[point] + ending)) return true;
  }
  return false;
}

void set_vector_lags(Potential& potential, const std::string& ending, const Eigen::Matrix3Xd& field) {
  for (int point = 0; point < potential.points_per_stencil(); ++point) {
    const std::string lag = potential.kernel().point_names[point] + ending;
    if (has_lag(potential.kernel(), lag)) potential.set_lag(lag, gather(potential, point, field));
  }
}

}  // namespace ergon
