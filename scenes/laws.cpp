#include "scenes/laws.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace ergon {
namespace {

std::string list_of(const std::vector<std::string>& names) {
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

std::string in_unit(const Symbol& param) {
  std::string unit = to_string(param.unit);
  return unit == "1" ? "" : " " + unit;
}

std::vector<double> checked_values(const Energy& energy, const Symbol& param, const ParamValue& written) {
  const size_t size = static_cast<size_t>(param.shape.size());
  if (written.components.size() != size)
    throw SourceError(written.place, fmt::format("'{}' of {} is a {}, found {} numbers", param.name, energy.name,
                                                 to_string(param.shape), written.components.size()));
  std::vector<double> out;
  for (const WrittenNumber& q : written.components) {
    if (q.unit && *q.unit != param.unit)
      throw SourceError(written.place, fmt::format("'{}' of {} must be in {}, found \"{}\", which is in {}", param.name,
                                                   energy.name, to_string(param.unit), q.text, to_string(*q.unit)));
    if (!param.range.contains(q.value))
      throw SourceError(written.place, fmt::format("'{}' of {} must be in {}{}, found {}{} (declared in {})",
                                                   param.name, energy.name, to_string(param.range), in_unit(param),
                                                   q.text, q.unit ? "" : in_unit(param), to_string(param.place)));
    out.push_back(q.value);
  }
  return out;
}

// X0 is filled in for a dof x0.
bool is_rest_position(const Energy& energy, const Symbol& rest) {
  std::string dof = rest.name;
  dof[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(dof[0])));
  const Symbol* found = energy.find(dof);
  return dof != rest.name && found != nullptr && found->role == Role::dof && rest.shape == found->shape;
}

}  // namespace

const Energy& Laws::get(const std::string& law, const Place& place) {
  auto found = read_.find(law);
  if (found == read_.end()) found = read_.emplace(law, catalogue_->read_complete(law, scene_folder_, place)).first;
  return found->second;
}

const Energy& Laws::get(const EnergyUse& use) {
  if (!use.wrote("text")) return get(use.law, use.at("law"));
  const std::string key = to_string(use.at("text"));
  auto found = read_.find(key);
  if (found == read_.end()) {
    const std::string lines_above(static_cast<size_t>(use.text_line - 1), '\n');
    Energy energy = parse_energy(lines_above + use.text, use.place.file);
    energy.text = use.text;
    if (!energy.complete())
      throw SourceError(
          use.at("text"),
          fmt::format("'{}' is a part of an energy of contact; an object carries whole energies", energy.name));
    found = read_.emplace(key, std::move(energy)).first;
  }
  return found->second;
}

Parameters checked_params(const Energy& energy, const EnergyUse& use) {
  std::vector<std::string> names;
  for (const Symbol* param : energy.with_role(Role::param)) names.push_back(param->name);
  for (const auto& [name, written] : use.params)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw SourceError(written.key_place, fmt::format("{} has no param '{}' (its params: {}){}", energy.name, name,
                                                       list_of(names), did_you_mean(name, names)));
  Parameters out;
  for (const Symbol* param : energy.with_role(Role::param)) {
    auto written = use.params.find(param->name);
    if (written == use.params.end())
      throw SourceError(use.place, fmt::format("{} needs the param '{}': {}, in {}{}", energy.name, param->name,
                                               param->help.empty() ? "a " + to_string(param->shape) : param->help,
                                               to_string(param->range), in_unit(*param)));
    out[param->name] = checked_values(energy, *param, written->second);
  }
  return out;
}

void check_supported(const Energy& energy, const EnergyUse& use) {
  const Place& place = use.at("law");
  const bool density = energy.kind == Energy::Kind::density;
  if (density) return;
  if (energy.geometry != "point" && energy.geometry != "edge")
    throw SourceError(place, fmt::format("{} is an energy of a {}; an object carries densities and energies of points "
                                         "and edges",
                                         energy.name, energy.geometry));
  if (!energy.cases.empty() || !energy.active.empty())
    throw SourceError(place, fmt::format("{} acts only under its conditions (case, active), as contact does; an object "
                                         "carries energies that always act",
                                         energy.name));
  for (const Symbol* rest : energy.with_role(Role::rest)) {
    const bool mass = rest->name == "mass" && energy.geometry == "point" && rest->shape.scalar();
    if (!mass && !is_rest_position(energy, *rest))
      throw SourceError(place,
                        fmt::format("a scene cannot supply the rest data '{}' of {}: it knows rest positions (X0 "
                                    "for a dof x0) and the mass of a point",
                                    rest->name, energy.name));
  }
  for (const Symbol* lag : energy.with_role(Role::lag)) {
    const auto of_point = [&](const Symbol* dof) {
      return lag->name == dof->name + "hat" || lag->name == dof->name + "lag";
    };
    const std::vector<const Symbol*> dofs = energy.with_role(Role::dof);
    if (lag->name != "dt" && std::none_of(dofs.begin(), dofs.end(), of_point))
      throw SourceError(place, fmt::format("a scene does not renew the lag '{}' of {}: it knows dt, xhat and xlag",
                                           lag->name, energy.name));
  }
}

}  // namespace ergon
