#pragma once
// Inputs of an energy from the command line: NAME=VALUE, with the components of vectors and matrices (column by column)
// separated by commas, each a number in SI or one with a unit: E=0.5MPa, n=0,0,1.

#include <map>
#include <string>
#include <vector>

#include "symbolic/energy.h"

namespace ergon {

// Values in SI by name. Throws InputError for a text without '=', a name that is no param, rest or lag of the energy
// (with the nearest; with `dofs`, these may be given too), a name given twice, a wrong number of components, a wrong
// unit, a value outside its range.
std::map<std::string, std::vector<double>> read_assignments(const Energy& energy, const std::vector<std::string>& texts,
                                                            bool dofs = false);

// "(0, inf) Pa", "(-1, 0.5)".
std::string range_in_unit(const Symbol& symbol);

}  // namespace ergon
