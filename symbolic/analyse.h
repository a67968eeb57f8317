#pragma once
// Names, shapes and units: what an energy must satisfy to have a meaning. Afterwards every expression node carries its
// shape and unit, every name is declared once and used, and conditions and value have the units they must have.

#include "symbolic/energy.h"

namespace ergon {

// Throws SourceError at the first fault, saying what was found and what was expected.
void analyse(const Energy& energy);

// The unit of the value: J/m^3 for a solid density, J/m^2 membrane, J/m line, J for a stencil energy.
Unit value_unit(const Energy& energy);

}  // namespace ergon
