#pragma once
// Steps of a length that adapts. It establishes that a step which fails is tried again with half of its dt, down to a
// stated least one, that steps end exactly at the multiples of a given interval, and that what was tried is counted.

#include "runtime/solver/time_step.h"

namespace ergon {

struct StepLimits {
  double largest = 0;   // s
  double smallest = 0;  // s; a step that fails with this one is final
  double interval = 0;  // s: a step ends at each multiple of it
};

class StepControl {
 public:
  // Throws InputError unless 0 < smallest <= largest and interval > 0.
  StepControl(TimeStepper& stepper, StepLimits limits);

  // One step that is accepted, or one that is not with the smallest dt; then the state is as it was.
  StepRecord step(State& state);

 private:
  double fitted(double dt, double left) const;
  std::string refusal(const State& state, const StepRecord& record) const;

  TimeStepper* stepper_;
  StepLimits limits_;
  double next_;  // s, dt that is tried next
};

}  // namespace ergon
