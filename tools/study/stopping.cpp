#include "tools/study/stopping.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "tools/choices.h"

namespace ergon {
namespace {

using Changes = std::vector<std::string>;

std::vector<StoppingValue> values_of(const std::string& path, const std::vector<std::string>& values,
                                     const std::string& usual, const Changes& beside = {}) {
  std::vector<StoppingValue> out;
  for (const std::string& value : values) {
    Changes changes = {path + "=" + value};
    changes.insert(changes.end(), beside.begin(), beside.end());
    out.push_back({value, std::move(changes), value == usual});
  }
  return out;
}

struct Base {
  const char* problem;
  Changes changes;
  Changes finer_dt, finer_mesh;
};

// Settings that reach about a percent.
std::vector<Base> bases() {
  const auto mesh = [](const char* element, const char* cells) -> Changes {
    return {std::string("object.body.element=") + element, std::string("object.body.box.cells=") + cells};
  };
  const auto base = [&](const char* problem, const char* element, const char* cells, const char* finer, double dt) {
    Base out{problem, mesh(element, cells), {fmt::format("time.dt={}", dt / 4)}, mesh(element, finer)};
    out.changes.emplace_back("time.integrator=bdf2");
    out.changes.push_back(fmt::format("time.dt={}", dt));
    return out;
  };
  return {base("cantilever", "hex20", "[8, 1, 1]", "[16, 2, 2]", 0.00625),
          base("column", "hex20", "[2, 2, 4]", "[4, 4, 8]", 0.0025),
          base("cloth", "quad9", "[4, 4, 1]", "[8, 8, 1]", 0.00625),
          base("impact", "hex20", "[2, 2, 2]", "[4, 4, 4]", 0.000625),
          base("buckling", "hex20", "[1, 1, 16]", "[2, 2, 32]", 0.00625),
          base("slide", "hex20", "[2, 2, 1]", "[4, 4, 2]", 0.0025)};
}

StoppingSweep sweep_of(const std::string& study, const Base& base, const std::string& key) {
  return {study, base.problem, key, base.changes, {}, {}, base.finer_dt, base.finer_mesh};
}

void add_tolerance(std::vector<StoppingSweep>& out) {
  for (const Base& base : bases()) {
    StoppingSweep sweep = sweep_of("tolerance", base, "solver.tolerance (m/s)");
    sweep.values = values_of("solver.tolerance", {"1", "0.1", "0.01", "0.001", "0.0001", "1e-05", "1e-06"}, "0.0001");
    sweep.strict = {"solver.tolerance=1e-7", "solver.friction_iterations=2"};
    out.push_back(std::move(sweep));
  }
}

void add_friction(std::vector<StoppingSweep>& out) {
  const Base base = bases().back();
  StoppingSweep solves = sweep_of("friction", base, "solver.friction_iterations");
  solves.values = values_of("solver.friction_iterations", {"1", "2", "3", "5", "10"}, "2");
  solves.strict = {"solver.friction_iterations=50", "solver.friction_tolerance=1e-6"};
  out.push_back(solves);

  StoppingSweep change = solves;
  change.key = "solver.friction_tolerance, up to 50 solves";
  change.values = values_of("solver.friction_tolerance", {"0.5", "0.2", "0.05", "0.01", "0.001"}, "0.05",
                            {"solver.friction_iterations=50"});
  out.push_back(change);

  StoppingSweep speed = solves;
  speed.key = "ground.epsv (m/s)";
  speed.values = values_of("ground.0.epsv", {"0.1", "0.01", "0.001", "0.0001"}, "0.001");
  speed.strict = {"ground.0.epsv=1e-5"};
  out.push_back(speed);
}

void add_barrier(std::vector<StoppingSweep>& out) {
  for (const Base& base : bases()) {
    const bool slides = base.problem == std::string("slide");
    if (!slides && base.problem != std::string("impact")) continue;
    StoppingSweep reach = sweep_of("barrier", base, "ground.dhat (m)");
    reach.values = values_of("ground.0.dhat", {"0.01", "0.003", "0.001", "0.0003", "0.0001"}, "0.001");
    reach.strict = {"ground.0.dhat=3e-5"};
    out.push_back(std::move(reach));
    StoppingSweep stiffness = sweep_of("barrier", base, "ground.stiffness (N/m)");
    stiffness.values = values_of("ground.0.stiffness", {"1", "10", "100", "1000", "1e4", "1e5"}, "");
    stiffness.values.push_back({"chosen by the solver", {}, true});
    stiffness.strict = {"ground.0.dhat=3e-5"};
    out.push_back(std::move(stiffness));
  }
}

StudyRun compared(const StoppingSweep& sweep, const Changes& more, StudyRunner& runner) {
  Changes changes = sweep.base;
  changes.insert(changes.end(), sweep.strict.begin(), sweep.strict.end());
  changes.insert(changes.end(), more.begin(), more.end());
  StudyRun run = runner.run(sweep.problem, changes);
  if (!run.failure.empty())
    throw std::runtime_error(
        fmt::format("{}, {}: what is compared with fails: {}", sweep.problem, sweep.key, run.failure));
  return run;
}

}  // namespace

std::vector<StoppingSweep> stopping_sweeps(const std::string& study, bool brief) {
  const std::vector<std::string> names = {"tolerance", "friction", "barrier"};
  std::vector<StoppingSweep> all, out;
  add_tolerance(all);
  add_friction(all);
  add_barrier(all);
  const std::string only = study.empty() ? "" : names[chosen("--study", study, names)];
  for (StoppingSweep& sweep : all) {
    if (!only.empty() && sweep.study != only) continue;
    if (brief) {
      const auto same = [&](const StoppingSweep& other) { return other.study == sweep.study; };
      if (std::any_of(out.begin(), out.end(), same)) continue;
      sweep.finer_mesh.clear();
      sweep.values.erase(sweep.values.begin() + 3, sweep.values.end());
    }
    out.push_back(std::move(sweep));
  }
  return out;
}

StoppingStudy run_stopping(const StoppingSweep& sweep, StudyRunner& runner) {
  StoppingStudy study{sweep, {}, 0, 0};
  const StudyRun strict = compared(sweep, {}, runner);
  study.dt_error = study_error(strict, compared(sweep, sweep.finer_dt, runner));
  if (!sweep.finer_mesh.empty()) study.mesh_error = study_error(strict, compared(sweep, sweep.finer_mesh, runner));
  for (const StoppingValue& value : sweep.values) {
    Changes changes = sweep.base;
    changes.insert(changes.end(), value.changes.begin(), value.changes.end());
    StudyRun run = runner.run(sweep.problem, changes);
    const double error = study_error(run, strict);
    study.rows.push_back({value, std::move(run), error});
  }
  return study;
}

}  // namespace ergon
