#include "tools/response.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/error.h"
#include "symbolic/analyse.h"
#include "symbolic/sample_states.h"
#include "tools/choices.h"
#include "tools/law_point.h"
#include "tools/load_path.h"
#include "tools/stencil_path.h"

namespace ergon {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::vector<double> between(double low, double high, int samples) {
  std::vector<double> out;
  for (int i = 0; i < samples; ++i) out.push_back(low + (high - low) * i / (samples - 1));
  return out;
}

std::string first_case(const Energy& energy) { return energy.cases.empty() ? "" : energy.cases.front(); }

bool is_wanted(const std::vector<std::string>& modes, const std::string& name) {
  return modes.empty() || std::find(modes.begin(), modes.end(), name) != modes.end();
}

ResponseCurve density_curve(const LawPoint& law, const LoadPath& path, const ResponseOptions& options) {
  const bool shear = path.rest == 0;
  double low = options.low, high = options.high;
  if (low == 0 && high == 0) {
    low = shear ? 0 : path.name == "volumetric" ? 0.7 : 0.4;
    high = shear ? 2 : path.name == "volumetric" ? 1.5 : 3;
  }
  ResponseCurve curve{path.name, shear ? "amount of shear" : "stretch", "1", between(low, high, options.samples), {},
                      {}};
  for (const std::optional<LoadState>& state : along(law, path, curve.x)) {
    curve.force.push_back(state ? state->stress : nan);
    curve.energy.push_back(state ? state->energy : nan);
  }
  return curve;
}

// Rest and lag data that are named after a dof: its position at rest.
void put_rest_positions(const Energy& energy, const StencilPath& path,
                        std::map<std::string, std::vector<double>>& data) {
  const Eigen::VectorXd X = path.positions(path.rest);
  Eigen::Index first = 0;
  for (const Symbol* dof : energy.with_role(Role::dof)) {
    const Symbol* rest = rest_position(energy, *dof);
    for (const std::string& name : {rest == nullptr ? dof->name : rest->name, dof->name + "lag", dof->name + "hat"}) {
      const Symbol* symbol = energy.find(name);
      if (symbol == nullptr || symbol->role == Role::dof || data.contains(name)) continue;
      data[name] = {X[first], X[first + 1], X[first + 2]};
    }
    first += 3;
  }
}

ResponseCurve stencil_curve(const Energy& energy, const StencilPath& path, const ResponseOptions& options,
                            const std::map<std::string, std::vector<double>>& usual) {
  std::map<std::string, std::vector<double>> data = usual;
  put_rest_positions(energy, path, data);
  const LawPoint law(energy, first_case(energy), data);
  const bool usual_range = options.low == 0 && options.high == 0;
  ResponseCurve curve{
      path.name, path.quantity,
      path.unit, between(usual_range ? path.low : options.low, usual_range ? path.high : options.high, options.samples),
      {},        {}};
  for (const double s : curve.x) {
    const LawState state = law.at(path.positions(s));
    const bool acts = state.active;
    curve.energy.push_back(!acts ? 0 : state.defined ? state.value : nan);
    curve.force.push_back(!acts ? 0 : state.defined ? state.gradient.dot(path.change(s)) : nan);
  }
  return curve;
}

bool says_nothing(const ResponseCurve& curve) {
  double force = 0, energy = 0;
  for (size_t i = 0; i < curve.x.size(); ++i) {
    if (std::isfinite(curve.force[i])) force = std::max(force, std::fabs(curve.force[i]));
    if (std::isfinite(curve.energy[i])) energy = std::max(energy, std::fabs(curve.energy[i]));
  }
  return !(force > 1e-9 * energy);
}

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit == "1" ? name : fmt::format("{} ({})", name, unit);
}

}  // namespace

std::vector<std::string> modes_of(const Energy& energy) {
  std::vector<std::string> names;
  if (energy.kind == Energy::Kind::density)
    for (const LoadPath& path : load_paths(energy.geometry)) names.push_back(path.name);
  else
    for (const StencilPath& path : stencil_paths(energy.geometry)) names.push_back(path.name);
  return names;
}

Response response_of(const Energy& energy, const ResponseOptions& options) {
  for (const std::string& mode : options.modes) chosen("--mode", mode, modes_of(energy));
  const bool density = energy.kind == Energy::Kind::density;
  Response out;
  out.name = energy.name;
  out.energy_unit = energy.geometry == "solid" ? "J/m^3" : to_string(value_unit(energy));
  out.data = usual_data(energy, options.given);
  if (density) {
    out.force = energy.geometry == "line" ? "force" : "nominal stress";
    out.force_unit = to_string(value_unit(energy));
    const LawPoint law(energy, first_case(energy), out.data);
    for (const LoadPath& path : load_paths(energy.geometry))
      if (is_wanted(options.modes, path.name)) out.curves.push_back(density_curve(law, path, options));
  } else {
    for (const StencilPath& path : stencil_paths(energy.geometry)) {
      if (!is_wanted(options.modes, path.name)) continue;
      ResponseCurve curve = stencil_curve(energy, path, options, out.data);
      if (says_nothing(curve)) continue;
      out.force = path.unit == "rad" ? "moment" : path.unit == "m" ? "force" : "energy per scale";
      out.force_unit = path.unit == "rad" ? "N*m" : path.unit == "m" ? "N" : "J";
      out.curves.push_back(std::move(curve));
      break;
    }
  }
  return out;
}

std::vector<Chart> charts_of(const Response& response) {
  std::vector<Chart> charts;
  for (const ResponseCurve& curve : response.curves) {
    const std::string x_label = with_unit(curve.quantity, curve.quantity_unit);
    const bool stress = response.force == "nominal stress";
    const bool of_its_own = charts.empty() || !stress || curve.mode == "simple_shear" || curve.mode == "volumetric";
    std::string label = curve.mode;
    std::replace(label.begin(), label.end(), '_', ' ');
    if (of_its_own)
      charts.push_back({!stress                        ? response.force
                        : curve.mode == "simple_shear" ? "shear"
                        : curve.mode == "volumetric"   ? "volume"
                                                       : "stretching",
                        x_label,
                        with_unit(response.force, response.force_unit),
                        {}});
    charts.back().lines.push_back({label, curve.x, curve.force});
    if (!stress) charts.push_back({"energy", x_label, with_unit("energy", response.energy_unit), {}});
    if (!stress) charts.back().lines.push_back({label, curve.x, curve.energy});
  }
  return charts;
}

std::string csv_of(const Response& response) {
  std::string out;
  for (const ResponseCurve& curve : response.curves) {
    const bool stress = response.force == "nominal stress";
    if (out.empty())
      out = fmt::format("mode,{},{},{}\n", with_unit(stress ? "stretch" : curve.quantity, curve.quantity_unit),
                        with_unit(stress ? "stress" : response.force, response.force_unit),
                        with_unit("energy", response.energy_unit));
    for (size_t i = 0; i < curve.x.size(); ++i)
      if (std::isfinite(curve.force[i]))
        out += fmt::format("{},{:.17g},{:.17g},{:.17g}\n", curve.mode, curve.x[i], curve.force[i], curve.energy[i]);
  }
  return out;
}

std::string data_text(const Energy& energy, const std::map<std::string, std::vector<double>>& data) {
  std::vector<std::string> parts;
  for (const Symbol& symbol : energy.symbols) {
    const auto found = data.find(symbol.name);
    if (found == data.end() || symbol.role == Role::dof) continue;
    const std::string unit = symbol.unit.dimensionless() ? "" : " " + to_string(symbol.unit);
    parts.push_back(found->second.size() == 1
                        ? fmt::format("{} = {:.6g}{}", symbol.name, found->second[0], unit)
                        : fmt::format("{} = [{:.6g}]{}", symbol.name, fmt::join(found->second, ", "), unit));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace ergon
