// What a step tells of itself, and the energies of states.

#include <algorithm>

#include "runtime/solver/lags.h"
#include "runtime/solver/time_step.h"

namespace ergon {

void TimeStepper::report(const State& state, const NewtonResult& result, StepRecord& record) {
  record.step = state.step;
  record.time = state.time;
  record.converged = result.converged;
  record.reason = result.reason;
  record.worst_vertex = result.worst_vertex;
  record.residual = result.residual;
  record.step_speed = result.step_speed;
  record.skipped = skipped_parts();
  record.load_factor = load_factor(state.time);
  record.energy = record.accepted ? energies_of(result.evaluation, state.v) : energies(state);
  if (contact_) {
    const ContactStatus status = contact_->status(state.x);
    record.contacts = status.active;
    record.smallest_gap = status.smallest_gap;
    record.barrier_stiffness = status.stiffness;
    record.energy_added = status.energy_added;
  }
}

// Lags and contact of a state that nothing was stepped to.
void TimeStepper::prepare_at(const State& state) {
  set_lags({state.x, options_.dt, state.x, options_.dt, state.time});
  if (!contact_) return;
  contact_->begin_step(state.x, state.v, options_.dt);
  contact_->lag_friction(state.x, state.x, options_.dt);
  contact_->set_active(state.x);
}

Energies TimeStepper::energies(const State& state) {
  prepare_at(state);
  return energies_of(system_->value(state.x), state.v);
}

Energies TimeStepper::energies_of(const Evaluation& evaluation, const Eigen::Matrix3Xd& v) const {
  Energies energies;
  for (int i = 0; i < system_->potential_count(); ++i) {
    const Potential& potential = system_->potential(i);
    if (has_lag(potential.kernel(), "dt")) continue;
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
  if (!integrator_named(options_.integrator).has_inertia) return energies;
  for (int i = 0; i < mass_.size(); ++i) energies.kinetic += mass_[i] / 2 * v.col(i).squaredNorm();
  energies.total += energies.kinetic;
  return energies;
}

std::vector<std::string> TimeStepper::skipped_parts() const {
  std::vector<std::string> skipped = system_->skipped();
  const std::vector<std::string> more =
      contact_ ? contact_->skipped() : std::vector<std::string>{"contact: nothing in the scene may touch"};
  skipped.insert(skipped.end(), more.begin(), more.end());
  return skipped;
}

}  // namespace ergon
