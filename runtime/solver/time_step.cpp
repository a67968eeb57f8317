#include "runtime/solver/time_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "runtime/error.h"
#include "runtime/solver/stopwatch.h"

namespace ergon {

namespace {

bool has_lag(const ErgonKernel& kernel, std::string_view name) {
  return std::any_of(kernel.inputs, kernel.inputs + kernel.n_inputs,
                     [name](const ErgonInput& input) { return input.role == ERGON_LAG && name == input.name; });
}

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

// The lag of each point whose name is the point's with this ending.
void set_vector_lags(Potential& potential, const std::string& ending, const Eigen::Matrix3Xd& field) {
  for (int point = 0; point < potential.points_per_stencil(); ++point) {
    const std::string lag = potential.kernel().point_names[point] + ending;
    if (has_lag(potential.kernel(), lag)) potential.set_lag(lag, gather(potential, point, field));
  }
}

void add(NewtonSeconds& sum, const NewtonSeconds& part) {
  sum.evaluate += part.evaluate;
  sum.factor += part.factor;
  sum.solve += part.solve;
  sum.line_search += part.line_search;
  sum.contact += part.contact;
}

}  // namespace

TimeStepper::TimeStepper(System& system, Eigen::VectorXd mass, Contact* contact, StepOptions options, Script script)
    : system_(&system), mass_(std::move(mass)), contact_(contact), options_(options), script_(std::move(script)) {
  resisting_mass_ = system.carriers().resisting_mass(mass_);
  const auto positive = [](const char* name, double value, const char* unit) {
    if (!(value > 0) || !std::isfinite(value)) {
      throw InputError(fmt::format("{} is {:g} {}; it must be above 0", name, value, unit));
    }
  };
  positive("dt", options_.dt, "s");
  positive("tolerance", options_.tolerance, "m/s");
  if (options_.max_iterations < 1) throw InputError("max_iterations must be at least 1");
  if (options_.friction_lag_iterations < 1) throw InputError("friction_lag_iterations must be at least 1");
}

StepRecord TimeStepper::step(State& state) {
  StepRecord record;
  Eigen::Matrix3Xd x = state.x;
  NewtonResult result;
  {
    const Stopwatch watch(record.seconds.total);
    record.dt = options_.dt;

    const Eigen::Matrix3Xd xhat = predict(state);
    set_lags(state.x, xhat);
    if (contact_) begin_contact(state, record);
    result = solve(state, x, record);
    record.accepted = result.converged || (options_.accept_unconverged && result.iterations > 0);
    if (record.accepted) advance(state, x);
  }
  report(state, result, record);
  return record;
}

// Where the vertices go without forces.
Eigen::Matrix3Xd TimeStepper::predict(const State& state) const {
  Eigen::Matrix3Xd xhat = state.x + options_.dt * state.v;
  for (int v = 0; v < system_->vertices(); ++v) {
    if (!system_->moves(v)) xhat.col(v) = state.x.col(v);
  }
  return xhat;
}

void TimeStepper::set_lags(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& xhat) {
  lagged_dt_.resize(static_cast<size_t>(system_->potential_count()), 0);
  for (int i = 0; i < system_->potential_count(); ++i) {
    Potential& potential = system_->potential(i);
    if (contact_ && contact_->owns(i)) continue;
    double& lagged_dt = lagged_dt_[static_cast<size_t>(i)];
    if (lagged_dt != options_.dt && has_lag(potential.kernel(), "dt")) potential.set_lag("dt", {options_.dt});
    lagged_dt = options_.dt;
    if (potential.kernel().density || !potential.kernel().point_names) continue;
    set_vector_lags(potential, "hat", xhat);
    set_vector_lags(potential, "lag", x);
  }
}

void TimeStepper::begin_contact(const State& state, StepRecord& record) {
  const Stopwatch watch(record.seconds.contact);
  contact_->begin_step(state.x, state.v, options_.dt);
  contact_->lag_friction(state.x, state.x, options_.dt);
}

// Newton, repeated with new normal forces of friction until these have settled.
NewtonResult TimeStepper::solve(const State& state, Eigen::Matrix3Xd& x, StepRecord& record) {
  NewtonOptions newton;
  newton.dt = options_.dt;
  newton.tolerance = options_.tolerance;
  newton.max_iterations = options_.max_iterations;
  newton.projection = options_.projection;
  newton.on_demand = options_.project_on_demand;
  newton.curvature = resisting_mass_ / (options_.dt * options_.dt);
  if (!script_.empty()) {
    goal_ = state.x;
    script_.place(state.time + options_.dt, goal_);
    newton.prescribed = {&script_.vertices(), &goal_};
  }
  const bool friction = contact_ && contact_->has_friction();

  NewtonResult result;
  while (true) {
    result = newton_.minimise(*system_, x, newton, contact_);
    ++record.friction_iterations;
    record.newton_iterations += result.iterations;
    record.follow_iterations += result.follow_iterations;
    record.factorisations += result.factorisations;
    record.halvings += result.halvings;
    record.shifts += result.shifts;
    record.indefinite += result.indefinite;
    add(record.seconds, result.seconds);
    if (options_.record_forces && contact_) record.forces = forces(x);
    if (!friction || !result.converged) break;

    const Stopwatch watch(record.seconds.contact);
    record.friction_change = contact_->lag_friction(x, state.x, options_.dt).fraction();
    if (record.friction_change <= options_.friction_tolerance) break;
    if (record.friction_iterations >= options_.friction_lag_iterations) break;
  }
  if (!friction) record.friction_iterations = 0;
  return result;
}

// Of contact on the vertices, before friction gets new normal forces: those that the solve balanced.
ContactForces TimeStepper::forces(const Eigen::Matrix3Xd& x) {
  std::vector<int> barriers, friction;
  for (int i = 0; i < system_->potential_count(); ++i) {
    if (contact_->owns(i)) (contact_->rubs(i) ? friction : barriers).push_back(i);
  }
  contact_->set_active(x);
  ContactForces forces;
  system_->gradient_of(barriers, x, forces.normal);
  system_->gradient_of(friction, x, forces.friction);
  forces.normal *= -1;
  forces.friction *= -1;
  return forces;
}

void TimeStepper::advance(State& state, const Eigen::Matrix3Xd& x) const {
  state.v = (x - state.x) / options_.dt;
  state.x = x;
  system_->carriers().place(state.x);  // free of the rounding that the iterations added up
  state.step += 1;
  state.time += options_.dt;
}

void TimeStepper::report(const State& state, const NewtonResult& result, StepRecord& record) {
  record.step = state.step;
  record.time = state.time;
  record.converged = result.converged;
  record.reason = result.reason;
  record.worst_vertex = result.worst_vertex;
  record.residual = result.residual;
  record.step_speed = result.step_speed;
  record.skipped = skipped_parts();
  record.energy = record.accepted ? energies_of(result.evaluation, state.v) : energies(state);
  if (contact_) {
    const ContactStatus status = contact_->status(state.x);
    record.contacts = status.active;
    record.smallest_gap = status.smallest_gap;
    record.barrier_stiffness = status.stiffness;
    record.energy_added = status.energy_added;
  }
}

Energies TimeStepper::energies(const State& state) {
  set_lags(state.x, predict(state));
  if (contact_) {
    contact_->begin_step(state.x, state.v, options_.dt);
    contact_->lag_friction(state.x, state.x, options_.dt);
    contact_->set_active(state.x);
  }
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
