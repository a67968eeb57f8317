#pragma once
// States and derivatives in messages: as what `ergon eval` takes, and by the names of their components.

#include <string>

#include "symbolic/cln_algebra.h"
#include "symbolic/energy.h"

namespace ergon {

// "--set E=1 --set F=1,0,0,0,1,0,0,0,1": 12 digits, components column by column. Only symbols that `inputs` names.
std::string state_text(const Energy& energy, const ExactInputs& inputs);

// The name of a component of the gradient: "F[0,1]", "x0[2]".
std::string component_name(const Energy& energy, size_t index);

// " Pa", " N": the unit of derivatives of the value by dofs, with a blank before it; "" for a pure number.
std::string derivative_unit(const Energy& energy, int order);

}  // namespace ergon
