#include "symbolic/augmented.h"

#include <algorithm>
#include <stdexcept>

#include "symbolic/analyse.h"

namespace ergon {
namespace {

using Kind = Expression::Kind;

ExpressionPtr node_at(const Place& place, Kind kind, const std::string& text,
                      std::vector<ExpressionPtr> arguments = {}) {
  return std::make_shared<Expression>(Expression{kind, text, std::move(arguments), place, {}, {}});
}

}  // namespace

const Let* constraint_of(const Energy& energy) {
  const auto found = std::find_if(energy.lets.begin(), energy.lets.end(),
                                  [&](const Let& let) { return let.name == energy.constraint; });
  return found == energy.lets.end() ? nullptr : &*found;
}

Energy augmented(const Energy& energy) {
  const Let* constraint = constraint_of(energy);
  if (constraint == nullptr) throw std::invalid_argument(energy.name + " has no constraint");
  const std::string shift = "constraint_shift", hardening = "constraint_hardening";
  const Place place = constraint->place;
  const Expression& c = *constraint->expression;
  const auto name = [&](const std::string& text) { return node_at(place, Kind::name, text); };

  Energy out = energy;
  out.symbols.push_back({shift, Role::lag, c.shape, c.unit, {}, "by which the constraint is moved", place});
  out.symbols.push_back({hardening, Role::lag, {}, {}, {}, "by how much the energy is multiplied, less 1", place});
  Let& shifted = out.lets[static_cast<size_t>(constraint - energy.lets.data())];
  shifted.expression = node_at(place, Kind::add, "+", {constraint->expression, name(shift)});
  const ExpressionPtr factor = node_at(place, Kind::add, "+", {node_at(place, Kind::number, "1"), name(hardening)});
  out.value = node_at(energy.value->place, Kind::multiply, "*", {factor, energy.value});
  out.updates.push_back({shift, "", name(constraint->name), place});
  out.updates.push_back({hardening, "", name(hardening), place});
  analyse(out);
  return out;
}

}  // namespace ergon
