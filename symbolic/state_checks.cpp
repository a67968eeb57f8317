// Checks at random states: defined, rigid motion, load, inversion.

#include <fmt/format.h>

#include <stdexcept>

#include "symbolic/blame.h"
#include "symbolic/elaborate.h"
#include "symbolic/exact_checks.h"
#include "symbolic/ginac_algebra.h"
#include "symbolic/jet.h"
#include "symbolic/limits.h"
#include "symbolic/print.h"
#include "symbolic/sample_states.h"
#include "symbolic/state_text.h"
#include "symbolic/stretches.h"
#include "symbolic/typing.h"

namespace ergon {
namespace {

constexpr int digits = 50;
constexpr double tolerance = 1e-38;

using ClnJet = Jet<ClnNumber>;

Elaborated<ClnJet> derivatives(const Energy& energy, const std::string& case_name, const ExactInputs& inputs) {
  ClnAlgebra numbers(inputs, digits_for_derivatives(energy, digits));
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

Finding no_state(const char* check) {
  return {Severity::warning, check, "not checked: no random state satisfies `active` and `require`", {}, ""};
}

// Every dof rotated, column by column; points are translated too.
ExactInputs moved(const Energy& energy, ExactInputs inputs, const std::vector<Rational>& rotation,
                  const std::vector<Rational>& translation) {
  for (const Symbol* dof : energy.with_role(Role::dof)) {
    if (is_twist(energy, *dof)) continue;
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
    const Elaborated<ClnJet> result = derivatives(energy, case_name, *state);
    if (defined(result.value)) continue;
    const Expression* part = first_undefined(energy, case_name, *state);
    const char* what = result.value.value.defined ? "its derivatives are" : "the value is";
    return Finding{Severity::error, "defined",
                   fmt::format("{} is not real and finite where all conditions hold, and with it {} not either; keep "
                               "away from there by a range or `require`",
                               part == nullptr ? "the value" : to_text(*part), what),
                   start_of(part == nullptr ? *energy.value : *part), state_text(energy, *state)};
  }
  return Finding{Severity::ok, "defined", "value and derivatives are finite at random states", {}, ""};
}

std::optional<Finding> check_rigid_motion(const Energy& energy, const std::string& case_name) {
  StateSampler sampler;
  double change = 0;
  bool exact = true;
  std::optional<std::pair<ExactInputs, ExactInputs>> worst;
  // A part of a sum may see a translation that the whole, such as a closed surface, does not.
  const bool translated = energy.kind != Energy::Kind::density && energy.part_of.empty();
  const std::vector<Rational> none(3, Rational(0));
  for (int i = 0; i < 3; ++i) {
    const auto state = sampler.admissible(energy, case_name);
    if (!state) return no_state("rigid motion");
    const auto rotation = sampler.rotation();
    const std::vector<Rational> translation = sampler.vector3();
    const ExactInputs other = moved(energy, *state, rotation, translated ? translation : none);
    if (exactly_equal(energy, case_name, *state, other)) continue;
    exact = false;
    const double found = relative_change(energy, case_name, *state, other);
    if (found >= 0 && found <= change) continue;
    change = found < 0 ? 1 : found;
    worst = {*state, other};
  }
  const bool invariant = change <= tolerance;
  const char* motion = translated ? "rotation and translation" : "rotation";
  if (invariant && energy.fixed_frame)
    return Finding{Severity::warning,
                   "rigid motion",
                   fmt::format("the value keeps under {}, yet the energy states `frame fixed`; remove it", motion),
                   {},
                   ""};
  if (invariant)
    return Finding{Severity::ok,
                   "rigid motion",
                   fmt::format("the value keeps under {} ({})", motion, exact ? "exactly" : "to 38 digits"),
                   {},
                   ""};
  if (energy.fixed_frame)
    return Finding{Severity::ok,
                   "rigid motion",
                   fmt::format("the value changes under {}, as `frame fixed` states", motion),
                   {},
                   ""};
  const auto& [before, after] = *worst;
  ClnAlgebra first(before, digits), second(after, digits);
  ExactInputs dofs;
  for (const Symbol* dof : energy.with_role(Role::dof)) dofs[dof->name] = after.at(dof->name);
  const Expression& part = first_change(energy, case_name, before, after);
  return Finding{
      Severity::error, "rigid motion",
      fmt::format(
          "the value changes under {}, from {:.6g} to {:.6g}{}, because {} does; state `frame fixed` if that is "
          "meant",
          motion, to_double(elaborate(energy, case_name, first).value),
          to_double(elaborate(energy, case_name, second).value), derivative_unit(energy, 0), to_text(part)),
      start_of(part), fmt::format("{} and {}", state_text(energy, before), state_text(energy, dofs))};
}

std::optional<Finding> check_load(const Energy& energy, const std::string& case_name) {
  if (energy.load.empty()) return std::nullopt;
  StateSampler sampler;
  for (int i = 0; i < 3; ++i) {
    const auto state = sampler.admissible(energy, case_name);
    if (!state) return no_state("load");
    ExactInputs half = *state;
    for (Rational& component : half.at(energy.load)) component = component / 2;
    ClnAlgebra of_whole(*state, digits), of_half(half, digits);
    const ClnNumber whole = elaborate(energy, case_name, of_whole).value;
    const ClnNumber part = elaborate(energy, case_name, of_half).value;
    const double off = cln::double_approx(cln::abs(whole.value - 2 * part.value) / (1 + cln::abs(whole.value)));
    if (part.defined && whole.defined && off <= tolerance) continue;
    return Finding{
        Severity::error, "load",
        fmt::format("the value is not in proportion to '{}': {:.4g} J where it is {:.4g} J for half of it; a "
                    "load grows by this param alone",
                    energy.load, to_double(whole), to_double(part)),
        start_of(*energy.value), state_text(energy, *state)};
  }
  return Finding{Severity::ok, "load", fmt::format("the value is in proportion to {}", energy.load), {}, ""};
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
    if (kept_away) continue;
    const Expression* part = first_undefined(energy, case_name, inputs);
    return Finding{Severity::warning, "inversion",
                   fmt::format("{} is not finite for det(F) < 0, and no `require` keeps away from there; add `require "
                               "det(F) > 0`",
                               to_text(*part)),
                   start_of(*part), state_text(energy, inputs)};
  }
  if (!finite)
    return Finding{Severity::ok, "inversion", "not finite at inversion; `require` keeps away from it", {}, ""};
  ExactInputs flat = sampler.any(energy);
  flat.at("F") = undeformed({3, 3});
  flat.at("F")[8] = Rational(0);
  ExactInputs mirrored = flat;
  mirrored.at("F")[8] = Rational(-1);
  const Limit limit = limit_at(energy, case_name, flat, true);
  if (limit.effect >= Effect::value_grows) {
    for (const ClnJet& margin : derivatives(energy, case_name, mirrored).require)
      if (!margin.value.defined || !cln::plusp(margin.value.value))
        return Finding{Severity::ok, "inversion", "infinite at collapse; `require` keeps away from inversion", {}, ""};
    const auto sites = vanishing_sites(energy, case_name, flat);
    const Expression& part = sites.empty() ? *energy.value : *sites.front().expression;
    return Finding{Severity::warning, "inversion",
                   fmt::format("{} is infinite at det(F) = 0 but finite on both sides of it, and no `require` keeps a "
                               "step from crossing; add `require det(F) > 0`",
                               to_text(part)),
                   start_of(part), state_text(energy, flat)};
  }
  ExactInputs rest = flat;
  rest.at("F")[8] = Rational(1);
  if (relative_change(energy, case_name, rest, mirrored) == 0)
    return Finding{Severity::note, "inversion",
                   "an inverted element has the energy of the undeformed one, so nothing turns it back",
                   start_of(*energy.value), state_text(energy, mirrored)};
  return Finding{Severity::ok, "inversion", "finite at inversion", {}, ""};
}

}  // namespace ergon
