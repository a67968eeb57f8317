#include "symbolic/state_text.h"

#include <fmt/format.h>

#include <stdexcept>

#include "symbolic/analyse.h"

namespace ergon {

std::string state_text(const Energy& energy, const ExactInputs& inputs) {
  std::string text;
  for (const Symbol& symbol : energy.symbols) {
    const auto found = inputs.find(symbol.name);
    if (found == inputs.end()) continue;
    std::vector<std::string> components;
    for (const cln::cl_RA& value : found->second)
      components.push_back(fmt::format("{:.12g}", cln::double_approx(value) + 0.0));
    text += fmt::format("{}--set {}={}", text.empty() ? "" : " ", symbol.name, fmt::join(components, ","));
  }
  return text;
}

std::string component_name(const Energy& energy, size_t index) {
  for (const Symbol* dof : energy.with_role(Role::dof)) {
    const auto size = static_cast<size_t>(dof->shape.size());
    if (index >= size) {
      index -= size;
      continue;
    }
    const size_t rows = static_cast<size_t>(dof->shape.rows);
    return dof->shape.cols == 1 ? fmt::format("{}[{}]", dof->name, index)
                                : fmt::format("{}[{},{}]", dof->name, index % rows, index / rows);
  }
  throw std::logic_error("a component beyond the dofs");
}

std::string derivative_unit(const Energy& energy, int order) {
  Unit unit = value_unit(energy);
  for (int i = 0; i < order; ++i) unit = unit / energy.with_role(Role::dof).front()->unit;
  return unit.dimensionless() ? "" : " " + to_string(unit);
}

}  // namespace ergon
