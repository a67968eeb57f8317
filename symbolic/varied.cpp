#include "symbolic/varied.h"

#include <algorithm>
#include <stdexcept>

#include "symbolic/analyse.h"

namespace ergon {

Energy varied(const Energy& energy, const std::vector<std::string>& params) {
  Energy out = energy;
  for (const std::string& name : params) {
    const auto is_it = [&](const Symbol& symbol) { return symbol.name == name && symbol.role == Role::param; };
    const auto found = std::find_if(out.symbols.begin(), out.symbols.end(), is_it);
    if (found == out.symbols.end()) throw std::invalid_argument(energy.name + " has no param '" + name + "'");
    found->role = Role::rest;
  }
  return out;
}

Energy weighted(const Energy& energy) {
  using Kind = Expression::Kind;
  const std::string name = "weight";
  const auto has_name = [&](const auto& declared) { return declared.name == name; };
  if (energy.find(name) != nullptr || std::any_of(energy.lets.begin(), energy.lets.end(), has_name))
    throw std::invalid_argument(energy.name + " declares '" + name + "' itself");
  Energy out = energy;
  const Place place = energy.value->place;
  Range range;
  range.lower = 0;
  range.lower_open = false;
  out.symbols.push_back({name, Role::param, {}, {}, range, "what the energy is multiplied by", place});
  const auto factor = std::make_shared<Expression>(Expression{Kind::name, name, {}, place, {}, {}});
  out.value = std::make_shared<Expression>(Expression{Kind::multiply, "", {factor, energy.value}, place, {}, {}});
  analyse(out);
  return out;
}

}  // namespace ergon
