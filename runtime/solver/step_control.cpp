#include "runtime/solver/step_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/error.h"

namespace ergon {

namespace {

constexpr double growth = 2;        // of dt, after a step that was accepted
constexpr double same_time = 1e-9;  // of the interval: times that differ by less are one

// What a step that was refused cost, with that of the next try.
void add_cost(const StepRecord& refused, StepRecord& record) {
  record.newton_iterations += refused.newton_iterations;
  record.follow_iterations += refused.follow_iterations;
  record.factorisations += refused.factorisations;
  record.halvings += refused.halvings;
  record.shifts += refused.shifts;
  record.indefinite += refused.indefinite;
  record.seconds.evaluate += refused.seconds.evaluate;
  record.seconds.factor += refused.seconds.factor;
  record.seconds.solve += refused.seconds.solve;
  record.seconds.line_search += refused.seconds.line_search;
  record.seconds.contact += refused.seconds.contact;
  record.seconds.total += refused.seconds.total;
  record.refused = refused.refused + 1;
}

}  // namespace

StepControl::StepControl(TimeStepper& stepper, StepLimits limits)
    : stepper_(&stepper), limits_(limits), next_(limits.largest) {
  if (!(limits.smallest > 0) || !(limits.smallest <= limits.largest) || !std::isfinite(limits.largest))
    throw InputError(
        fmt::format("the smallest dt is {:g} s and the largest {:g} s; the smallest must be above 0, and "
                    "not above the largest",
                    limits.smallest, limits.largest));
  if (!(limits.interval > 0))
    throw InputError(fmt::format("the interval is {:g} s; it must be above 0", limits.interval));
}

StepRecord StepControl::step(State& state) {
  const double index = std::floor(state.time / limits_.interval + same_time) + 1;
  const double goal = index * limits_.interval;
  StepRecord refused;
  for (int tries = 0;; ++tries) {
    const double dt = fitted(next_, goal - state.time);
    stepper_->options().dt = dt;
    StepRecord record = stepper_->step(state);
    if (tries > 0) add_cost(refused, record);
    if (record.accepted) {
      if (goal - state.time <= same_time * limits_.interval) record.time = state.time = goal;
      next_ = std::min(limits_.largest, tries > 0 ? dt : std::max(next_, growth * dt));
      return record;
    }
    if (dt / 2 < limits_.smallest) {
      record.reason = refusal(state, record);
      return record;
    }
    next_ = dt / 2;
    refused = std::move(record);
  }
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
  return fmt::format(
      "no stable equilibrium was found past load factor {:.6g}, as at a limit point; the one there is kept. At a load "
      "factor larger by {:.3g}: {}",
      factor, stepper_->load_factor(state.time + record.dt) - factor, record.reason);
}

}  // namespace ergon
