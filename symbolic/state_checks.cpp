// Checks at random states: defined, rigid motion, inversion.

#include <fmt/format.h>

#include <stdexcept>

#include "symbolic/elaborate.h"
#include "symbolic/exact_checks.h"
#include "symbolic/ginac_algebra.h"
#include "symbolic/jet.h"
#include "symbolic/sample_states.h"

namespace ergon {
namespace {

constexpr int digits = 50;
constexpr double tolerance = 1e-38;

using ClnJet = Jet<ClnNumber>;

Elaborated<ClnJet> derivatives(const Energy& energy, const std::string& case_name, const ExactInputs& inputs) {
  ClnAlgebra numbers(inputs, digits);
  JetAlgebra<ClnAlgebra> jets(energy, numbers);
  return elaborate(energy, case_name, jets);
}

bool defined(const ClnJet& jet) {
  for (const ClnNumber& g : jet.gradient)
    if (!g.defined) return false;
  for (const ClnNumber& h : jet.hessian)
    if (!h.defined) return false;
  return jet.value.defined;
}

std::string state_text(const Energy& energy, const ExactInputs& inputs) {
  std::string text;
  for (const Symbol& symbol : energy.symbols) {
    std::vector<std::string> components;
    for (const Rational& value : inputs.at(symbol.name))
      components.push_back(fmt::format("{:.4g}", cln::double_approx(value)));
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", symbol.name,
                        components.size() == 1 ? components[0] : fmt::format("[{}]", fmt::join(components, ", ")));
  }
  return text;
}

Finding no_state(const char* check) {
  return {Severity::warning, check, "not checked: no random state satisfies `active` and `require`"};
}

// Every dof rotated, column by column; points are translated too.
ExactInputs moved(const Energy& energy, ExactInputs inputs, const std::vector<Rational>& rotation,
                  const std::vector<Rational>& translation) {
  for (const Symbol* dof : energy.with_role(Role::dof)) {
    std::vector<Rational>& x = inputs.at(dof->name);
    for (size_t first = 0; first < x.size(); first += 3) {
      std::vector<Rational> y(3, Rational(0));
      for (size_t i = 0; i < 3; ++i) {
        for (size_t k = 0; k < 3; ++k) y[i] = y[i] + rotation[3 * k + i] * x[first + k];
        if (energy.kind == Energy::Kind::stencil) y[i] = y[i] + translation[i];
      }
      for (size_t i = 0; i < 3; ++i) x[first + i] = y[i];
    }
  }
  return inputs;
}

// Whether two values are the same expression; numbers that GiNaC cannot compare are left to the floats.
bool exactly_equal(const Energy& energy, const std::string& case_name, const ExactInputs& a, const ExactInputs& b) {
  try {
    GinacAlgebra first(a), second(b);
    return (elaborate(energy, case_name, first).value - elaborate(energy, case_name, second).value).expand().is_zero();
  } catch (const std::exception&) {
    return false;
  }
}

// |value(a) - value(b)| relative to the values, or a negative number when one is not defined.
double relative_change(const Energy& energy, const std::string& case_name, const ExactInputs& a, const ExactInputs& b) {
  ClnAlgebra first(a, digits), second(b, digits);
  const ClnNumber x = elaborate(energy, case_name, first).value;
  const ClnNumber y = elaborate(energy, case_name, second).value;
  if (!x.defined || !y.defined) return -1;
  return cln::double_approx(cln::abs(x.value - y.value) / (1 + cln::abs(x.value)));
}

}  // namespace

std::optional<Finding> check_defined(const Energy& energy, const std::string& case_name) {
  StateSampler sampler;
  for (int i = 0; i < 6; ++i) {
    const auto state = sampler.admissible(energy, case_name);
    if (!state) return no_state("defined");
    if (!defined(derivatives(energy, case_name, *state).value))
      return Finding{Severity::error, "defined",
                     fmt::format("value or derivatives are not finite where all conditions hold, at {}",
                                 state_text(energy, *state))};
  }
  return Finding{Severity::ok, "defined", "value and derivatives are finite at random states"};
}

std::optional<Finding> check_rigid_motion(const Energy& energy, const std::string& case_name) {
  StateSampler sampler;
  double change = 0;
  bool exact = true;
  for (int i = 0; i < 3; ++i) {
    const auto state = sampler.admissible(energy, case_name);
    if (!state) return no_state("rigid motion");
    const auto rotation = sampler.rotation();
    const ExactInputs other = moved(energy, *state, rotation, sampler.vector3());
    if (exactly_equal(energy, case_name, *state, other)) continue;
    exact = false;
    const double found = relative_change(energy, case_name, *state, other);
    change = found < 0 ? 1 : std::max(change, found);
  }
  const bool invariant = change <= tolerance;
  const char* motion = energy.kind == Energy::Kind::density ? "rotation" : "rotation and translation";
  if (invariant && energy.fixed_frame)
    return Finding{Severity::warning, "rigid motion",
                   fmt::format("the value keeps under {}, yet the energy states `frame fixed`; remove it", motion)};
  if (invariant)
    return Finding{Severity::ok, "rigid motion",
                   fmt::format("the value keeps under {} ({})", motion, exact ? "exactly" : "to 38 digits")};
  if (energy.fixed_frame)
    return Finding{Severity::ok, "rigid motion",
                   fmt::format("the value changes under {}, as `frame fixed` states", motion)};
  return Finding{Severity::error, "rigid motion",
                 fmt::format("the value changes under {} (by {:.2g} of itself); state `frame fixed` if that is meant",
                             motion, change)};
}

std::optional<Finding> check_inversion(const Energy& energy, const std::string& case_name) {
  if (energy.kind != Energy::Kind::density || energy.geometry != "solid") return std::nullopt;
  StateSampler sampler;
  bool finite = true;
  for (int i = 0; i < 6; ++i) {
    ExactInputs inputs = sampler.any(energy);
    std::vector<Rational>& F = inputs.at("F");
    if (cln::zerop(determinant(F))) continue;
    if (cln::plusp(determinant(F)))
      for (size_t k = 0; k < 3; ++k) F[k] = -F[k];
    const Elaborated<ClnJet> result = derivatives(energy, case_name, inputs);
    if (defined(result.value)) continue;
    finite = false;
    bool kept_away = false;
    for (const ClnJet& margin : result.require)
      kept_away = kept_away || !margin.value.defined || !cln::plusp(margin.value.value);
    if (!kept_away)
      return Finding{Severity::warning, "inversion",
                     "not finite for det(F) < 0, and no `require` keeps away from there; add `require det(F) > 0`"};
  }
  return Finding{Severity::ok, "inversion",
                 finite ? "finite at inversion" : "not finite at inversion; `require` keeps away from it"};
}

}  // namespace ergon
