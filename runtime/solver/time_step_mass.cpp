// What a step makes of masses, lumped and coupled.

#include <cmath>
#include <stdexcept>

#include "runtime/solver/time_step.h"

namespace ergon {
namespace {

constexpr double solved = 1e-14;  // of the forces, in the norm of the diagonal
constexpr int most_products = 1000;

}  // namespace

// kg m/s of velocities, N of accelerations; of a vertex, all that it has a share of.
Eigen::Matrix3Xd TimeStepper::mass_times(const Eigen::Matrix3Xd& field) const {
  if (field.cols() == 0) return Eigen::Matrix3Xd::Zero(3, lumped_mass_.size());
  Eigen::Matrix3Xd out = field * lumped_mass_.asDiagonal();
  add_product(system_->coupled_mass().mass, field, 1, out);
  return out;
}

// Forces on vertices with degrees of freedom of their own become accelerations, the others being at rest: conjugate
// gradients where mass is coupled, with its diagonal, by which mass matrices are well-conditioned on any mesh.
void TimeStepper::divide_by_mass(Eigen::Matrix3Xd& forces) const {
  for (int v = 0; v < system_->vertices(); ++v) {
    if (system_->block_of(v) < 0)
      forces.col(v).setZero();
    else if (!system_->coupled_mass().couples(v))
      forces.col(v) /= lumped_mass_[v];
  }
  const CoupledMass& coupled = system_->coupled_mass();
  if (coupled.empty()) return;
  const auto ours = [&](int v) { return system_->block_of(v) >= 0 && coupled.couples(v); };
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(system_->vertices());
  Eigen::Matrix3Xd residual = Eigen::Matrix3Xd::Zero(3, system_->vertices()), found = residual;
  for (int v = 0; v < system_->vertices(); ++v) {
    if (!ours(v)) continue;
    inverse[v] = 1 / coupled.mass.coeff(v, v);
    residual.col(v) = forces.col(v);
  }
  Eigen::Matrix3Xd way = residual * inverse.asDiagonal(), product;
  double size = residual.cwiseProduct(way).sum();
  const double enough = solved * solved * size;
  for (int k = 0; size > enough; ++k) {
    if (k == most_products) throw std::logic_error("conjugate gradients do not solve for accelerations");
    product.setZero(3, way.cols());
    add_product(coupled.mass, way, 1, product);
    for (int v = 0; v < system_->vertices(); ++v)
      if (!ours(v)) product.col(v).setZero();
    system_->guide(product);
    const double step = size / way.cwiseProduct(product).sum();
    found += step * way;
    residual -= step * product;
    const Eigen::Matrix3Xd scaled = residual * inverse.asDiagonal();
    const double next = residual.cwiseProduct(scaled).sum();
    way = scaled + next / size * way;
    size = next;
  }
  for (int v = 0; v < system_->vertices(); ++v)
    if (ours(v)) forces.col(v) = found.col(v);
}

// The change of the mean velocity from the last step to this one, over the step, so that a motion gives in all the
// impulse that its velocities call for.
Eigen::Matrix3Xd TimeStepper::scripted_acceleration(const State& state) const {
  Eigen::Matrix3Xd out = Eigen::Matrix3Xd::Zero(3, system_->vertices());
  if (script_.empty()) return out;
  Eigen::Matrix3Xd goal = state.x;
  script_.place(state.time + options_.dt, goal);
  for (const int v : script_.vertices())
    out.col(v) = ((goal.col(v) - state.x.col(v)) / options_.dt - state.v.col(v)) / options_.dt;
  return out;
}

}  // namespace ergon
