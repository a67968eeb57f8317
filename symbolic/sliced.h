#pragma once
// What of an energy one expression of it depends on.

#include "symbolic/energy.h"

namespace ergon {

// The energy whose value is `part`, an expression somewhere in `energy` (a tensor gives its first component), with the
// symbols and lets that it is made of, in their order, and without conditions and updates; its cases are those of
// `energy`.
Energy sliced(const Energy& energy, const ExpressionPtr& part);

// The expression in lets, value, conditions and updates that `part` points to.
ExpressionPtr find_expression(const Energy& energy, const Expression* part);

}  // namespace ergon
