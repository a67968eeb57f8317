#include "tools/law_point.h"

#include <cln/dfloat.h>

#include <algorithm>
#include <cmath>

#include "symbolic/double_algebra.h"
#include "symbolic/elaborate.h"
#include "symbolic/jet.h"
#include "symbolic/sample_states.h"

namespace ergon {
namespace {

cln::cl_RA exact(double value) { return cln::rational(cln::cl_DF(value)); }

bool positive(const std::vector<Jet<double>>& margins) {
  return std::all_of(margins.begin(), margins.end(), [](const Jet<double>& margin) { return margin.value > 0; });
}

double usual_value(const Symbol& symbol) {
  const Range& range = symbol.range;
  const bool place = symbol.unit == parse_unit("m").unit, vector = !symbol.shape.scalar();
  const bool amount = symbol.unit == parse_unit("Pa").unit || symbol.unit == parse_unit("kg").unit;
  if (range == Range{} && (place || (!vector && !amount && !symbol.unit.dimensionless()))) return 0;
  if (symbol.name == "nu" && range.contains(0.3)) return 0.3;
  if (symbol.name == "K" && range.contains(100)) return 100;
  if (std::isfinite(range.lower) && std::isfinite(range.upper)) return (range.lower + range.upper) / 2;
  if (range.contains(1) && range.lower != 1) return 1;
  return std::isfinite(range.lower) ? range.lower + 1 : range.upper - 1;
}

// Filled in from the positions of a dof: "X0", "x0lag", "x0hat" of x0.
bool follows_a_dof(const Energy& energy, const Symbol& symbol) {
  if (symbol.role != Role::rest && symbol.role != Role::lag) return false;
  for (const Symbol* dof : energy.with_role(Role::dof))
    if (rest_position(energy, *dof) == &symbol || symbol.name == dof->name + "lag" || symbol.name == dof->name + "hat")
      return true;
  return false;
}

}  // namespace

LawPoint::LawPoint(const Energy& energy, std::string case_name, const std::map<std::string, std::vector<double>>& data)
    : energy_(&energy), case_name_(std::move(case_name)) {
  for (const auto& [name, values] : data)
    for (const double value : values) inputs_[name].push_back(exact(value));
  for (const Symbol* dof : energy.with_role(Role::dof)) dofs_ += dof->shape.size();
}

LawState LawPoint::evaluate(const Eigen::VectorXd& dofs, bool all) const {
  ExactInputs inputs = inputs_;
  Eigen::Index next = 0;
  for (const Symbol* dof : energy_->with_role(Role::dof)) {
    auto& components = inputs[dof->name];
    components.clear();
    for (int i = 0; i < dof->shape.size(); ++i) components.push_back(exact(dofs[next++]));
  }
  DoubleAlgebra numbers(inputs);
  using Jets = JetAlgebra<DoubleAlgebra>;
  Jets jets(*energy_, numbers, Jets::Order::second, all ? Jets::Variables::all : Jets::Variables::dofs);
  const auto result = elaborate(*energy_, case_name_, jets);

  const Eigen::Index n = jets.variables();
  LawState state;
  state.value = result.value.value;
  state.gradient = Eigen::VectorXd::Zero(n);
  state.hessian = Eigen::MatrixXd::Zero(n, n);
  if (!result.value.gradient.empty())
    state.gradient = Eigen::Map<const Eigen::VectorXd>(result.value.gradient.data(), n);
  for (Eigen::Index i = 0, k = 0; i < n && !result.value.hessian.empty(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j, ++k)
      state.hessian(i, j) = state.hessian(j, i) = result.value.hessian[static_cast<size_t>(k)];
  state.active = positive(result.active);
  state.defined =
      positive(result.require) && std::isfinite(state.value) && state.gradient.allFinite() && state.hessian.allFinite();
  return state;
}

std::map<std::string, std::vector<double>> usual_data(const Energy& energy,
                                                      const std::map<std::string, std::vector<double>>& given) {
  std::map<std::string, std::vector<double>> data = given;
  for (const Symbol& symbol : energy.symbols) {
    const bool density = energy.kind == Energy::Kind::density;
    if (symbol.role == Role::dof || data.contains(symbol.name)) continue;
    if (!density && follows_a_dof(energy, symbol)) continue;
    std::vector<double> values(static_cast<size_t>(symbol.shape.size()), 0.0);
    if (density && symbol.name == "Flag")
      for (size_t i = 0; i < values.size(); i += 4) values[i] = 1;  // a step that begins undeformed
    else if (twists_of_stencil(energy.geometry) > 0 && (symbol.name == "T0" || symbol.name == "T1"))
      values[1] = 1;  // edges along y, as in tools/stencil_path.cpp
    else if (!energy.renews(symbol.name))
      values[0] = usual_value(symbol);
    data[symbol.name] = values;
  }
  return data;
}

}  // namespace ergon
