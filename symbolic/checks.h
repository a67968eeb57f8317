#pragma once
// Whether an energy is sound as mechanics, beyond being well formed: what must hold at rest, under rigid motions and at
// inversion. Checked exactly where the numbers are rational, else to 50 digits.

#include <string>
#include <vector>

#include "symbolic/energy.h"

namespace ergon {

enum class Severity { ok, warning, error };

struct Finding {
  Severity severity;
  std::string check;    // "rest", "rigid motion", "moduli", "stable at rest", "inversion", "defined"
  std::string message;  // what holds, or what was found and what was expected
};

// Findings in a fixed order; checks that do not apply to the energy leave none. An energy with cases is checked in
// each.
std::vector<Finding> check_energy(const Energy& energy);

}  // namespace ergon
