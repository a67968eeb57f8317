#include "scenes/laws.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "symbolic/augmented.h"
#include "symbolic/varied.h"

namespace ergon {
namespace {

std::string list_of(const std::vector<std::string>& names) {
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

std::string in_unit(const Symbol& param) {
  std::string unit = to_string(param.unit);
  return unit == "1" ? "" : " " + unit;
}

[[noreturn]] void refuse_value(const Energy& energy, const Symbol& param, const std::string& found,
                               const Place& place) {
  throw SourceError(place, fmt::format("'{}' of {} must be in {}{}, found {} (declared in {})", param.name, energy.name,
                                       to_string(param.range), in_unit(param), found, to_string(param.place)));
}

bool is_thickness(const Symbol& param) {
  return param.name == "h" && param.shape.scalar() && to_string(param.unit) == "m";
}

}  // namespace

const Energy& Laws::get(const std::string& law, const Place& place) {
  auto found = read_.find(law);
  if (found == read_.end()) found = read_.emplace(law, catalogue_->read_complete(law, scene_folder_, place)).first;
  return found->second;
}

const Energy& Laws::get(const EnergyUse& use) {
  const Energy* energy = &read(use);
  const auto has_name = [](const auto& declared) { return declared.name == "weight"; };
  if (use.params.contains("weight") && energy->find("weight") == nullptr &&
      std::none_of(energy->lets.begin(), energy->lets.end(), has_name))
    energy = &make(*energy, "*", weighted);
  if (!use.constraint_tolerance) return *energy;
  if (energy->constraint.empty())
    throw SourceError(
        use.at("constraint_tolerance"),
        fmt::format("{} has no constraint; a law says by `constraint c = EXPRESSION` what its value draws "
                    "to 0",
                    energy->name));
  return make(*energy, "0", augmented);
}

const Energy& Laws::make(const Energy& energy, const std::string& key, Energy (*made_of)(const Energy&)) {
  const std::pair full(&energy, std::vector<std::string>{key});
  auto found = made_.find(full);
  if (found == made_.end()) found = made_.emplace(full, made_of(energy)).first;
  return found->second;
}

const Energy& Laws::vary(const Energy& energy, const std::vector<std::string>& params) {
  if (params.empty()) return energy;
  const std::pair key(&energy, params);
  auto found = made_.find(key);
  if (found == made_.end()) found = made_.emplace(key, varied(energy, params)).first;
  return found->second;
}

const Energy& Laws::read(const EnergyUse& use) {
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
      refuse_value(energy, param, q.text + (q.unit ? "" : in_unit(param)), written.place);
    out.push_back(q.value);
  }
  return out;
}

void check_range(const Energy& energy, const Symbol& param, double value, const Place& place,
                 const std::string& where) {
  if (!param.range.contains(value) || !std::isfinite(value))
    refuse_value(energy, param, fmt::format("{}{}{}", value, in_unit(param), where), place);
}

std::optional<double> constraint_tolerance(const Energy& energy, const EnergyUse& use) {
  if (!use.constraint_tolerance) return std::nullopt;
  const Let& constraint = *constraint_of(energy);
  Symbol tolerance{"constraint_tolerance", Role::param, {}, constraint.expression->unit, {}, "", constraint.place};
  tolerance.range.lower = 0;
  return checked_values(energy, tolerance, *use.constraint_tolerance)[0];
}

Parameters checked_params(const Energy& energy, const EnergyUse& use, double thickness) {
  std::vector<std::string> names;
  for (const Symbol* param : energy.with_role(Role::param)) names.push_back(param->name);
  for (const auto& [name, written] : use.params)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw SourceError(written.key_place, fmt::format("{} has no param '{}' (its params: {}){}", energy.name, name,
                                                       list_of(names), did_you_mean(name, names)));
  Parameters out;
  for (const Symbol* param : energy.with_role(Role::param)) {
    auto written = use.params.find(param->name);
    if (written == use.params.end() && thickness > 0 && is_thickness(*param)) {
      out[param->name] = {thickness};
      continue;
    }
    if (written == use.params.end())
      throw SourceError(use.place, fmt::format("{} needs the param '{}': {}, in {}{}", energy.name, param->name,
                                               param->help.empty() ? "a " + to_string(param->shape) : param->help,
                                               to_string(param->range), in_unit(*param)));
    if (!written->second.field) out[param->name] = checked_values(energy, *param, written->second);
  }
  return out;
}

}  // namespace ergon
