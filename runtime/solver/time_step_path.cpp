// Equilibria that follow a load. A step stays on the path of stable equilibria: where it came to rest elsewhere, it has
// passed a limit point or a branching point. Source: Fujii, Ramm 1997, Computational
// Bifurcation Theory: Path-Tracing, Pinpointing and Path-Switching, Engineering Structures 19(5): at these points the
// tangent is singular.

#include <fmt/format.h>

#include <algorithm>

#include "runtime/solver/largest.h"
#include "runtime/solver/time_step.h"

namespace ergon {

namespace {

// Next to a limit point, where displacements go as the root of what is left of the load, a step that ends in it leads
// twice as far as the tangent foretells.
constexpr double farthest = 4;

}  // namespace

void TimeStepper::grow_loads(std::vector<Load> loads, double end) {
  loads_ = std::move(loads);
  load_end_ = end;
}

double TimeStepper::load_factor(double time) const {
  return load_end_ > 0 ? std::clamp(time / load_end_, 0.0, 1.0) : 1;
}

void TimeStepper::set_loads(double factor) {
  for (const Load& load : loads_) {
    std::vector<double> values = load.full;
    for (double& value : values) value *= factor;
    system_->potential(load.potential).set_param(load.param, values);
  }
}

// Whether the state that a step starts from is a minimum. A mechanism, such as a flat cloth without any load, is none:
// its first step may end in any.
bool TimeStepper::is_stable(const State& state) {
  if (stable_ && stable_->first == state.time) return stable_->second;
  prepare_at(state);
  stable_ = {state.time, newton_.is_minimum(*system_, state.x)};
  return stable_->second;
}

// Of the state that a load step came to: says in the result why it may not stand.
void TimeStepper::judge_path(const State& state, const Eigen::Matrix3Xd& x, bool was_stable, NewtonResult& result) {
  const Largest moved = largest_motion(*system_, x - state.x);
  const double foretold = result.first_step_speed * options_.dt;
  if (contact_) contact_->set_active(x);
  const bool stable = newton_.is_minimum(*system_, x);
  stable_ = {state.time + options_.dt, stable};
  if (was_stable && !stable) {
    result.reason = "the tangent is not positive definite there, as past a limit point or a branching point" +
                    (result.converged ? "" : "; " + result.reason);
    result.converged = false;
  } else if (result.converged && moved.value > farthest * foretold && foretold > 0) {
    result.converged = false;
    result.worst_vertex = moved.vertex;
    result.reason = fmt::format(
        "the equilibrium found lies {:.3g} m off, {:.3g} times as far as the tangent foretells, as past a limit point",
        moved.value, moved.value / foretold);
  }
}

}  // namespace ergon
