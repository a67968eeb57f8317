#pragma once
// Whether an energy is sound as mechanics, beyond being well formed: what must hold at rest, under rigid motions and at
// inversion, and whether it can be differentiated twice wherever its ranges and conditions admit. Checked exactly where
// the numbers are rational, else to 50 digits or more; a message says how its fault was seen.

#include <string>
#include <vector>

#include "symbolic/energy.h"

namespace ergon {

// A note is true of the energy, and may well be meant.
enum class Severity { ok, note, warning, error };

struct Finding {
  Severity severity;
  std::string check;    // "defined", "smooth", "activation", "boundary", "rigid motion", "rest", "moduli", ...
  std::string message;  // what holds, or what was found and what was expected
  Place place;          // of the part of the text at fault; line 0 where there is none
  std::string state;    // that shows it, as `ergon eval` takes it: "--set E=1 --set F=1,0,..."; "" where there is none
};

// "ok", "note", "warning", "error".
std::string_view to_string(Severity severity);

// "file:line:column: message, at --set ...", or the message alone.
std::string to_string(const Finding& finding);

// Findings in a fixed order; checks that do not apply to the energy leave none. An energy with cases is checked in
// each.
std::vector<Finding> check_energy(const Energy& energy);

}  // namespace ergon
