#pragma once
// Energies made of one energy: with params that vary, with a weight. All that follows sees them like any other; the
// file says nothing of it.

#include <string>
#include <vector>

#include "symbolic/energy.h"

namespace ergon {

// The same energy with these params as rest data: one value for each stencil or point of quadrature in place of one for
// each material. Throws std::invalid_argument for a name that is not a param.
Energy varied(const Energy& energy, const std::vector<std::string>& params);

// The energy times a param `weight` (1, not negative) of its own. Throws std::invalid_argument when the energy declares
// that name.
Energy weighted(const Energy& energy);

}  // namespace ergon
