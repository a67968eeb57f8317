#include "tools/study/accuracy_problems.h"

#include <fmt/format.h>

#include "tools/choices.h"

namespace ergon {
namespace {

struct MeshChoice {
  const char* element;
  const char* cells;
};

// Lengths of steps for each integrator.
struct Method {
  const char* integrator;
  std::vector<double> dts;  // s, from the longest
};

struct Plan {
  const char* name;
  const char* summary;
  bool smooth;
  std::vector<MeshChoice> meshes;
  double dt;  // s, the longest
  AccuracySetting reference, other_reference;
  AccuracySetting good;          // that Newton's tolerance, precision and a dt that follows the error are varied about
  std::vector<MeshChoice> fine;  // for a tenth of a percent
  std::vector<AccuracySetting> plain;  // finer ones of what is plain, where the meshes above leave it far off
  std::vector<std::string> model = {};
};

std::vector<double> halved(double dt, int count, double factor) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i, dt /= factor) out.push_back(dt);
  return out;
}

// Implicit Euler needs steps that others do not; what has two solves per step does with fewer.
std::vector<Method> methods(double dt) {
  return {{"implicit_euler", halved(dt, 4, 4)},
          {"automatic", halved(dt, 4, 2)},
          {"newmark", halved(dt, 4, 2)},
          {"tr_bdf2", halved(dt, 3, 2)},
          {"sdirk2", halved(dt, 2, 2)}};
}

// Of second order, and short enough that the mesh is what counts.
std::vector<Method> fine_methods(double dt) {
  return {{"newmark", halved(dt / 4, 3, 2)}, {"tr_bdf2", halved(dt / 4, 3, 2)}, {"bdf2", halved(dt / 8, 2, 2)}};
}

void add_all(const std::vector<MeshChoice>& meshes, const std::vector<Method>& methods,
             std::vector<AccuracySetting>& out) {
  for (const auto& [element, cells] : meshes)
    for (const auto& [integrator, dts] : methods)
      for (const double dt : dts) out.push_back({element, cells, integrator, dt});
}

AccuracyProblem problem_of(const Plan& plan) {
  AccuracyProblem out{plan.name, plan.summary, plan.smooth, plan.model, {}, plan.reference, plan.other_reference};
  add_all(plan.meshes, methods(plan.dt), out.settings);
  add_all(plan.fine, fine_methods(plan.dt), out.settings);
  out.settings.insert(out.settings.end(), plan.plain.begin(), plan.plain.end());
  const auto vary = [&](auto change) {
    AccuracySetting setting = plan.good;
    change(setting);
    out.settings.push_back(setting);
  };
  for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-6})
    vary([&](AccuracySetting& setting) { setting.tolerance = tolerance; });
  vary([](AccuracySetting& setting) { setting.precision = "mixed"; });
  vary([](AccuracySetting& setting) {  // floats do not resolve the default tolerance
    setting.precision = "float";
    setting.tolerance = 1e-2;
  });
  for (const char* integrator : {"bdf2", "tr_bdf2"})
    for (const double tolerance : {1e-3, 1e-4, 1e-5})
      vary([&](AccuracySetting& setting) {
        setting.integrator = integrator;
        setting.dt = plan.dt;
        setting.time_tolerance = tolerance;
      });
  return out;
}

AccuracyProblem brief_of(const Plan& plan) {
  AccuracyProblem out{plan.name, plan.summary, plan.smooth, plan.model, {}, {}, {}};
  const MeshChoice &low = plan.meshes.front(), &high = plan.meshes.back();
  for (const auto& [element, cells] : {low, high})
    for (const char* integrator : {"implicit_euler", "automatic"})
      out.settings.push_back({element, cells, integrator, plan.dt});
  out.reference = {high.element, high.cells, "tr_bdf2", plan.dt / 4};
  out.other_reference = {high.element, high.cells, "sdirk2", plan.dt / 2};
  return out;
}

std::vector<Plan> plans() {
  return {
      {"cantilever",
       "a soft beam swings down under its weight",
       true,
       {{"tet4", "[16, 2, 2]"},
        {"tet4", "[32, 4, 4]"},
        {"hex8", "[16, 2, 2]"},
        {"hex8", "[32, 4, 4]"},
        {"tet10", "[8, 1, 1]"},
        {"tet10", "[16, 2, 2]"},
        {"hex27", "[8, 1, 1]"},
        {"hex27", "[16, 1, 1]"},
        {"hex20", "[16, 1, 1]"},
        {"hex20", "[4, 1, 1]"}},
       0.025,
       {"hex27", "[24, 3, 3]", "tr_bdf2", 0.025 / 32, 1e-6},
       {"hex27", "[24, 2, 2]", "newmark", 0.025 / 64, 1e-6},
       {"hex27", "[8, 1, 1]", "bdf2", 0.025 / 4},
       {{"hex27", "[16, 2, 2]"}, {"hex20", "[24, 2, 2]"}},
       {}},
      {"column",
       "a soft column is twisted by a torque and turns back",
       true,
       {{"tet4", "[2, 2, 8]"},
        {"tet4", "[4, 4, 16]"},
        {"hex8", "[2, 2, 8]"},
        {"hex8", "[4, 4, 16]"},
        {"tet10", "[2, 2, 8]"},
        {"hex27", "[3, 3, 6]"},
        {"hex27", "[2, 2, 4]"},
        {"hex20", "[2, 2, 4]"}},
       0.01,
       {"hex27", "[4, 4, 8]", "tr_bdf2", 0.01 / 32, 1e-6},
       {"hex27", "[3, 3, 6]", "newmark", 0.01 / 32, 1e-6},
       {"hex27", "[2, 2, 4]", "newmark", 0.01 / 8},
       {},
       {{"tet4", "[8, 8, 32]", "implicit_euler", 0.01 / 8}}},
      {"cloth",
       "a cloth held along one edge swings",
       true,
       {{"tri3", "[8, 8, 1]"},
        {"tri3", "[16, 16, 1]"},
        {"quad4", "[8, 8, 1]"},
        {"quad4", "[16, 16, 1]"},
        {"tri6", "[8, 8, 1]"},
        {"quad9", "[8, 8, 1]"},
        {"quad9", "[4, 4, 1]"}},
       0.05,
       {"quad9", "[16, 16, 1]", "tr_bdf2", 0.05 / 64, 1e-6},
       {"quad9", "[12, 12, 1]", "newmark", 0.05 / 64, 1e-6},
       {"quad9", "[4, 4, 1]", "bdf2", 0.05 / 8},
       {},
       {{"tri3", "[32, 32, 1]", "implicit_euler", 0.05 / 16}, {"tri3", "[32, 32, 1]", "implicit_euler", 0.05 / 64}}},
      {"bounce",
       "a soft block falls flat onto a mat and bounces off",
       false,
       {{"tet4", "[4, 4, 4]"},
        {"tet4", "[8, 8, 8]"},
        {"hex8", "[4, 4, 4]"},
        {"hex8", "[8, 8, 8]"},
        {"tet10", "[4, 4, 4]"},
        {"hex20", "[4, 4, 4]"},
        {"hex27", "[3, 3, 3]"},
        {"hex27", "[2, 2, 2]"}},
       0.005,
       {"hex27", "[5, 5, 5]", "tr_bdf2", 0.005 / 32, 1e-6},
       {"hex27", "[4, 4, 4]", "bdf2", 0.005 / 64, 1e-6},
       {"hex27", "[2, 2, 2]", "bdf2", 0.005 / 8},
       {{"hex27", "[4, 4, 4]"}},
       {}},
      {"buckling",
       "a slender column gives way under its weight",
       true,
       {{"tet4", "[2, 2, 40]"},
        {"tet4", "[4, 4, 80]"},
        {"hex8", "[2, 2, 40]"},
        {"tet10", "[1, 1, 16]"},
        {"hex27", "[1, 1, 8]"},
        {"hex27", "[1, 1, 16]"},
        {"hex20", "[1, 1, 16]"},
        {"hex20", "[1, 1, 8]"}},
       0.05,
       {"hex27", "[2, 2, 32]", "tr_bdf2", 0.05 / 32, 1e-6},
       {"hex27", "[2, 2, 24]", "newmark", 0.05 / 32, 1e-6},
       {"hex20", "[1, 1, 16]", "bdf2", 0.05 / 8},
       {{"hex27", "[1, 1, 32]"}, {"hex20", "[2, 2, 24]"}},
       {}}};
}

}  // namespace

std::vector<std::string> AccuracySetting::changes() const {
  std::vector<std::string> out = {"object.body.element=" + element,
                                  "object.body.box.cells=" + cells,
                                  "time.integrator=" + integrator,
                                  fmt::format("time.dt={}", dt),
                                  fmt::format("solver.tolerance={}", tolerance),
                                  "solver.precision=" + precision};
  if (time_tolerance > 0) out.push_back(fmt::format("time.tolerance={}", time_tolerance));
  return out;
}

std::vector<std::string> AccuracyProblem::changes(const AccuracySetting& setting) const {
  std::vector<std::string> out = setting.changes();
  out.insert(out.end(), model.begin(), model.end());
  return out;
}

std::string AccuracySetting::text() const {
  std::string out = fmt::format("{} {} {} dt {:g} s", element, cells, integrator, dt);
  if (time_tolerance > 0)
    out = fmt::format("{} {} {} time.tolerance {:g} m", element, cells, integrator, time_tolerance);
  if (tolerance != AccuracySetting{}.tolerance) out += fmt::format(" tolerance {:g} m/s", tolerance);
  if (precision != AccuracySetting{}.precision) out += " " + precision;
  return out;
}

std::vector<AccuracyProblem> accuracy_problems(bool brief) {
  std::vector<AccuracyProblem> out;
  for (const Plan& plan : plans()) out.push_back(brief ? brief_of(plan) : problem_of(plan));
  return out;
}

std::vector<AccuracyProblem> accuracy_problems(bool brief, const std::vector<std::string>& names) {
  std::vector<AccuracyProblem> all = accuracy_problems(brief), out;
  if (names.empty()) return all;
  std::vector<std::string> known;
  for (const AccuracyProblem& problem : all) known.push_back(problem.name);
  for (const std::string& name : names) out.push_back(all[chosen("--problem", name, known)]);
  return out;
}

}  // namespace ergon
