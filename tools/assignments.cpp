#include "tools/assignments.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include "runtime/error.h"
#include "scenes/values.h"

namespace ergon {
namespace {

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  for (size_t at = 0; at <= text.size();) {
    const size_t end = std::min(text.find(',', at), text.size());
    parts.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return parts;
}

double checked(const Symbol& symbol, const std::string& text) {
  const WrittenNumber q =
      read_quantity(toml::value<std::string>(text), symbol.name, "a number, with or without a unit", "--set");
  if (q.unit && *q.unit != symbol.unit) {
    throw InputError(fmt::format("--set: '{}' must be in {}, found '{}', which is in {}", symbol.name,
                                 to_string(symbol.unit), text, to_string(*q.unit)));
  }
  if (!symbol.range.contains(q.value)) {
    throw InputError(fmt::format("--set: '{}' must be in {}, found '{}'", symbol.name, range_in_unit(symbol), text));
  }
  return q.value;
}

}  // namespace

std::string range_in_unit(const Symbol& symbol) {
  return to_string(symbol.range) + (symbol.unit.dimensionless() ? "" : " " + to_string(symbol.unit));
}

std::map<std::string, std::vector<double>> read_assignments(const Energy& energy, const std::vector<std::string>& texts,
                                                            bool dofs) {
  std::vector<std::string> names;
  for (Role role : {Role::dof, Role::param, Role::rest, Role::lag}) {
    if (role == Role::dof && !dofs) continue;
    for (const Symbol* symbol : energy.with_role(role)) names.push_back(symbol->name);
  }
  std::map<std::string, std::vector<double>> values;
  for (const std::string& text : texts) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos) throw InputError(fmt::format("--set: '{}' is not NAME=VALUE", text));
    const std::string name = text.substr(0, equals);
    const Symbol* symbol = energy.find(name);
    if (symbol == nullptr || (symbol->role == Role::dof && !dofs)) {
      throw InputError(fmt::format("--set: {} has no input '{}' (its inputs: {}){}", energy.name, name,
                                   fmt::join(names, ", "), did_you_mean(name, names)));
    }
    if (values.contains(name)) throw InputError(fmt::format("--set: '{}' is given twice", name));
    const std::vector<std::string> parts = split(text.substr(equals + 1));
    if (parts.size() != static_cast<size_t>(symbol->shape.size())) {
      throw InputError(
          fmt::format("--set: '{}' is a {}, found {} numbers", name, to_string(symbol->shape), parts.size()));
    }
    for (const std::string& part : parts) values[name].push_back(checked(*symbol, part));
  }
  return values;
}

}  // namespace ergon
