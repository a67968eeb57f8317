#include "tools/stress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/solver/stopwatch.h"
#include "scenes/run.h"
#include "scenes/scene_reader.h"

namespace ergon {
namespace {

constexpr double created_at_most = 1e-6;  // of the largest energy: what Newton's tolerance leaves
constexpr double same_motion = 1e-6;      // of the size, between units

struct Finished {
  BuiltScene built;
  RunSummary summary;
  State end;
};

Finished run_text(const StressCase& what, const KernelSource& kernels, long steps, StressOutcome& out) {
  const Scene scene = read_scene_text(what.scene, what.name + ".toml");
  Finished run{build_scene(scene, Catalogue(Catalogue::default_folders()), kernels), {}, {}};
  if (steps > 0) run.built.steps = std::min(steps, run.built.steps);
  if (what.disturb) what.disturb(run.built);
  RunOptions options;
  options.verify = true;
  options.last_state = &run.end;
  const bool monotone = scene.integrator() == "implicit_euler";
  double since_start = 0;
  options.progress = [&](const StepRecord& record, long) {
    if (!record.accepted) return;
    const Budget& budget = record.budget;
    out.energy = std::max({out.energy, record.energy.kinetic, std::abs(record.energy.total)});
    for (const auto& [name, value] : record.energy.stored) out.energy = std::max(out.energy, std::abs(value));
    const double gain = budget.change - budget.script - budget.loads - budget.barrier;
    since_start += gain;
    out.energy_created = std::max(out.energy_created, monotone ? gain : since_start);
    out.residual = std::max(out.residual, std::abs(budget.residual));
  };
  run.summary = run_scene(scene, run.built, options);
  out.steps += run.summary.steps;
  out.newton_iterations += run.summary.newton_iterations;
  out.unconverged += run.summary.unconverged_steps;
  out.smallest_gap = run.summary.smallest_gap;
  out.fault = run.summary.failure;
  return run;
}

std::string fault_of(const StressOutcome& outcome, const State& end) {
  if (!end.x.allFinite() || !end.v.allFinite()) return "the state at the end is not finite";
  if (outcome.unconverged > 0) return fmt::format("{} steps did not converge", outcome.unconverged);
  if (outcome.energy_created > created_at_most * outcome.energy)
    return fmt::format("energy is created: {:.3g} J, of {:.3g} J", outcome.energy_created, outcome.energy);
  return "";
}

}  // namespace

StressOutcome run_stress_case(const StressCase& what, const std::string& element, const KernelSource& kernels,
                              long steps) {
  StressOutcome out;
  out.name = what.name;
  out.element = element;
  {
    const Stopwatch watch(out.seconds);
    const Finished run = run_text(what, kernels, steps, out);
    if (out.fault.empty()) out.fault = fault_of(out, run.end);
    if (out.fault.empty() && what.judge) out.fault = what.judge(run.built, run.end);
  }
  return out;
}

StressOutcome run_stress_units(const std::string& element, const KernelSource& kernels, long steps) {
  StressOutcome out;
  out.name = "the same in mm";
  out.element = element;
  const UnitPair pair = stress_units(element);
  const Stopwatch watch(out.seconds);
  const Finished metres = run_text({out.name, pair.metres, {}, {}}, kernels, steps, out);
  if (!out.fault.empty()) return out;
  const Finished millimetres = run_text({out.name, pair.millimetres, {}, {}}, kernels, steps, out);
  if (!out.fault.empty()) return out;
  const double size = metres.end.x.cwiseAbs().maxCoeff();
  const double difference = (millimetres.end.x / 1000 - metres.end.x).cwiseAbs().maxCoeff();
  if (!(difference <= same_motion * size)) out.fault = fmt::format("the motion differs by {:.3g} m", difference);
  return out;
}

}  // namespace ergon
