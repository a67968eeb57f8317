// Damping in proportion to stiffness: one matrix for each damped potential, assembled when it is lagged. Between two
// lags it is a quadratic form, of which value and gradient cost one product of the matrix with a vector.

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "runtime/error.h"
#include "runtime/system_data.h"

namespace ergon {

void System::damp(int potential, double time) {
  const Potential& damped = this->potential(potential);
  if (!(time > 0) || !std::isfinite(time))
    throw InputError(
        fmt::format("stiffness damping of {} is {:g} s; it must be above 0 and finite", damped.name(), time));
  if (damped.kernel().zero_hessian)
    throw InputError(fmt::format("{} has no stiffness that damping could be in proportion to", damped.name()));
  StiffnessDamping made{time, System(vertices()), {}};
  made.alone.set_carriers(carriers());
  made.alone.add(damped);
  for (int v = 0; v < vertices(); ++v)
    if (made.alone.block_of(v) >= 0) made.vertex_of.push_back(v);
  impl->damping.push_back(std::move(made));
}

bool System::damps() const { return !impl->damping.empty(); }

void System::lag_stiffness(const Eigen::Matrix3Xd& x) {
  Eigen::Matrix3Xd gradient;
  for (StiffnessDamping& damped : impl->damping) damped.alone.hessian(x, Projection::clamp, gradient, damped.stiffness);
}

void System::lag_motion(const Eigen::Matrix3Xd& from, double dt) {
  impl->damped_from = from;
  impl->damped_dt = dt;
}

void System::add_damping(const Eigen::Matrix3Xd& v, Eigen::Matrix3Xd& gradient) const {
  Eigen::VectorXd velocity, force;
  for (const StiffnessDamping& damped : impl->damping) {
    if (damped.stiffness.block_rows() == 0) continue;
    velocity.resize(damped.stiffness.rows());
    for (size_t k = 0; k < damped.vertex_of.size(); ++k)
      velocity.segment<3>(3 * static_cast<Eigen::Index>(k)) = v.col(damped.vertex_of[k]);
    damped.stiffness.multiply(velocity, force);
    for (size_t k = 0; k < damped.vertex_of.size(); ++k)
      gradient.col(damped.vertex_of[k]) += damped.time * force.segment<3>(3 * static_cast<Eigen::Index>(k));
  }
}

Eigen::Matrix3Xd System::lagged_velocity(const Eigen::Matrix3Xd& x) const {
  if (impl->damped_dt == 0) return Eigen::Matrix3Xd::Zero(3, vertices());
  return (x - impl->damped_from) / impl->damped_dt;
}

double System::damping(const Eigen::Matrix3Xd& x, Eigen::Matrix3Xd* gradient) const {
  if (!damps()) return 0;
  const Eigen::Matrix3Xd v = lagged_velocity(x);
  Eigen::Matrix3Xd force = Eigen::Matrix3Xd::Zero(3, vertices());
  add_damping(v, force);
  if (gradient != nullptr) *gradient += force;
  return impl->damped_dt / 2 * force.cwiseProduct(v).sum();
}

// Numbers of free vertices ascend in both matrices, so that blocks of a lower triangle are in one.
void StiffnessDamping::find(const System::Impl& whole) {
  if (placed_pattern == whole.pattern->id && placed_stiffness == stiffness.pattern_id()) return;
  placed_pattern = whole.pattern->id;
  placed_stiffness = stiffness.pattern_id();
  places.clear();
  for (int j = 0; j < stiffness.block_rows(); ++j) {
    const int column = whole.numbers.block_of[static_cast<size_t>(vertex_of[static_cast<size_t>(j)])];
    const int first = stiffness.column_start()[3 * static_cast<size_t>(j)], count = stiffness.column_stride(j) / 3;
    for (int k = 0; k < count; ++k) {
      const int i = stiffness.row_index()[static_cast<size_t>(first + 3 * k)] / 3;
      const int row = whole.numbers.block_of[static_cast<size_t>(vertex_of[static_cast<size_t>(i)])];
      if (row < 0 || column < 0) continue;
      const int index = whole.pattern->index_of(row, column);
      if (index < 0) throw std::logic_error("a damped potential couples vertices that the system does not");
      places.push_back({first + 3 * k, stiffness.column_stride(j), whole.pattern->start_of(index, column),
                        whole.pattern->column_stride(column)});
    }
  }
}

void System::Impl::damp_matrix(BlockMatrix& matrix) {
  if (damped_dt == 0) return;
  for (StiffnessDamping& damped : damping) {
    if (damped.stiffness.block_rows() == 0) continue;
    damped.find(*this);
    const double scale = damped.time / damped_dt;
    const double* from = damped.stiffness.values().data();
    double* to = matrix.values().data();
    for (const StiffnessDamping::Block& block : damped.places)
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
          to[block.to + c * block.to_stride + r] += scale * from[block.from + c * block.from_stride + r];
  }
}

}  // namespace ergon
