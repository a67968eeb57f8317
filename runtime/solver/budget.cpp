// Where the energy of a step went. The forces that each stage balances, with its accelerations, are multiplied by the
// part of the step's displacement that is made with the stage's velocity: of methods of one stage, all of it. What is
// not the work of any of them - the change of kinetic energy less the work of mass*acceleration, and the change of
// stored energy less the work of its gradient - is the integrator's: of implicit Euler, mass/2*|change of v|^2 and what
// the stored energy is convex by. What then is left is the work of forces that Newton's method left unbalanced.

#include <algorithm>

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

// What was balanced when the last step ended. Where none did, only accelerations are known.
TimeStepper::Balance TimeStepper::starting_balance(const Moment& start) const {
  if (known_.balance.stored.cols() > 0) return known_.balance;
  const Eigen::Matrix3Xd none = Eigen::Matrix3Xd::Zero(3, system_->vertices());
  if (start.a.cols() == 0) return {none, none, none, none, none};
  return {-mass_times(start.a), none, none, start.a, none};
}

void TimeStepper::take_ways(const State& state, const Integrator& integrator, const std::vector<Moment>& moments) {
  const Eigen::Matrix3Xd whole = moments.back().x - state.x;
  const std::vector<double> weights = slope_weights(integrator);
  if (weights.empty()) {
    balances_.assign(1, balance_);
    balances_[0].way = whole;
  }
  for (size_t k = 0; k + 1 < weights.size(); ++k) {
    balances_[k].way = weights[k + 1] * options_.dt * moments[k + 1].v;
    for (int v = 0; v < system_->vertices(); ++v)
      if (!system_->moves(v)) balances_[k].way.col(v) = weights[k + 1] * whole.col(v);
  }
}

// What stored energy gains while nothing moves, J: the step goes along the ways of its balances, each with what
// potentials had at the balance's time, and between two of them time alone goes on. Of second order where a method has
// one balance, neither at the start nor amid the step, is to let time go on amid the way. `state`: after the step.
double TimeStepper::work_of_time(const State& state, int order) {
  std::vector<size_t> changing;
  for (int i = 0; i < system_->potential_count(); ++i) {
    const bool grows = std::any_of(loads_.begin(), loads_.end(), [&](const Load& load) { return load.potential == i; });
    if (is_stored(i) && (grows || system_->potential(i).follows_time())) changing.push_back(static_cast<size_t>(i));
  }
  if (changing.empty()) return 0;
  double now = state.time - options_.dt, work = 0;
  Eigen::Matrix3Xd x = state.last_x;
  const auto stored = [&](double time) {
    set_time(time);
    const PotentialValues values = system_->value(x).by_potential;
    double sum = 0;
    for (const size_t i : changing) sum += values[i];
    return sum;
  };
  const auto go_on = [&](double time) {
    if (time == now) return;
    work += stored(time) - stored(now);
    now = time;
  };
  const double amid = state.time - options_.dt / 2;
  if (order > 1 && balances_.size() == 1 && std::abs(balances_[0].time - amid) > 1e-9 * options_.dt) {
    x += balances_[0].way / 2;
  } else {
    for (const Balance& part : balances_) {
      go_on(part.time);
      x += part.way;
    }
  }
  go_on(state.time);
  set_time(state.time);
  return work;
}

// `state`: after the step; the state before is in it too.
Budget TimeStepper::budget_of(const State& state, const StepRecord& record, const Evaluation& evaluation) {
  Budget out;
  const bool inert = integrator_named(options_.integrator).has_inertia;
  const Eigen::Matrix3Xd gain = mass_times(state.v - state.last_v);
  std::vector<Eigen::Matrix3Xd> pushes;
  for (const Balance& part : balances_) pushes.push_back(mass_times(part.a));
  double stored_work = 0, inertia_work = 0, free_kinetic = 0, held_kinetic = 0;
  for (int v = 0; v < system_->vertices(); ++v) {
    const bool held = !system_->moves(v);
    if (!held && system_->block_of(v) < 0) continue;  // carried: counted where it is carried from
    double stored = 0, friction = 0, damping = 0, inertia = 0;
    for (size_t k = 0; k < balances_.size(); ++k) {
      const Balance& part = balances_[k];
      const auto dx = part.way.col(v);
      stored += part.stored.col(v).dot(dx);
      friction += part.friction.col(v).dot(dx);
      damping += part.damping.col(v).dot(dx);
      inertia += pushes[k].col(v).dot(dx);
    }
    const double kinetic = inert ? gain.col(v).dot(state.v.col(v) + state.last_v.col(v)) / 2 : 0;
    stored_work += stored;
    out.friction += friction;
    out.damping += damping;
    (held ? held_kinetic : free_kinetic) += kinetic;
    if (held)
      out.script += stored + friction + damping + kinetic;
    else
      inertia_work += inertia;
  }
  double change = 0;  // of stored energy
  for (int i = 0; i < system_->potential_count(); ++i) {
    const auto at = static_cast<size_t>(i);
    if (is_stored(i)) change += evaluation.by_potential[at] - known_.energy[at];
  }
  out.loads = work_of_time(state, integrator_named(record.integrator).order);
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
