#include "runtime/solver/time_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/error.h"
#include "runtime/solver/lags.h"
#include "runtime/solver/step_cost.h"
#include "runtime/solver/stopwatch.h"

namespace ergon {

namespace {

constexpr double created_part = 0.01;             // of the kinetic energy: what a watched step may create
constexpr const char* damped = "implicit_euler";  // of all integrators, creates the least

}  // namespace

TimeStepper::TimeStepper(System& system, Eigen::VectorXd mass, Contact* contact, StepOptions options, Script script)
    : system_(&system), mass_(std::move(mass)), contact_(contact), options_(options), script_(std::move(script)) {
  resisting_mass_ = system.carriers().resisting_mass(mass_);
  lumped_mass_ = mass_;
  const CoupledMass& coupled = system.coupled_mass();
  for (int v = 0; v < system.vertices(); ++v) {
    if (!coupled.couples(v)) continue;
    resisting_mass_[v] = coupled.bound[v];
    lumped_mass_[v] = 0;
  }
  const auto positive = [](const char* name, double value, const char* unit) {
    if (!(value > 0) || !std::isfinite(value)) {
      throw InputError(fmt::format("{} is {:g} {}; it must be above 0", name, value, unit));
    }
  };
  positive("dt", options_.dt, "s");
  positive("tolerance", options_.tolerance, "m/s");
  integrator_named(options_.integrator);  // throws
  if (options_.max_iterations < 1) throw InputError("max_iterations must be at least 1");
  if (options_.constraint_iterations < 1) throw InputError("constraint_iterations must be at least 1");
  if (options_.friction_lag_iterations < 1) throw InputError("friction_lag_iterations must be at least 1");
}

StepRecord TimeStepper::step(State& state) {
  const bool watched = options_.creates_no_energy && integrator_named(options_.integrator).has_inertia;
  if (!watched) return step_by(integrator_for(state), state);
  const State before = state;
  StepRecord record = step_by(integrator_for(state), state);
  if (record.accepted && record.integrator != damped && creates_energy(state, record)) {
    const StepRecord refused = std::move(record);
    state = before;
    // By barriers that the refused step made stiffer.
    const double added = energies(state).total - (refused.energy.total - refused.budget.change);
    record = step_by(damped, state);
    record.error = refused.error;
    record.energy_added += added;
    record.budget.barrier += added;
    record.budget.change += added;
    add_refused(refused, record);
  }
  return record;
}

StepRecord TimeStepper::step_by(const std::string& name, State& state) {
  StepRecord record;
  NewtonResult result;
  {
    const Stopwatch watch(record.seconds.total);
    record.dt = options_.dt;
    record.integrator = name;

    set_internal(state);
    scripted_a_ = scripted_acceleration(state);
    const Integrator integrator = integrator_named(name, state.last_dt > 0 ? options_.dt / state.last_dt : 1);
    if (integrator.has_inertia && system_->damps()) lag_stiffness(state);
    if (known_.x.cols() == 0 || known_.x != state.x) energies(state);
    std::vector<Moment> moments = known_moments(state, integrator);
    balances_.assign(1, starting_balance(moments.back()));
    balances_.back().time = state.time;
    const bool was_stable = integrator.has_inertia || is_stable(state);
    for (const Stage& stage : integrator.stages) {
      Eigen::Matrix3Xd x = moments.back().x;
      result = solve_stage(stage_of(state, stage, moments), state.v, x, record);
      if (!integrator.has_inertia) judge_path(state, x, was_stable, result);
      record.accepted = result.converged || (options_.accept_unconverged && result.iterations > 0);
      if (!record.accepted) break;
      moments.push_back(moment_of(state, stage, moments, x));
      balance_.a = moments.back().a;
      balance_.time = state.time + stage.time * options_.dt;
      balances_.push_back(balance_);
    }
    record.accepted = record.accepted && finish(integrator, state.time + options_.dt, moments, result);
    if (record.accepted && options_.estimate_error) record.error = local_error(state, integrator, moments);
    if (record.accepted) {
      take_ways(state, integrator, moments);
      advance(state, moments.back());
    }
  }
  report(state, result, record);
  return record;
}

// A two-step method knows no last step at the first, and none that was made before a jump of the state. Where the
// incremental potential is not convex at the start, as of a body that is pressed flat, dt does not resolve what comes
// next, and implicit Euler goes down in energy all the same.
std::string TimeStepper::integrator_for(const State& state) {
  if (state.last_dt > 0 || !integrator_named(options_.integrator).two_step) return options_.integrator;
  prepare_at(state);
  return newton_.is_minimum(*system_, state.x) ? "sdirk2" : damped;
}

// More than what a motion at the solver's tolerance has: in sum since the start, and in one step beside what moves. A
// linear motion that dt resolves has no step in which bdf2 makes energy; after a collision that it does not resolve,
// bdf2 would go on with velocities that the collision has ended.
bool TimeStepper::creates_energy(const State& after, const StepRecord& record) const {
  const double slack = mass_.sum() * options_.tolerance * options_.tolerance / 2;
  const double moving = std::max(kinetic_energy(after.last_v), record.energy.kinetic);
  return after.dissipated < -slack || record.budget.integrator < -slack - created_part * moving;
}

std::vector<Moment> TimeStepper::known_moments(const State& state, const Integrator& integrator) {
  std::vector<Moment> moments(2);
  if (integrator.two_step) moments[0] = {state.last_x, state.last_v, {}};
  moments[1] = {state.x, state.v, state.a};
  const bool needed = integrator.needs_acceleration || options_.estimate_error;
  if (needed && state.a.cols() == 0) moments[1].a = free_acceleration(state);
  return moments;
}

// What the forces at the start give the vertices.
Eigen::Matrix3Xd TimeStepper::free_acceleration(const State& state) {
  prepare_at(state);
  std::vector<int> stored;
  for (int i = 0; i < system_->potential_count(); ++i) {
    if (is_stored(i)) stored.push_back(i);
  }
  Eigen::Matrix3Xd gradient;
  system_->gradient_of(stored, state.x, gradient);
  if (system_->damps()) system_->add_damping(state.v, gradient);
  system_->guide(gradient);
  gradient *= -1;
  divide_by_mass(gradient);
  system_->carriers().place(gradient);
  return gradient;
}

TimeStepper::Solve TimeStepper::stage_of(const State& state, const Stage& stage,
                                         const std::vector<Moment>& moments) const {
  Solve out;
  const double dt = options_.dt;
  out.dt = std::sqrt(stage.inertia) * dt;
  out.lag_dt = stage.inertia / stage.rate * dt;
  out.end = state.time + stage.time * dt;
  out.since = stage.time * dt;
  out.xhat = position(stage.xhat, moments, dt);
  out.xlag = position(xlag_of(stage), moments, dt);
  Eigen::Matrix3Xd goal = state.x;
  script_.place(out.end, goal);
  const double part = out.lag_dt / (stage.time * dt);
  for (int v = 0; v < system_->vertices(); ++v) {
    if (system_->moves(v)) continue;
    out.xhat.col(v) = goal.col(v) - out.dt * out.dt * scripted_a_.col(v);
    out.xlag.col(v) = goal.col(v) - part * (goal.col(v) - state.x.col(v));
  }
  return out;
}

// The end of a stage that was solved. Scripted vertices have the mean velocity since the start of the step.
Moment TimeStepper::moment_of(const State& state, const Stage& stage, const std::vector<Moment>& moments,
                              const Eigen::Matrix3Xd& x) const {
  const double dt = options_.dt;
  const bool inert = integrator_named(options_.integrator).has_inertia;
  Moment out;
  out.x = x;
  out.a = (x - position(stage.xhat, moments, dt)) / (stage.inertia * dt * dt);
  out.v = (x - position(xlag_of(stage), moments, dt)) / (stage.inertia / stage.rate * dt);
  for (int v = 0; v < system_->vertices(); ++v) {
    if (!inert) out.a.col(v).setZero();
    if (system_->moves(v)) continue;
    out.v.col(v) = (x.col(v) - state.x.col(v)) / (stage.time * dt);
    if (inert) out.a.col(v) = scripted_a_.col(v);
  }
  return out;
}

NewtonResult TimeStepper::solve_stage(const Solve& stage, const Eigen::Matrix3Xd& v, Eigen::Matrix3Xd& x,
                                      StepRecord& record) {
  set_lags(stage);
  if (contact_) begin_contact(stage, x, v, record);
  const NewtonResult result = solve(stage, x, record);
  if (contact_) record.energy_added += contact_->status(x).energy_added;
  return result;
}

// The last combination of an integrator that has one, if contact and the potentials' domains let it be.
bool TimeStepper::finish(const Integrator& integrator, double end_time, std::vector<Moment>& moments,
                         NewtonResult& result) {
  if (integrator.end_x.empty()) return true;
  const double dt = options_.dt;
  Moment end{position(integrator.end_x, moments, dt), velocity(integrator.end_v, moments, dt),
             acceleration(integrator.end_a, moments)};
  for (int v = 0; v < system_->vertices(); ++v) {
    if (!system_->moves(v)) end.v.col(v) = (end.x.col(v) - moments[1].x.col(v)) / dt;
  }
  const Eigen::Matrix3Xd way = end.x - moments.back().x;
  const bool blocked = contact_ && contact_->largest_step(moments.back().x, way) < 1;
  if (contact_) contact_->set_active(blocked ? moments.back().x : end.x);
  set_time(end_time);
  if (!blocked) result.evaluation = system_->value(end.x);
  const Violation worst = constraints_.violation(*system_, end.x);
  if (blocked || !(result.evaluation.require > 0) || worst.excess > 1) {
    result.converged = false;
    result.reason = fmt::format(
        "the integrator {} ends its step beyond its last stage, where {}; take one that does not, as sdirk2 or bdf2",
        options_.integrator,
        blocked            ? "surfaces collide"
        : worst.excess > 1 ? constraints_.describe(*system_, worst)
                           : "the state is outside the domain of an energy");
    return false;
  }
  moments.push_back(std::move(end));
  return true;
}

// Each stage begins with what was kept at the start of the step.
bool TimeStepper::renews(const Potential& potential) { return potential.kernel().n_updates > 0; }

void TimeStepper::lag_dt(int i, double dt) {
  Potential& potential = system_->potential(i);
  double& lagged = lagged_dt_[static_cast<size_t>(i)];
  if (lagged != dt && has_lag(potential.kernel(), "dt")) potential.set_lag("dt", {dt});
  lagged = dt;
}

// Of what potentials follow.
void TimeStepper::set_time(double time) {
  if (load_end_ > 0) set_loads(load_factor(time));
  for (int i = 0; i < system_->potential_count(); ++i) system_->potential(i).set_time(time);
}

void TimeStepper::set_lags(const Solve& stage) {
  set_time(stage.end);
  lagged_dt_.resize(static_cast<size_t>(system_->potential_count()), 0);
  for (int i = 0; i < system_->potential_count(); ++i) {
    Potential& potential = system_->potential(i);
    if (contact_ && contact_->owns(i)) continue;
    lag_dt(i, has_vector_lag(potential, "hat") ? stage.dt : renews(potential) ? stage.since : stage.lag_dt);
    if (potential.kernel().density && has_lag(potential.kernel(), "Flag"))
      potential.set_lag("Flag", potential.deformation(stage.xlag));
    if (potential.kernel().density || !potential.kernel().point_names) continue;
    set_vector_lags(potential, "hat", stage.xhat);
    set_vector_lags(potential, "lag", stage.xlag);
  }
  if (system_->damps() && integrator_named(options_.integrator).has_inertia)
    system_->lag_motion(stage.xlag, stage.lag_dt);
  system_->lag_coupled_mass(stage.xhat, stage.dt, stage.xlag, stage.lag_dt);
}

// With what the step starts from as lags.
void TimeStepper::lag_stiffness(const State& state) {
  set_lags({state.x, options_.dt, state.x, options_.dt, state.time, options_.dt});
  system_->lag_stiffness(state.x);
}

void TimeStepper::set_internal(const State& state) {
  for (int i = 0; i < system_->potential_count(); ++i) {
    Potential& potential = system_->potential(i);
    const ErgonKernel& kernel = potential.kernel();
    for (int u = 0; u < kernel.n_updates; ++u) {
      const ErgonInput& lag = kernel.inputs[kernel.updates[u]];
      if (state.internal.empty())
        potential.set_lag(lag.name, std::vector<double>(static_cast<size_t>(lag.rows * lag.cols), 0.0));
      else
        potential.set_lag(lag.name, state.internal.at(static_cast<size_t>(i)).at(lag.name));
    }
  }
  constraints_.start(*system_, state.internal);
}

void TimeStepper::begin_contact(const Solve& stage, const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& v,
                                StepRecord& record) {
  const Stopwatch watch(record.seconds.contact);
  contact_->begin_step(x, v, stage.lag_dt);
  contact_->lag_friction(x, stage.xlag, stage.lag_dt);
}

// Newton, repeated with new normal forces of friction until these have settled, and until constraints are kept.
NewtonResult TimeStepper::solve(const Solve& stage, Eigen::Matrix3Xd& x, StepRecord& record) {
  NewtonOptions newton;
  newton.dt = stage.dt;
  newton.tolerance = options_.tolerance;
  newton.max_iterations = options_.max_iterations;
  newton.projection = options_.projection;
  newton.on_demand = options_.project_on_demand;
  if (integrator_named(options_.integrator).has_inertia) newton.curvature = resisting_mass_ / (stage.dt * stage.dt);
  if (!script_.empty()) {
    goal_ = x;
    script_.place(stage.end, goal_);
    newton.prescribed = {&script_.vertices(), &goal_};
  }

  NewtonResult result;
  int solves = 0;
  double foretold = 0;  // by the first steps of all solves
  bool again = true;
  while (again) {
    result = newton_.minimise(*system_, x, newton, contact_);
    ++solves;
    result.first_step_speed = foretold += result.first_step_speed;
    add_solve(result, record);
    if (contact_ && contact_->has_friction()) ++record.friction_iterations;
    take_balance(x);
    if (options_.record_forces && contact_) record.forces = forces(x);
    if (!result.converged) break;
    const bool rubs = friction_changes(stage, x, solves, record);
    const bool gives = constraints_give(x, solves, result, record);
    again = result.converged && (rubs || gives);
  }
  return result;
}

bool TimeStepper::friction_changes(const Solve& stage, const Eigen::Matrix3Xd& x, int solves, StepRecord& record) {
  if (!contact_ || !contact_->has_friction()) return false;
  const Stopwatch watch(record.seconds.contact);
  record.friction_change = contact_->lag_friction(x, stage.xlag, stage.lag_dt).fraction();
  return record.friction_change > options_.friction_tolerance && solves < options_.friction_lag_iterations;
}

// Whether some constraint is beyond its tolerance: it is then tightened, unless it has been too often.
bool TimeStepper::constraints_give(const Eigen::Matrix3Xd& x, int solves, NewtonResult& result, StepRecord& record) {
  if (constraints_.empty()) return false;
  const Violation worst = constraints_.violation(*system_, x);
  record.constraint_excess = worst.excess;
  if (worst.excess <= 1) return false;
  if (solves >= options_.constraint_iterations) {
    result.converged = false;
    result.reason = constraints_.describe(*system_, worst) +
                    fmt::format(
                        ", after {} solves; see whether fixed points, contact or other constraints keep it "
                        "from being met, or allow a larger tolerance",
                        solves);
    return false;
  }
  record.energy_added += constraints_.tighten(*system_, x);
  ++record.constraint_iterations;
  return true;
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

void TimeStepper::advance(State& state, const Moment& end) {
  for (int i = 0; i < system_->potential_count(); ++i) {
    if (!renews(system_->potential(i))) continue;
    lag_dt(i, options_.dt);
    state.internal.resize(static_cast<size_t>(system_->potential_count()));
    StencilData& internal = state.internal[static_cast<size_t>(i)];
    internal = system_->potential(i).renewed(end.x);
    constraints_.keep(i, internal);
  }
  state.last_x = std::move(state.x);
  state.last_v = std::move(state.v);
  state.last_dt = options_.dt;
  state.x = end.x;
  state.v = end.v;
  state.a = end.a;
  system_->carriers().place(state.x);  // free of the rounding that the iterations added up
  state.step += 1;
  state.time += options_.dt;
}

}  // namespace ergon
