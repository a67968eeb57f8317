// Checks that search: kinks and poles inside the domain, the boundaries of `active` and `require`.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "symbolic/analyse.h"
#include "symbolic/blame.h"
#include "symbolic/exact_checks.h"
#include "symbolic/limits.h"
#include "symbolic/print.h"
#include "symbolic/state_text.h"
#include "symbolic/typing.h"

namespace ergon {
namespace {

using Kind = Expression::Kind;

constexpr int starts = 8;
constexpr size_t zeros_per_site = 2;  // of a cut all: it is one on a part of them only

const char* const seen = "seen with 90 digits";

// Where a site is critical: "u = 0".
std::string condition_text(const CriticalSite& site) {
  const Expression& e = *site.expression;
  auto text = [&](size_t i) { return to_text(*e.arguments[i]); };
  const std::string& f = e.text;
  if (e.kind == Kind::divide) return text(1) + " = 0";
  if (e.kind == Kind::power || f == "pow") return text(0) + " = 0";
  if (f == "min" || f == "max") return text(0) + " = " + text(1);
  if (f == "log1p") return text(0) + " = -1";
  if (f == "asin" || f == "acos") return text(0) + " is 1 or -1";
  if (f == "tan") return "cos(" + text(0) + ") = 0";
  if (f == "inverse") return "det(" + text(0) + ") = 0";
  if (f == "atan2" && site.cause == Cause::angle) return text(0) + " = 0 and " + text(1) + " = 0";
  if (f == "atan2") return fmt::format("{} = 0 and {} < 0", text(0), text(1));
  if (f == "dihedral" && site.cause == Cause::cut) return "the two triangles are folded onto each other";
  if (f == "dihedral") return "a triangle has no area";
  return text(0) + " = 0";
}

// What `require` would say to keep away, with the sign that the quantity has where the search started.
std::string require_text(const CriticalSite& site, bool positive) {
  const Expression& e = *site.expression;
  const char* sign = positive ? ">" : "<";
  if (e.text == "norm" && e.kind == Kind::call) return fmt::format("`require norm2({}) > 0`", to_text(*e.arguments[0]));
  if (e.kind == Kind::divide) return fmt::format("`require {} {} 0`", to_text(*e.arguments[1]), sign);
  if (e.kind == Kind::power || e.text == "pow" || e.text == "sqrt" || e.text == "log")
    return fmt::format("`require {} {} 0`", to_text(*e.arguments[0]), sign);
  if (e.text == "inverse") return fmt::format("`require det({}) {} 0`", to_text(*e.arguments[0]), sign);
  return "`require`";
}

// The names of params, rest and lag that an expression is made of, through lets.
void add_names(const Energy& energy, const Expression& e, std::vector<std::string>& names) {
  for (const ExpressionPtr& argument : e.arguments) add_names(energy, *argument, names);
  if (e.kind != Kind::name) return;
  for (const Let& let : energy.lets)
    if (let.name == e.text) add_names(energy, *let.expression, names);
  if (energy.find(e.text) != nullptr && std::find(names.begin(), names.end(), e.text) == names.end())
    names.push_back(e.text);
}

std::string effect_text(const Energy& energy, const Limit& limit) {
  size_t row = 0, column = limit.component;
  while (column > row) column -= ++row;
  const bool second = limit.effect == Effect::curvature_grows || limit.effect == Effect::curvature_jumps;
  const std::string by = second ? fmt::format("the second derivative by {} and {}", component_name(energy, column),
                                              component_name(energy, row))
                                : "the derivative by " + component_name(energy, limit.component);
  const int order = second ? 2 : limit.effect >= Effect::value_jumps ? 0 : 1;
  const std::string unit = derivative_unit(energy, order);
  const std::string what = order == 0 ? "the value" : by;
  switch (limit.effect) {
    case Effect::undefined:
      return "the value is not a real number on one side";
    case Effect::value_jumps:
    case Effect::gradient_jumps:
    case Effect::curvature_jumps:
      return fmt::format("{} jumps from {:.4g} to {:.4g}{}", what, limit.below + 0.0, limit.above + 0.0, unit);
    default:
      return fmt::format("{} grows without bound", what);
  }
}

// The part that is zero: the divisor of a quotient, else the whole.
const Expression& part_of(const CriticalSite& site) {
  return site.expression->kind == Kind::divide ? *site.expression->arguments[1] : *site.expression;
}

std::string remedy_text(const Energy& energy, const CriticalSite& site, const Limit& limit, bool dofs, bool positive) {
  std::vector<std::string> names;
  if (!dofs) add_names(energy, part_of(site), names);
  std::erase_if(names, [&](const std::string& name) { return !energy.find(name)->shape.scalar(); });
  if (!names.empty()) return fmt::format("narrow the range of {}", fmt::join(names, ", "));
  const bool branches = site.cause == Cause::absolute || site.cause == Cause::extremum;
  if (branches && limit.effect == Effect::gradient_jumps)
    return "smooth it, as sqrt(u^2 + d^2) smooths abs(u), or take a power that is flat there";
  return "keep away from there by " + require_text(site, positive);
}

// A fold onto itself is where every function of an angle ends. Elsewhere one sign about the state means that dofs meet
// it by chance only, as where two points coincide; rest data are what somebody gave.
Severity severity_of(const CriticalSite& site, const Limit& limit, bool dofs, std::pair<bool, bool> signs) {
  const bool fold = site.cause == Cause::cut && site.expression->text == "dihedral";
  if (limit.effect == Effect::curvature_jumps || fold) return Severity::note;
  const bool chance = signs.first != signs.second && limit.effect < Effect::value_grows;
  if (chance) return dofs ? Severity::note : Severity::warning;
  return limit.effect == Effect::curvature_grows ? Severity::warning : Severity::error;
}

Finding smooth_finding(const Energy& energy, const std::string& case_name, const CriticalSite& site,
                       const CriticalState& state, const Limit& limit) {
  const auto signs = signs_about(energy, case_name, site, state.inputs, state.moves_dofs);
  const Severity severity = severity_of(site, limit, state.moves_dofs, signs);
  const bool whole = site.expression->kind == Kind::call;
  const std::string remedy = limit.effect == Effect::curvature_jumps
                                 ? ""
                                 : "; " + remedy_text(energy, site, limit, state.moves_dofs, signs.first);
  return {severity, "smooth",
          fmt::format("{} where {}{} ({}){}", effect_text(energy, limit), condition_text(site),
                      whole ? ", in " + to_text(*site.expression) : "", seen, remedy),
          start_of(part_of(site)), state_text(energy, state.inputs)};
}

// Collects one finding a place, of the worst effect.
class Search {
 public:
  Search(const Energy& energy, const std::string& case_name) : energy_(energy), case_(case_name) {}

  std::vector<Finding> run() {
    std::vector<ExactInputs> from;
    for (int i = 0; i < starts; ++i)
      if (auto start = sampler_.admissible(energy_, case_)) from.push_back(std::move(*start));
    if (from.empty()) return {};
    sites_ = critical_sites(energy_, case_, from.front());
    for (int round = 0; round < 2; ++round)
      for (const ExactInputs& state : degenerate_states(energy_, sampler_))
        if (clearly_admissible(energy_, case_, state)) consider(state);
    for (const auto& [site, dofs] : sites_) consider_zeros(site, from);
    return found_;
  }

 private:
  bool known(const CriticalSite& site) const {
    return std::find(known_.begin(), known_.end(), site.expression) != known_.end();
  }

  void consider_zeros(const CriticalSite& site, const std::vector<ExactInputs>& from) {
    size_t zeros = 0;
    for (const ExactInputs& start : from) {
      if ((zeros == zeros_per_site && site.cause != Cause::cut) || known(site)) return;
      const auto state = solve_critical(energy_, case_, {CriticalTarget::Kind::site, site, 0}, start);
      if (!state) continue;
      ++zeros;
      consider(state->inputs);
    }
  }

  // The first site in the order of the text that is critical at a state answers for what happens there.
  void consider(const ExactInputs& state) {
    std::vector<std::pair<CriticalSite, bool>> here;
    for (const CriticalSite& vanishing : vanishing_sites(energy_, case_, state))
      for (const auto& site : sites_)
        if (site.first == vanishing) here.push_back(site);
    if (here.empty() || std::any_of(here.begin(), here.end(), [&](const auto& s) { return known(s.first); })) return;
    const auto& [site, dofs] = here.front();
    const Limit limit = limit_at(energy_, case_, state, dofs);
    if (limit.effect == Effect::none || left_to_inversion(limit, state)) return;
    known_.push_back(site.expression);
    found_.push_back(smooth_finding(energy_, case_, site, {state, dofs}, limit));
  }

  // What is not finite at collapse and beyond is told by the check of inversion.
  bool left_to_inversion(const Limit& limit, const ExactInputs& state) const {
    return energy_.kind == Energy::Kind::density && energy_.geometry == "solid" &&
           (limit.effect == Effect::undefined || limit.effect == Effect::value_grows) &&
           cln::double_approx(determinant(state.at("F"))) < 1e-9;
  }

  const Energy& energy_;
  const std::string& case_;
  StateSampler sampler_;
  std::vector<std::pair<CriticalSite, bool>> sites_;
  std::vector<const Expression*> known_;  // those that were found at fault
  std::vector<Finding> found_;
};

std::optional<CriticalState> boundary_state(const Energy& energy, const std::string& case_name,
                                            const CriticalTarget& boundary, StateSampler& sampler) {
  for (int i = 0; i < starts; ++i) {
    const auto start = sampler.admissible(energy, case_name);
    if (!start) return std::nullopt;
    auto state = solve_critical(energy, case_name, boundary, *start);
    if (state && state->moves_dofs) return state;
  }
  return std::nullopt;
}

std::string condition_text(const Condition& c) { return fmt::format("{} < {}", to_text(*c.left), to_text(*c.right)); }

}  // namespace

std::vector<Finding> check_smooth(const Energy& energy, const std::string& case_name) {
  std::vector<Finding> found = Search(energy, case_name).run();
  if (found.empty())
    found.push_back({Severity::ok, "smooth", "no kink and no pole was found inside the domain", {}, ""});
  return found;
}

std::vector<Finding> check_boundaries(const Energy& energy, const std::string& case_name) {
  std::vector<Finding> found;
  StateSampler sampler;
  for (size_t i = 0; i < energy.active.size(); ++i) {
    const Condition& condition = energy.active[i];
    const CriticalTarget boundary{CriticalTarget::Kind::active, {}, i};
    const auto state = boundary_state(energy, case_name, boundary, sampler);
    if (!state) continue;
    const Limit limit = limit_at_boundary(energy, case_name, state->inputs, boundary);
    const std::string name = condition_text(condition);
    if (limit.effect == Effect::none) {
      found.push_back({Severity::ok, "activation", fmt::format("begins smoothly at `active {}`", name), {}, ""});
      continue;
    }
    const bool note = limit.effect == Effect::curvature_jumps;
    found.push_back({note ? Severity::note : Severity::error, "activation",
                     fmt::format("at the boundary of `active {}` {} ({}){}", name, effect_text(energy, limit), seen,
                                 note ? "" : "; let the value and its derivatives be 0 there"),
                     condition.place, state_text(energy, state->inputs)});
  }
  for (size_t i = 0; i < energy.require.size(); ++i) {
    const CriticalTarget boundary{CriticalTarget::Kind::require, {}, i};
    const auto state = boundary_state(energy, case_name, boundary, sampler);
    if (!state) continue;
    const Limit limit = limit_at_boundary(energy, case_name, state->inputs, boundary);
    if (limit.effect != Effect::value_grows) continue;
    const auto terms = terms_at(energy, case_name, limit.nearby, 0);
    const auto lowest = std::min_element(terms.begin(), terms.end(),
                                         [](const ValueTerm& a, const ValueTerm& b) { return a.value < b.value; });
    found.push_back({Severity::error, "boundary",
                     fmt::format("the value falls without bound towards the boundary of `require {}`, where {} is "
                                 "{:.4g}{}; change a sign, or narrow the ranges of the params",
                                 condition_text(energy.require[i]), to_text(*lowest->expression), lowest->value,
                                 derivative_unit(energy, 0)),
                     start_of(*lowest->expression), state_text(energy, limit.nearby)});
  }
  return found;
}

}  // namespace ergon
