#pragma once
// Shape and unit of an expression from those of the names in it.

#include <map>
#include <string>

#include "symbolic/expression.h"

namespace ergon {

struct Quantity {
  Shape shape;
  Unit unit;
  bool any_unit = false;  // the literal 0, which fits every unit
};

using Quantities = std::map<std::string, Quantity>;

// Fills in shape and unit of every node below `expression`. Names must be known. Throws SourceError where an operation
// is given what it cannot take.
Quantity type_of(const Expression& expression, const Quantities& names);

// "expected a length (m), found kg", or "" when the units agree.
std::string unit_conflict(const Quantity& expected, const Quantity& found);

// Where the text of an expression begins (its own place may be that of an operator in the middle).
Place start_of(const Expression& expression);

}  // namespace ergon
