// What a step tells of itself, and the energies of states.

#include <Eigen/Geometry>
#include <algorithm>

#include "runtime/solver/lags.h"
#include "runtime/solver/time_step.h"

namespace ergon {

namespace {

// The energy at the end of a step, with what energies renewed then.
Evaluation evaluate_renewed(System& system, const State& state, const Evaluation& before) {
  bool renewed = false;
  for (size_t i = 0; i < state.internal.size(); ++i) {
    for (const auto& [lag, values] : state.internal[i]) {
      system.potential(static_cast<int>(i)).set_lag(lag, values);
      renewed = true;
    }
  }
  return renewed ? system.value(state.x) : before;
}

}  // namespace

void TimeStepper::report(State& state, const NewtonResult& result, StepRecord& record) {
  record.step = state.step;
  record.time = state.time;
  record.converged = result.converged;
  record.reason = result.reason;
  record.worst_vertex = result.worst_vertex;
  record.residual = result.residual;
  record.step_speed = result.step_speed;
  record.skipped = skipped_parts();
  record.load_factor = load_factor(state.time);
  // What energies renewed changes what is stored: the difference is dissipated, as by plastic flow.
  const Evaluation after = record.accepted ? evaluate_renewed(*system_, state, result.evaluation) : Evaluation{};
  record.energy = record.accepted ? energies_of(after, state.v) : energies(state);
  if (contact_) {
    const ContactStatus status = contact_->status(state.x);
    record.contacts = status.active;
    record.smallest_gap = status.smallest_gap;
    record.barrier_stiffness = status.stiffness;
  }
  if (!record.accepted) return;
  record.budget = budget_of(state, record, after);
  for (int i = 0; i < system_->potential_count(); ++i) {
    const auto at = static_cast<size_t>(i);
    const double flow = is_stored(i) ? result.evaluation.by_potential[at] - after.by_potential[at] : 0;
    record.budget.damping += flow;
    record.budget.integrator -= flow;
  }
  state.dissipated += record.budget.integrator;
  known_ = {state.x, after.by_potential, balance_};
  const Eigen::Matrix3Xd momenta = mass_times(state.v);
  for (int v = 0; v < (options_.points < 0 ? system_->vertices() : options_.points); ++v) {
    const Eigen::Vector3d p = momenta.col(v), x = state.x.col(v);
    record.momentum.linear += p;
    record.momentum.angular += x.cross(p);
  }
}

bool TimeStepper::is_stored(int potential) const { return !has_lag(system_->potential(potential).kernel(), "dt"); }

double TimeStepper::kinetic_energy(const Eigen::Matrix3Xd& v) const {
  if (!integrator_named(options_.integrator).has_inertia) return 0;
  return mass_times(v).cwiseProduct(v).sum() / 2;
}

// Lags and contact of a state that nothing was stepped to.
void TimeStepper::prepare_at(const State& state) {
  set_internal(state);
  set_lags({state.x, options_.dt, state.x, options_.dt, state.time, options_.dt});
  if (!contact_) return;
  contact_->begin_step(state.x, state.v, options_.dt);
  contact_->lag_friction(state.x, state.x, options_.dt);
  contact_->set_active(state.x);
}

// What the next step finds known of the state at its start is set here too.
Energies TimeStepper::energies(const State& state) {
  prepare_at(state);
  const Evaluation evaluation = system_->value(state.x);
  known_ = {state.x, evaluation.by_potential};
  return energies_of(evaluation, state.v);
}

Energies TimeStepper::energies_of(const Evaluation& evaluation, const Eigen::Matrix3Xd& v) const {
  Energies energies;
  for (int i = 0; i < system_->potential_count(); ++i) {
    const Potential& potential = system_->potential(i);
    if (!is_stored(i)) continue;
    const double value = evaluation.by_potential[static_cast<size_t>(i)];
    energies.total += value;
    const auto same = std::find_if(energies.stored.begin(), energies.stored.end(),
                                   [&](const auto& entry) { return entry.first == potential.name(); });
    if (same != energies.stored.end()) {
      same->second += value;
    } else {
      energies.stored.emplace_back(potential.name(), value);
    }
  }
  energies.kinetic = kinetic_energy(v);
  energies.total += energies.kinetic;
  return energies;
}

std::vector<std::string> TimeStepper::skipped_parts() const {
  std::vector<std::string> skipped = system_->skipped();
  const std::vector<std::string> more =
      contact_ ? contact_->skipped() : std::vector<std::string>{"contact: nothing in the scene may touch"};
  skipped.insert(skipped.end(), more.begin(), more.end());
  if (system_->damps() && !integrator_named(options_.integrator).has_inertia)
    skipped.emplace_back("stiffness damping: steps without inertia have none");
  return skipped;
}

}  // namespace ergon
