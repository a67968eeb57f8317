#pragma once
// A page of HTML about energies: formula, curve, parameters, source, cost, and what is known of each. One file that
// needs nothing from elsewhere, and well-formed XML.

#include <string>
#include <vector>

#include "symbolic/energy.h"

namespace ergon {

// In the order given, under a list of links. Each energy is checked and its kernel generated on the way.
std::string catalogue_page(const std::vector<Energy>& energies);

// The energy that shows what a part does: itself, a law of contact over the distance of two points, a distance under
// the log barrier.
Energy shown_whole(const Energy& energy);

}  // namespace ergon
