#pragma once
// What is written as numbers: exponents such as 2, -1, 3/2, (1/3), 0.5, and literals with a sign.

#include <optional>
#include <string>

#include "symbolic/expression.h"

namespace ergon {

// The exact value of an expression made of number literals, + - * / and unary minus, in lowest terms; nothing when
// another thing occurs in it or when numerator or denominator would exceed six digits.
std::optional<Exponent> constant_exponent(const Expression& expression);

// The decimal text of a number literal, with its sign; nothing for any other expression.
std::optional<std::string> literal_number(const Expression& expression);

}  // namespace ergon
