#pragma once
// States at which a quantity of an energy is zero: found from random states by Newton's method in double precision and
// again in 90 digits, and among states that are degenerate by construction, which are exact.

#include <optional>
#include <vector>

#include "symbolic/critical.h"
#include "symbolic/sample_states.h"

namespace ergon {

// A quantity: what an operation of the value is critical at, or the margin of a condition.
struct CriticalTarget {
  enum class Kind { site, active, require };
  Kind kind = Kind::site;
  CriticalSite site;
  size_t condition = 0;
};

struct CriticalState {
  ExactInputs inputs;
  bool moves_dofs = true;  // the quantity depends on dofs; else on the other symbols alone
};

inline constexpr int critical_digits = 90;

// Every operation of the value, conditions and lets that has a critical quantity which varies, in the order of the
// text, and whether that depends on dofs (as seen at a state without special values).
std::vector<std::pair<CriticalSite, bool>> critical_sites(const Energy& energy, const std::string& case_name,
                                                          const ExactInputs& at);

// The nearest zero that Newton's method finds by moving dofs, or, where the quantity does not depend on them, the other
// symbols; within all ranges, with all other margins positive.
std::optional<CriticalState> solve_critical(const Energy& energy, const std::string& case_name,
                                            const CriticalTarget& target, const ExactInputs& start);

// The sites whose quantity vanishes at a state (to 60 digits).
std::vector<CriticalSite> vanishing_sites(const Energy& energy, const std::string& case_name,
                                          const ExactInputs& inputs);

// Whether the quantity of a site is positive, and whether it is negative, somewhere about a state where it vanishes.
std::pair<bool, bool> signs_about(const Energy& energy, const std::string& case_name, const CriticalSite& site,
                                  const ExactInputs& inputs, bool dofs);

// Within all ranges and with all margins clearly positive; that of `except` alone is not asked for.
bool clearly_admissible(const Energy& energy, const std::string& case_name, const ExactInputs& inputs,
                        const CriticalTarget* except = nullptr);

// States with coinciding, collinear or coplanar points, now or at rest; at rest; of F: undeformed, rotated, with equal
// stretches, flattened. Other values are random.
std::vector<ExactInputs> degenerate_states(const Energy& energy, StateSampler& sampler);

}  // namespace ergon
