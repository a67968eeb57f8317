#include "runtime/solver/step_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/error.h"
#include "runtime/solver/step_cost.h"

namespace ergon {

namespace {

constexpr double growth = 2;        // of dt, after a step that was accepted
constexpr double shrinkage = 0.2;   // of dt, after one that was not accurate enough
constexpr double safety = 0.9;      // of the dt that would have had the error that is tolerated
constexpr double same_time = 1e-9;  // of the interval: times that differ by less are one

}  // namespace

StepControl::StepControl(TimeStepper& stepper, StepLimits limits)
    : stepper_(&stepper), limits_(limits), next_(limits.largest) {
  if (!(limits.smallest > 0) || !(limits.smallest <= limits.largest) || !std::isfinite(limits.largest))
    throw InputError(
        fmt::format("the smallest dt is {:g} s and the largest {:g} s; the smallest must be above 0, and "
                    "not above the largest",
                    limits.smallest, limits.largest));
  const auto positive = [](const char* name, double value, const char* unit) {
    if (!(value > 0)) throw InputError(fmt::format("the {} is {:g} {}; it must be above 0", name, value, unit));
  };
  positive("interval", limits.interval, "s");
  positive("tolerance", limits.tolerance, "m");
  positive("end", limits.end, "s");
  const bool adapts = std::isfinite(limits.tolerance);
  if (adapts && !integrator_named(stepper.options().integrator).has_inertia)
    throw InputError("without inertia a step has no error in time that a tolerance could be for");
  stepper.options().estimate_error = adapts;
}

StepRecord StepControl::step(State& state) {
  const double index = std::floor(state.time / limits_.interval + same_time) + 1;
  const double goal = std::min(index * limits_.interval, limits_.end);
  const bool adapts = std::isfinite(limits_.tolerance);
  StepRecord refused;
  for (int tries = 0;; ++tries) {
    const double dt = fitted(next_, goal - state.time);
    const State before = adapts ? state : State{};
    stepper_->options().dt = dt;
    StepRecord record = stepper_->step(state);
    if (tries > 0) add_refused(refused, record);
    if (record.accepted && record.error > limits_.tolerance && dt > limits_.smallest * (1 + same_time)) {
      state = before;
      next_ = std::max(limits_.smallest, by_error(record.error, dt));
    } else if (record.accepted) {
      if (goal - state.time <= same_time * limits_.interval) record.time = state.time = goal;
      const double longest = adapts ? by_error(record.error, dt) : tries > 0 ? dt : std::max(next_, growth * dt);
      next_ = std::clamp(longest, limits_.smallest, limits_.largest);
      return record;
    } else if (dt / 2 < limits_.smallest) {
      record.reason = refusal(state, record);
      return record;
    } else {
      next_ = dt / 2;
    }
    refused = std::move(record);
  }
}

double StepControl::by_error(double error, double dt) const {
  const int order = integrator_named(stepper_->options().integrator).order;
  const double factor = safety * std::pow(limits_.tolerance / std::max(error, 1e-300), 1.0 / (order + 1));
  return dt * std::clamp(factor, shrinkage, growth);
}

// The next multiple of the interval is reached without a last step that is shorter than half of the one before.
double StepControl::fitted(double dt, double left) const {
  if (dt >= left * (1 - same_time)) return left;
  return 2 * dt > left ? left / 2 : dt;
}

std::string StepControl::refusal(const State& state, const StepRecord& record) const {
  if (integrator_named(stepper_->options().integrator).has_inertia)
    return fmt::format("even with dt = {:.3g} s {}", record.dt, record.reason);
  const double factor = stepper_->load_factor(state.time);
  const double more = stepper_->load_factor(state.time + record.dt) - factor;
  if (more == 0)  // what drives the scene is a script
    return fmt::format(
        "no stable equilibrium was found past {:.6g} s, as at a limit point; the one there is kept. {:.3g} s later: {}",
        state.time, record.dt, record.reason);
  return fmt::format(
      "no stable equilibrium was found past load factor {:.6g}, as at a limit point; the one there is kept. At a load "
      "factor larger by {:.3g}: {}",
      factor, more, record.reason);
}

}  // namespace ergon
