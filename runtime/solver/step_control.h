#pragma once
// Steps of a length that adapts. It establishes that a step which fails is tried again with half of its dt, down to a
// stated least one, that dt follows the error that is tolerated, that steps end exactly at the multiples of a given
// interval, and that what was tried is counted. Source: Hairer, Norsett, Wanner 1993, Solving Ordinary Differential
// Equations I, II.4: dt by the estimated error.

#include "runtime/solver/time_step.h"

namespace ergon {

struct StepLimits {
  double largest = 0;   // s
  double smallest = 0;  // s; a step that fails with this one is final
  double interval = 0;  // s: a step ends at each multiple of it
  // m: a step of which the integrator's error is estimated to be larger is tried again with a dt that the estimate
  // says, unless that is the smallest; dt follows the estimate. inf: dt changes only where steps fail.
  double tolerance = std::numeric_limits<double>::infinity();
  double end = std::numeric_limits<double>::infinity();  // s: a step ends there too
};

class StepControl {
 public:
  // Throws InputError unless 0 < smallest <= largest, interval > 0, tolerance > 0; for a tolerance without inertia.
  StepControl(TimeStepper& stepper, StepLimits limits);

  // One step that is accepted, or one that is not with the smallest dt; then the state is as it was.
  StepRecord step(State& state);

 private:
  double fitted(double dt, double left) const;
  double by_error(double error, double dt) const;
  std::string refusal(const State& state, const StepRecord& record) const;

  TimeStepper* stepper_;
  StepLimits limits_;
  double next_;  // s, dt that is tried next
};

}  // namespace ergon
