#pragma once
// Exponents that are written as numbers: 2, -1, 3/2, (1/3), 0.5.

#include <optional>

#include "symbolic/expression.h"

namespace ergon {

// The exact value of an expression made of number literals, + - * / and unary minus, in lowest terms; nothing when
// another thing occurs in it or when numerator or denominator would exceed six digits.
std::optional<Exponent> constant_exponent(const Expression& expression);

}  // namespace ergon
