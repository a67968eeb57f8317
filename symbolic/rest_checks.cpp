// Checks of the undeformed state: rest, moduli, stable at rest.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "symbolic/blame.h"
#include "symbolic/eigenvalues.h"
#include "symbolic/elaborate.h"
#include "symbolic/exact_checks.h"
#include "symbolic/ginac_algebra.h"
#include "symbolic/jet.h"
#include "symbolic/natural.h"
#include "symbolic/print.h"
#include "symbolic/sample_states.h"
#include "symbolic/state_text.h"
#include "symbolic/stretches.h"
#include "symbolic/typing.h"

namespace ergon {
namespace {

using GiNaC::ex;

constexpr int digits = 50;
constexpr double tolerance = 1e-38;

bool has_moduli(const Energy& energy) {
  const Symbol* E = energy.find("E");
  const Symbol* nu = energy.find("nu");
  return energy.kind == Energy::Kind::density && energy.geometry == "solid" && E && nu && E->role == Role::param &&
         nu->role == Role::param && E->shape.scalar() && nu->shape.scalar();
}

// An energy that acts only where its `active` conditions hold is no spring around the rest positions.
bool has_rest_state(const Energy& energy) {
  if (energy.kind == Energy::Kind::density) return true;
  if (!energy.active.empty()) return false;
  const auto dofs = energy.with_role(Role::dof);
  return std::all_of(dofs.begin(), dofs.end(),
                     [&](const Symbol* dof) { return is_twist(energy, *dof) || rest_position(energy, *dof); });
}

// Where points were when the step began is there too: nothing moves. What an energy renews itself is as it starts.
void put_at_rest(const Energy& energy, ExactInputs& inputs) {
  for (const Symbol* dof : energy.with_role(Role::dof)) {
    inputs[dof->name] = energy.kind == Energy::Kind::density ? undeformed(dof->shape)
                        : is_twist(energy, *dof)             ? std::vector<Rational>(3, Rational(0))
                                                             : inputs.at(rest_position(energy, *dof)->name);
    const Symbol* before = energy.find(dof->name + "lag");
    if (before != nullptr && before->shape == dof->shape) inputs[before->name] = inputs[dof->name];
  }
  for (const Let& update : energy.updates)
    inputs[update.name].assign(static_cast<size_t>(energy.find(update.name)->shape.size()), Rational(0));
}

// A random undeformed state whose `require` conditions hold (`active` is for the list of stencils to see to).
std::optional<ExactInputs> rest_state(const Energy& energy, const std::string& case_name, StateSampler& sampler) {
  for (int attempt = 0; attempt < 300; ++attempt) {
    ExactInputs inputs = sampler.any(energy);
    put_at_rest(energy, inputs);
    ClnAlgebra numbers(inputs, digits);
    const Elaborated<ClnNumber> result = elaborate(energy, case_name, numbers);
    if (std::all_of(result.require.begin(), result.require.end(),
                    [](const ClnNumber& margin) { return margin.defined && cln::plusp(margin.value); }))
      return inputs;
  }
  return std::nullopt;
}

template <class B>
Jet<typename B::Scalar> derivatives(const Energy& energy, const std::string& case_name, B numbers) {
  JetAlgebra<B> jets(energy, numbers);
  return elaborate(energy, case_name, jets).value;
}

ClnAlgebra numbers_at(const Energy& energy, const ExactInputs& state) {
  return ClnAlgebra(state, digits_for_derivatives(energy, digits));
}

// Zero as an expression, whatever the values of the symbols in it.
bool exactly_zero(const std::vector<ex>& entries) {
  return std::all_of(entries.begin(), entries.end(), [](const ex& e) { return e.is_zero() || e.normal().is_zero(); });
}

struct Largest {
  double size = 0;  // not a number when an entry is not defined
  size_t index = 0;
};

Largest largest(const std::vector<ClnNumber>& entries) {
  Largest result;
  for (size_t i = 0; i < entries.size(); ++i) {
    const double size = std::fabs(to_double(entries[i]));
    if (std::isnan(size)) return {size, i};
    if (size > result.size) result = {size, i};
  }
  return result;
}

const char* where(const Energy& energy) {
  if (energy.kind != Energy::Kind::density) return "at the rest positions";
  return energy.natural ? "at F = `natural`" : "at F = I";
}

// As `ergon eval` takes it.
std::string told(const Energy& energy, const std::string& case_name, const ExactInputs& state) {
  return state_text(energy, seen_from_rest(energy, case_name, state));
}

// The gradient at rest as expressions in the parameters; for stencils at random rest positions.
bool gradient_vanishes_exactly(const Energy& energy, const std::string& case_name, const ExactInputs& state) {
  try {
    ExactInputs values = state;
    if (energy.kind == Energy::Kind::density) values = {{"F", state.at("F")}};
    for (const Symbol* lag : energy.with_role(Role::lag))
      if (lag->name == "Flag" || energy.renews(lag->name)) values[lag->name] = state.at(lag->name);
    GinacAlgebra numbers(values);
    JetAlgebra<GinacAlgebra> jets(energy, numbers, JetAlgebra<GinacAlgebra>::Order::first);
    return exactly_zero(elaborate(energy, case_name, jets).value.gradient);
  } catch (const std::exception&) {
    return false;
  }
}

// Entry (i, j) of the Hessian of mu |sym(dF)|^2 + la/2 tr(dF)^2 over the components of F.
template <class S>
S isotropic_entry(size_t i, size_t j, const S& la, const S& mu) {
  const size_t a = i % 3, b = i / 3, c = j % 3, d = j / 3;
  S entry = S(0);
  if (a == b && c == d) entry = entry + la;
  if (a == c && b == d) entry = entry + mu;
  if (a == d && b == c) entry = entry + mu;
  return entry;
}

bool moduli_match_exactly(const Energy& energy, const std::string& case_name) {
  try {
    GinacAlgebra numbers(ExactInputs{{"F", undeformed({3, 3})}});
    JetAlgebra<GinacAlgebra> jets(energy, numbers);
    const Jet<ex> jet = elaborate(energy, case_name, jets).value;
    if (jet.hessian.empty()) return false;
    const ex E = numbers.symbols().at("E").at(0), nu = numbers.symbols().at("nu").at(0);
    const ex mu = E / (2 * (1 + nu)), la = E * nu / ((1 + nu) * (1 - 2 * nu));
    for (size_t i = 0, k = 0; i < 9; ++i)
      for (size_t j = 0; j <= i; ++j, ++k)
        if (!(jet.hessian[k] - isotropic_entry<ex>(i, j, la, mu)).normal().is_zero()) return false;
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

double hessian_entry(const Jet<ClnNumber>& jet, size_t i, size_t j) {
  if (jet.hessian.empty()) return 0;
  return to_double(jet.hessian[std::max(i, j) * (std::max(i, j) + 1) / 2 + std::min(i, j)]);
}

// Strains of the undeformed state: for a density symmetric in the directions of its columns, for a stencil all.
std::vector<std::vector<double>> strains(const Energy& energy) {
  std::vector<std::vector<double>> basis;
  if (energy.kind == Energy::Kind::density) {
    const Shape shape = energy.symbols[0].shape;
    for (int i = 0; i < shape.cols; ++i) {
      for (int j = 0; j <= i; ++j) {
        std::vector<double> strain(static_cast<size_t>(shape.size()), 0.0);
        strain[static_cast<size_t>(i * 3 + j)] = strain[static_cast<size_t>(j * 3 + i)] = i == j ? 1 : std::sqrt(0.5);
        basis.push_back(strain);
      }
    }
    return basis;
  }
  const size_t n = 3 * energy.with_role(Role::dof).size();
  for (size_t i = 0; i < n; ++i) {
    basis.emplace_back(n, 0.0);
    basis.back()[i] = 1;
  }
  return basis;
}

// "mu/2*(tr(F'*F) - 3) gives 4, la/2*(det(F) - 1)^2 gives 0": where the value is a sum.
std::string terms_text(const std::vector<ValueTerm>& terms) {
  std::vector<std::string> texts;
  for (const ValueTerm& term : terms)
    texts.push_back(fmt::format("{} gives {:.4g}", to_text(*term.expression), term.derivative + 0.0));
  return texts.size() < 2 ? "" : fmt::format(" ({})", fmt::join(texts, ", "));
}

// Young's modulus and Poisson's ratio that a stiffness at F = I has, where it is isotropic.
std::string moduli_text(const Jet<ClnNumber>& jet) {
  const double mu = hessian_entry(jet, 1, 1), la = hessian_entry(jet, 0, 4);
  for (size_t i = 0; i < 9; ++i)
    for (size_t j = 0; j <= i; ++j)
      if (!(std::fabs(hessian_entry(jet, i, j) - isotropic_entry<double>(i, j, la, mu)) < 1e-12)) return "";
  if (!(std::fabs(la + mu) > 1e-12)) return "";
  return fmt::format("; these are the moduli E = {:.4g} Pa and nu = {:.4g}", mu * (3 * la + 2 * mu) / (la + mu),
                     la / (2 * (la + mu)) + 0.0);
}

}  // namespace

std::optional<Finding> check_rest(const Energy& energy, const std::string& case_name) {
  if (!has_rest_state(energy)) return std::nullopt;
  if (!energy.part_of.empty())
    return Finding{Severity::ok, "rest", "left to the whole: part " + energy.part_of, {}, ""};
  const bool density = energy.kind == Energy::Kind::density;
  const char* stress = density ? "stress" : "force";
  StateSampler sampler;
  bool exact = true;
  for (int i = 0; i < 3; ++i) {
    const auto state = rest_state(energy, case_name, sampler);
    if (!state)
      return Finding{
          Severity::warning, "rest", fmt::format("not checked: `require` does not hold {}", where(energy)), {}, ""};
    const auto jet = derivatives(energy, case_name, numbers_at(energy, *state));
    const Largest found = largest(jet.gradient);
    if (found.size <= tolerance && gradient_vanishes_exactly(energy, case_name, *state)) {
      if (density) break;  // it holds for all parameters
      continue;
    }
    exact = false;
    if (found.size <= tolerance) continue;
    if (std::isnan(found.size)) {
      const Expression& part = *first_undefined(energy, case_name, *state);
      return Finding{Severity::error, "rest",
                     fmt::format("the {} is not finite {}, because {} or its derivatives are not; write it without a "
                                 "root or quotient that is 0 there",
                                 stress, where(energy), to_text(part)),
                     start_of(part), told(energy, case_name, *state)};
    }
    const auto terms = terms_at(energy, case_name, *state, found.index);
    const auto most = std::max_element(terms.begin(), terms.end(), [](const auto& a, const auto& b) {
      return std::fabs(a.derivative) < std::fabs(b.derivative);
    });
    return Finding{density && !has_moduli(energy) ? Severity::warning : Severity::error, "rest",
                   fmt::format("not {}-free {}: the derivative by {} is {:.4g}{}, expected 0{}", stress, where(energy),
                               component_name(energy, found.index), to_double(jet.gradient[found.index]),
                               derivative_unit(energy, 1), terms_text(terms)),
                   start_of(*most->expression), told(energy, case_name, *state)};
  }
  return Finding{Severity::ok,
                 "rest",
                 fmt::format("{}-free {} ({})", stress, where(energy), exact ? "exactly" : "to 38 digits"),
                 {},
                 ""};
}

std::optional<Finding> check_moduli(const Energy& energy, const std::string& case_name) {
  if (!has_moduli(energy) || !energy.part_of.empty()) return std::nullopt;
  const Finding good{
      Severity::ok, "moduli", fmt::format("the linearisation {} has the moduli E and nu", where(energy)), {}, ""};
  if (moduli_match_exactly(energy, case_name)) {
    Finding finding = good;
    finding.message += " (exactly)";
    return finding;
  }
  StateSampler sampler;
  auto state = rest_state(energy, case_name, sampler);
  if (!state)
    return Finding{
        Severity::warning, "moduli", fmt::format("not checked: `require` does not hold {}", where(energy)), {}, ""};
  state->at("E") = {Rational(1)};
  state->at("nu") = {Rational(1) / 4};
  const auto jet = derivatives(energy, case_name, numbers_at(energy, *state));
  if (!jet.value.defined) return std::nullopt;  // check_rest tells
  for (size_t i = 0; i < 9; ++i) {
    for (size_t j = 0; j <= i; ++j) {
      const double found = hessian_entry(jet, i, j);
      const double expected = isotropic_entry<double>(i, j, 0.4, 0.4);
      if (std::fabs(found - expected) < 1e-12) continue;
      return Finding{
          Severity::error, "moduli",
          fmt::format("with E = 1 Pa and nu = 0.25 the second derivative by {} and {} {} is {:.4g} Pa, "
                      "expected {:.4g} Pa{}; give the params other names, or form the value from mu = E/(2*(1 + nu)) "
                      "and la = E*nu/((1 + nu)*(1 - 2*nu))",
                      component_name(energy, j), component_name(energy, i), where(energy), found, expected,
                      moduli_text(jet)),
          start_of(*energy.value), told(energy, case_name, *state)};
    }
  }
  return good;
}

std::optional<Finding> check_stable_at_rest(const Energy& energy, const std::string& case_name) {
  if (!has_rest_state(energy) || !energy.part_of.empty()) return std::nullopt;
  const auto basis = strains(energy);
  const int n = static_cast<int>(basis.size());
  StateSampler sampler;
  double weakest = 1;  // smallest eigenvalue over the largest
  std::string weakest_state;
  for (int sample = 0; sample < 8; ++sample) {
    const auto state = rest_state(energy, case_name, sampler);
    if (!state) return std::nullopt;  // check_rest tells
    const auto jet = derivatives(energy, case_name, numbers_at(energy, *state));
    std::vector<double> matrix;
    for (const auto& a : basis) {
      for (const auto& b : basis) {
        double entry = 0;
        for (size_t i = 0; i < a.size(); ++i)
          for (size_t j = 0; j < b.size(); ++j)
            if (a[i] != 0 && b[j] != 0) entry += a[i] * hessian_entry(jet, i, j) * b[j];
        matrix.push_back(entry);
      }
    }
    const auto eigenvalues = symmetric_eigenvalues(matrix, n);
    if (std::isnan(eigenvalues.front())) {
      const Expression* part = first_undefined(energy, case_name, *state);
      return Finding{Severity::error, "stable at rest",
                     fmt::format("the stiffness is not finite {}, because {} or its derivatives are not", where(energy),
                                 to_text(part == nullptr ? *energy.value : *part)),
                     start_of(part == nullptr ? *energy.value : *part), told(energy, case_name, *state)};
    }
    const double scale = std::max(std::fabs(eigenvalues.front()), std::fabs(eigenvalues.back()));
    const double here = scale > 0 ? eigenvalues.front() / scale : 0;
    if (here < weakest) {
      weakest = here;
      weakest_state = told(energy, case_name, *state);
    }
  }
  const bool density = energy.kind == Energy::Kind::density;
  const char* motion = density ? "strain" : "displacement";
  if (weakest < -1e-12)
    return Finding{Severity::error, "stable at rest",
                   fmt::format("a small {} {} gives energy away: the smallest eigenvalue of the stiffness is {:.2g} of "
                               "the largest; change a sign or narrow the ranges",
                               motion, where(energy), weakest),
                   start_of(*energy.value), weakest_state};
  if (density && weakest < 1e-12)
    return Finding{Severity::warning, "stable at rest",
                   fmt::format("some small strain {} costs nothing", where(energy)), start_of(*energy.value),
                   weakest_state};
  const char* costs = density ? "every small strain costs energy " : "no small displacement gives energy away ";
  return Finding{Severity::ok, "stable at rest", std::string(costs) + where(energy), {}, ""};
}

}  // namespace ergon
