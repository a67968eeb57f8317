#include "symbolic/critical_states.h"

#include <cln/dfloat.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "symbolic/double_algebra.h"
#include "symbolic/sliced.h"
#include "symbolic/stretches.h"

namespace ergon {
namespace {

constexpr double margin_tolerance = 1e-9;  // states are of the order of 1

Rational rational_of(double x) { return cln::rational(cln::cl_DF(x)); }
Rational rational_of(const ClnNumber& x) { return cln::rational(x.value); }
double size_of(double x) { return std::fabs(x); }
double size_of(const ClnNumber& x) { return std::fabs(to_double(x)); }

template <class B>
struct Traced {
  std::vector<typename CriticalAlgebra<B>::Record> sites;
  Elaborated<typename CriticalAlgebra<B>::Scalar> result;
};

template <class B>
Traced<B> trace(const Energy& energy, const std::string& case_name, B& numbers,
                typename CriticalAlgebra<B>::Variables variables = CriticalAlgebra<B>::Variables::all) {
  CriticalAlgebra<B> algebra(energy, numbers, variables);
  auto result = elaborate(energy, case_name, algebra);
  return {algebra.records(), std::move(result)};
}

template <class B>
const typename CriticalAlgebra<B>::Scalar* quantity(const Traced<B>& traced, const CriticalTarget& target) {
  if (target.kind == CriticalTarget::Kind::active) return &traced.result.active[target.condition];
  if (target.kind == CriticalTarget::Kind::require) return &traced.result.require[target.condition];
  for (const auto& [site, value] : traced.sites)
    if (site == target.site) return &value;
  return nullptr;
}

template <class S>
bool depends_on_dofs(const Energy& energy, const Jet<S>& jet) {
  size_t k = 0;
  for (const Symbol& symbol : energy.symbols)
    for (int i = 0; i < symbol.shape.size(); ++i, ++k)
      if (symbol.role == Role::dof && k < jet.gradient.size() && size_of(jet.gradient[k]) != 0) return true;
  return false;
}

// One step of Newton's method for a zero of that multiplicity along the gradient; false when there is no way on.
template <class B>
bool step(const Energy& energy, const Jet<typename B::Scalar>& jet, int multiplicity, bool dofs, B& numbers,
          ExactInputs& inputs) {
  using S = typename B::Scalar;
  if (jet.gradient.empty()) return false;
  S squared = numbers.number("0");
  size_t k = 0;
  for (const Symbol& symbol : energy.symbols)
    for (int i = 0; i < symbol.shape.size(); ++i, ++k)
      if ((symbol.role == Role::dof) == dofs)
        squared = numbers.add(squared, numbers.multiply(jet.gradient[k], jet.gradient[k]));
  if (!(size_of(squared) > 0) || !std::isfinite(size_of(squared))) return false;
  const S scaled = numbers.multiply(numbers.number(std::to_string(multiplicity)), numbers.divide(jet.value, squared));
  ExactInputs moved = inputs;
  k = 0;
  for (const Symbol& symbol : energy.symbols) {
    for (int i = 0; i < symbol.shape.size(); ++i, ++k) {
      if ((symbol.role == Role::dof) != dofs) continue;
      const S change = numbers.multiply(scaled, jet.gradient[k]);
      const S next = numbers.subtract(numbers.input(symbol, i), change);
      if (!(size_of(next) < 1e6)) return false;
      moved.at(symbol.name)[static_cast<size_t>(i)] = rational_of(next);
    }
  }
  inputs = std::move(moved);
  return true;
}

template <class B>
bool newton(const Energy& energy, const std::string& case_name, const CriticalTarget& target, int multiplicity,
            bool dofs, int iterations, double tolerance, const std::function<B(const ExactInputs&)>& numbers_at,
            ExactInputs& inputs) {
  double last = INFINITY;
  for (int i = 0; i <= iterations; ++i) {
    B numbers = numbers_at(inputs);
    const auto traced = trace(energy, case_name, numbers);
    const auto* jet = quantity(traced, target);
    const double size = jet == nullptr ? NAN : size_of(jet->value);
    if (!(size < 4 * last)) return false;  // not defined, or going away
    if (size < tolerance) return true;
    last = size;
    if (!step(energy, *jet, multiplicity, dofs, numbers, inputs)) return false;
  }
  return false;
}

// What the quantity depends on, in which it stands alone: to see it again and again costs no more than itself.
std::pair<Energy, CriticalTarget> alone(const Energy& energy, const CriticalTarget& target) {
  if (target.kind == CriticalTarget::Kind::site)
    return {sliced(energy, find_expression(energy, target.site.expression)), target};
  const bool active = target.kind == CriticalTarget::Kind::active;
  const Condition& condition = (active ? energy.active : energy.require)[target.condition];
  const auto both = std::make_shared<Expression>(
      Expression{Expression::Kind::subtract, "", {condition.right, condition.left}, condition.place, {}, {}});
  Energy margin = sliced(energy, both);
  (active ? margin.active : margin.require).push_back(condition);
  return {std::move(margin), CriticalTarget{target.kind, {}, 0}};
}

bool within_ranges(const Energy& energy, const ExactInputs& inputs) {
  for (const Symbol& symbol : energy.symbols) {
    if (symbol.role == Role::dof) continue;
    for (const Rational& value : inputs.at(symbol.name))
      if (!symbol.range.contains(cln::double_approx(value))) return false;
  }
  return true;
}

bool all_positive(const std::vector<ClnNumber>& margins, size_t except) {
  for (size_t i = 0; i < margins.size(); ++i)
    if (i != except && !(to_double(margins[i]) > margin_tolerance)) return false;
  return true;
}

}  // namespace

std::vector<std::pair<CriticalSite, bool>> critical_sites(const Energy& energy, const std::string& case_name,
                                                          const ExactInputs& at) {
  DoubleAlgebra numbers(at);
  std::vector<std::pair<CriticalSite, bool>> sites;
  for (const auto& [site, jet] : trace(energy, case_name, numbers).sites)
    if (!jet.gradient.empty()) sites.emplace_back(site, depends_on_dofs(energy, jet));
  return sites;
}

bool clearly_admissible(const Energy& energy, const std::string& case_name, const ExactInputs& inputs,
                        const CriticalTarget* except) {
  if (!within_ranges(energy, inputs)) return false;
  ClnAlgebra numbers(inputs, critical_digits);
  const Elaborated<ClnNumber> result = elaborate(energy, case_name, numbers);
  const size_t none = static_cast<size_t>(-1);
  const bool active = except != nullptr && except->kind == CriticalTarget::Kind::active;
  const bool require = except != nullptr && except->kind == CriticalTarget::Kind::require;
  return all_positive(result.active, active ? except->condition : none) &&
         all_positive(result.require, require ? except->condition : none);
}

std::optional<CriticalState> solve_critical(const Energy& energy, const std::string& case_name,
                                            const CriticalTarget& target, const ExactInputs& start) {
  const auto [part, part_target] = alone(energy, target);
  DoubleAlgebra first(start);
  const auto traced = trace(part, case_name, first);
  const auto* jet = quantity(traced, part_target);
  if (jet == nullptr || jet->gradient.empty()) return std::nullopt;
  const bool dofs = depends_on_dofs(part, *jet);
  for (const int multiplicity : {1, 2}) {
    ExactInputs inputs = start;
    auto doubles = [](const ExactInputs& at) { return DoubleAlgebra(at); };
    auto floats = [&](const ExactInputs& at) {
      return ClnAlgebra(at, digits_for_derivatives(energy, critical_digits));
    };
    if (!newton<DoubleAlgebra>(part, case_name, part_target, multiplicity, dofs, 20, 1e-13, doubles, inputs)) continue;
    if (!within_ranges(energy, inputs)) continue;
    if (!newton<ClnAlgebra>(part, case_name, part_target, multiplicity, dofs, 9, 1e-68, floats, inputs)) continue;
    const bool margin = target.kind != CriticalTarget::Kind::site;
    if (clearly_admissible(energy, case_name, inputs, margin ? &target : nullptr)) return CriticalState{inputs, dofs};
  }
  return std::nullopt;
}

std::pair<bool, bool> signs_about(const Energy& energy, const std::string& case_name, const CriticalSite& site,
                                  const ExactInputs& inputs, bool dofs) {
  StateSampler sampler;
  std::pair<bool, bool> signs{false, false};
  const auto [part, target] = alone(energy, {CriticalTarget::Kind::site, site, 0});
  for (int i = 0; i < 8; ++i) {
    ExactInputs moved = inputs;
    for (const Symbol& symbol : energy.symbols)
      for (Rational& x : moved.at(symbol.name))
        if ((symbol.role == Role::dof) == dofs) x = x + sampler.fraction(16, 16) / 1000000;
    DoubleAlgebra numbers(moved);
    const auto traced = trace(part, case_name, numbers, CriticalAlgebra<DoubleAlgebra>::Variables::none);
    const auto* jet = quantity(traced, target);
    if (jet == nullptr) continue;
    signs.first = signs.first || jet->value > 0;
    signs.second = signs.second || jet->value < 0;
  }
  return signs;
}

std::vector<CriticalSite> vanishing_sites(const Energy& energy, const std::string& case_name,
                                          const ExactInputs& inputs) {
  ClnAlgebra numbers(inputs, digits_for_derivatives(energy, critical_digits));
  std::vector<CriticalSite> found;
  for (const auto& [site, jet] : trace(energy, case_name, numbers, CriticalAlgebra<ClnAlgebra>::Variables::none).sites)
    if (jet.value.defined && size_of(jet.value) < 1e-60) found.push_back(site);
  return found;
}

}  // namespace ergon
