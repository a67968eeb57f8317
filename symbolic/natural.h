#pragma once
// Densities whose shape without stress is not the one at rest (`natural G`): F = Fe G, and Fe = I is free of stress.

#include "symbolic/cln_algebra.h"
#include "symbolic/energy.h"

namespace ergon {

// The density as a body drawn in its shape without stress would have it: over Fe, under the name F, per volume (area,
// length) of that shape. The energy itself where it states no `natural`. Expressions keep their places in the text.
Energy seen_from_natural(const Energy& energy);

// A state of seen_from_natural(energy) as one of `energy`: F = Fe G, to 50 digits.
ExactInputs seen_from_rest(const Energy& energy, const std::string& case_name, const ExactInputs& state);

}  // namespace ergon
