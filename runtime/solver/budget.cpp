// Where the energy of a step went. All forces at the end of the last solve, with the stage's accelerations, are
// multiplied by the displacements of the whole step. What is not the work of any of them - the change of kinetic energy
// less the work of mass*acceleration, and the change of stored energy less the work of its gradient - is the
// integrator's: of implicit Euler, mass/2*|change of v|^2 and what the stored energy is convex by. What then is left is
// the work of forces that Newton's method left unbalanced.

#include "runtime/solver/lags.h"
#include "runtime/solver/largest.h"
#include "runtime/solver/time_step.h"

namespace ergon {

// Before friction gets new normal forces.
void TimeStepper::take_balance(const Eigen::Matrix3Xd& x) {
  std::vector<int> stored, friction, damping;
  for (int i = 0; i < system_->potential_count(); ++i) {
    if (contact_ && contact_->owns(i))
      (contact_->rubs(i) ? friction : stored).push_back(i);
    else if (is_stored(i))
      stored.push_back(i);
    else if (!has_vector_lag(system_->potential(i), "hat"))
      damping.push_back(i);
  }
  if (contact_) contact_->set_active(x);
  const auto sum = [&](const std::vector<int>& potentials, Eigen::Matrix3Xd& gradient) {
    if (potentials.empty())
      gradient.setZero(3, x.cols());
    else
      system_->gradient_of(potentials, x, gradient);
  };
  sum(stored, balance_.stored);
  sum(friction, balance_.friction);
  sum(damping, balance_.damping);
  if (system_->damps()) system_->add_damping(system_->lagged_velocity(x), balance_.damping);
  system_->add_coupled_drag(x, balance_.damping);
}

// `state`: after the step; the state before is in it too.
Budget TimeStepper::budget_of(const State& state, const StepRecord& record, const Evaluation& evaluation) {
  Budget out;
  const Eigen::Matrix3Xd way = state.x - state.last_x;
  const bool inert = integrator_named(options_.integrator).has_inertia;
  const Eigen::Matrix3Xd gain = mass_times(state.v - state.last_v), push = mass_times(balance_.a);
  double stored_work = 0, inertia_work = 0, free_kinetic = 0, held_kinetic = 0;
  for (int v = 0; v < system_->vertices(); ++v) {
    const bool held = !system_->moves(v);
    if (!held && system_->block_of(v) < 0) continue;  // carried: counted where it is carried from
    const auto dx = way.col(v);
    const double stored = balance_.stored.col(v).dot(dx), friction = balance_.friction.col(v).dot(dx),
                 damping = balance_.damping.col(v).dot(dx);
    const double kinetic = inert ? gain.col(v).dot(state.v.col(v) + state.last_v.col(v)) / 2 : 0;
    stored_work += stored;
    out.friction += friction;
    out.damping += damping;
    (held ? held_kinetic : free_kinetic) += kinetic;
    if (held)
      out.script += stored + friction + damping + kinetic;
    else
      inertia_work += push.col(v).dot(dx);
  }
  double change = 0;  // of stored energy
  for (int i = 0; i < system_->potential_count(); ++i) {
    const auto at = static_cast<size_t>(i);
    if (is_stored(i)) change += evaluation.by_potential[at] - known_.energy[at];
  }
  if (!loads_.empty()) {
    const PotentialValues before = system_->value(state.last_x).by_potential;
    for (const Load& load : loads_) {
      const auto at = static_cast<size_t>(load.potential);
      out.loads += before[at] - known_.energy[at];
    }
  }
  out.barrier = record.energy_added;
  out.change = change + free_kinetic + held_kinetic;
  out.integrator = inertia_work - free_kinetic + stored_work - (change - out.barrier - out.loads);
  out.residual = out.change - (out.script + out.loads + out.barrier - out.friction - out.damping - out.integrator);
  return out;
}

// Of positions, by the change of accelerations: to leading order that of the motion's derivative of degree order + 1.
double TimeStepper::local_error(const State& state, const Integrator& integrator,
                                const std::vector<Moment>& moments) const {
  const double ratio = state.last_dt > 0 ? options_.dt / state.last_dt : 1;
  Eigen::Matrix3Xd change = moments.back().a;
  if (integrator.order > 1) change -= moments[1].a;
  return error_constant(integrator, ratio) * options_.dt * options_.dt * largest_motion(*system_, change).value;
}

}  // namespace ergon
