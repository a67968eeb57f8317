// ergon fit ENERGY DATA: the params of a density that follow measured stress best.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <ostream>

#include "runtime/error.h"
#include "symbolic/analyse.h"
#include "tools/assignments.h"
#include "tools/command.h"
#include "tools/files.h"
#include "tools/fit.h"
#include "tools/installation.h"
#include "tools/response.h"
#include "tools/rows.h"

namespace ergon {
namespace {

struct Options {
  std::string energy, data, plot;
  std::vector<std::string> set;
  bool json = false;
};

// The curves of the law with the points that were measured, one chart for all tests.
Chart chart_of(const Energy& energy, const Fit& fit, const std::vector<StressPoint>& points) {
  const std::string unit = to_string(value_unit(energy));
  Chart chart{energy.name, "stretch", fmt::format("nominal stress ({})", unit), {}};
  for (const std::string& mode : modes_of(energy)) {
    const int color = static_cast<int>(chart.lines.size()) / 2;
    std::string label = mode;
    std::replace(label.begin(), label.end(), '_', ' ');
    ChartLine marks{label + ", measured", {}, {}, true, color};
    for (const StressPoint& point : points) {
      if (point.mode != mode) continue;
      marks.x.push_back(point.stretch);
      marks.y.push_back(point.stress);
    }
    if (marks.x.empty()) continue;
    ResponseOptions options;
    options.given = fit.data;
    options.modes = {mode};
    const auto [low, high] = std::minmax_element(marks.x.begin(), marks.x.end());
    options.low = std::min(*low, mode == "simple_shear" ? 0.0 : 1.0);
    options.high = std::max(*high, mode == "simple_shear" ? 0.0 : 1.0);
    const Response response = response_of(energy, options);
    chart.lines.push_back(marks);
    chart.lines.push_back({label, response.curves.at(0).x, response.curves.at(0).force, false, color});
  }
  return chart;
}

double rms_of(const std::string& mode, const Fit& fit, const std::vector<StressPoint>& points) {
  double sum = 0;
  int count = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    if (points[i].mode != mode) continue;
    sum += std::pow(fit.stress[i] - points[i].stress, 2);
    ++count;
  }
  return count == 0 ? 0 : std::sqrt(sum / count);
}

// What goes below an [[object]] of a scene.
std::string scene_text(const Energy& energy, const std::string& law, const Fit& fit) {
  std::string text = fmt::format("[[object.energy]]\nlaw = \"{}\"\n", law);
  for (const Symbol* param : energy.with_role(Role::param)) {
    const std::vector<double>& values = fit.data.at(param->name);
    text += values.size() == 1 ? fmt::format("{} = {:.8g}\n", param->name, values[0])
                               : fmt::format("{} = [{:.8g}]\n", param->name, fmt::join(values, ", "));
  }
  return text;
}

void print_json(const Energy& energy, const Fit& fit, size_t points, std::ostream& out) {
  Rows rows(out, true);
  Row row = {{"energy", energy.name},        {"points", points},          {"rms", fit.rms}, {"relative", fit.relative},
             {"iterations", fit.iterations}, {"converged", fit.converged}};
  for (const FittedParam& param : fit.params) {
    row["params"][param.name] = param.value;
    row["errors"][param.name] = param.error;
    if (!param.determined) row["undetermined"].push_back(param.name);
  }
  rows.add(row);
}

int fit(const Options& options, std::ostream& out) {
  const Energy energy = find_energy(options.energy);
  if (energy.kind != Energy::Kind::density)
    throw InputError(
        fmt::format("{} is an energy over {}; stress is measured of densities", energy.name, energy.geometry));
  const std::vector<StressPoint> points = read_stress_data(options.data, energy);
  const Fit found = fit_params(energy, points, read_assignments(energy, options.set));
  if (!options.plot.empty()) write_text_file(options.plot, svg_of({chart_of(energy, found, points)}));
  const int code = found.converged ? exit_done : exit_failed;
  if (options.json) {
    print_json(energy, found, points.size(), out);
    return code;
  }
  const std::string unit = to_string(value_unit(energy));
  out << fmt::format("{}: {} points of {}\n", energy.name, points.size(), options.data);
  for (const FittedParam& param : found.params) {
    const std::string param_unit = to_string(energy.find(param.name)->unit);
    out << fmt::format("  {:<8} {:>12.6g} +- {:<8.2g} {}{}\n", param.name, param.value, param.error,
                       param_unit == "1" ? "" : param_unit, param.at_bound ? "  at the end of its range" : "");
  }
  out << fmt::format("residual: root mean square {:.4g} {}, {:.2g} % of the stress; {} after {} iterations\n",
                     found.rms, unit, 100 * found.relative, found.converged ? "converged" : "NOT converged",
                     found.iterations);
  for (const std::string& mode : modes_of(energy))
    if (std::any_of(points.begin(), points.end(), [&](const StressPoint& point) { return point.mode == mode; }))
      out << fmt::format("  {:<13} {:.4g} {}\n", mode, rms_of(mode, found, points), unit);
  std::vector<std::string> open;
  for (const FittedParam& param : found.params)
    if (!param.determined) open.push_back(param.name);
  if (!open.empty())
    out << fmt::format("warning: the data does not determine {}; give {} with --set, or measure what depends on {}\n",
                       fmt::join(open, " and "), open.size() == 1 ? "it" : "some of them",
                       open.size() == 1 ? "it" : "them");
  out << '\n' << scene_text(energy, options.energy, found);
  return code;
}

}  // namespace

void add_fit_command(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("fit", "Finds the params of a density from measured stress");
  auto options = std::make_shared<Options>();
  command->add_option("energy", options->energy, "an .energy file, or a name in the catalogue")->required();
  command
      ->add_option("data", options->data,
                   "text file of columns mode,stretch,stress (UNIT); nominal stress; modes: uniaxial, equibiaxial, "
                   "pure_shear, simple_shear, volumetric")
      ->required();
  command->add_option("--set", options->set, "NAME=VALUE of a param that is known; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
  command->add_option("--plot", options->plot, "an SVG file of what is measured and what the law makes of it");
  command->add_flag("--json", options->json, "one JSON object instead of text");
  command->callback([options, &run] { run = [options](std::ostream& out) { return fit(*options, out); }; });
}

}  // namespace ergon
