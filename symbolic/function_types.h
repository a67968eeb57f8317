#pragma once
// What each function takes and gives.

#include <vector>

#include "symbolic/typing.h"

namespace ergon {

// The result of a call whose arguments are typed already. Throws SourceError for an unknown function and for a wrong
// number, shape or unit of arguments.
Quantity type_of_call(const Expression& call, const std::vector<Quantity>& arguments);

// base^exponent. A unit is raised to exponents written as numbers only.
Quantity power(const Expression& at, const Quantity& base, const Quantity& exponent, const Expression& exponent_text);

}  // namespace ergon
