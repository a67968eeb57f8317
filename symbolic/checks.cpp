#include "symbolic/checks.h"

#include "symbolic/exact_checks.h"

namespace ergon {

std::vector<Finding> check_energy(const Energy& energy) {
  std::vector<Finding> findings;
  const std::vector<std::string> cases = energy.cases.empty() ? std::vector<std::string>{""} : energy.cases;
  for (const std::string& name : cases) {
    for (const auto& check :
         {check_defined, check_rigid_motion, check_rest, check_moduli, check_stable_at_rest, check_inversion}) {
      std::optional<Finding> finding = check(energy, name);
      if (!finding) continue;
      if (!name.empty()) finding->message = "case " + name + ": " + finding->message;
      findings.push_back(std::move(*finding));
    }
  }
  return findings;
}

}  // namespace ergon
