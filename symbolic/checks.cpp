#include "symbolic/checks.h"

#include <algorithm>
#include <array>

#include "symbolic/exact_checks.h"
#include "symbolic/natural.h"

namespace ergon {
namespace {

std::vector<Finding> check_case(const Energy& energy, const std::string& name) {
  std::vector<Finding> findings;
  auto add = [&](std::optional<Finding> finding) {
    if (finding) findings.push_back(std::move(*finding));
  };
  add(check_stretches(energy, name));
  if (!findings.empty() && findings.front().severity == Severity::error) return findings;
  add(check_defined(energy, name));
  // What is not defined at random states has no limits worth looking for.
  if (findings.back().severity == Severity::ok)
    for (const auto& check : {check_smooth, check_boundaries})
      for (Finding& finding : check(energy, name)) findings.push_back(std::move(finding));
  add(check_rigid_motion(energy, name));
  add(check_load(energy, name));
  const Energy natural = seen_from_natural(energy);
  for (const auto& check : {check_rest, check_moduli, check_stable_at_rest, check_range}) add(check(natural, name));
  for (const auto& check : {check_symmetry, check_collapse, check_inversion}) add(check(energy, name));
  return findings;
}

}  // namespace

std::string_view to_string(Severity severity) {
  constexpr std::array<std::string_view, 4> words = {"ok", "note", "warning", "error"};
  return words[static_cast<size_t>(severity)];
}

std::string to_string(const Finding& finding) {
  std::string text = finding.place.line > 0 ? to_string(finding.place) + ": " : "";
  text += finding.message;
  return finding.state.empty() ? text : text + ", at " + finding.state;
}

std::vector<Finding> check_energy(const Energy& energy) {
  std::vector<Finding> findings;
  const std::vector<std::string> cases = energy.cases.empty() ? std::vector<std::string>{""} : energy.cases;
  for (const std::string& name : cases) {
    for (Finding& finding : check_case(energy, name)) {
      if (!name.empty()) finding.message = "case " + name + ": " + finding.message;
      findings.push_back(std::move(finding));
    }
  }
  return findings;
}

}  // namespace ergon
