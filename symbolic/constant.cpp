#include "symbolic/constant.h"

#include <cstdlib>
#include <numeric>

namespace ergon {
namespace {

constexpr long limit = 999999;

std::optional<Exponent> reduced(long num, long den) {
  if (den == 0) return std::nullopt;
  const long divisor = std::gcd(num, den) * (den < 0 ? -1 : 1);
  num /= divisor;
  den /= divisor;
  if (std::labs(num) > limit || den > limit) return std::nullopt;
  return Exponent{static_cast<int>(num), static_cast<int>(den)};
}

std::optional<Exponent> literal(const std::string& text) {
  long num = 0, den = 1;
  bool fraction = false;
  for (const char c : text) {
    if (c == '.') {
      fraction = true;
    } else if (c < '0' || c > '9') {
      return std::nullopt;  // a power of ten: no one writes exponents so
    } else {
      num = 10 * num + (c - '0');
      if (fraction) den *= 10;
      if (num > limit || den > limit) return std::nullopt;
    }
  }
  return reduced(num, den);
}

}  // namespace

std::optional<Exponent> constant_exponent(const Expression& expression) {
  using Kind = Expression::Kind;
  if (expression.kind == Kind::number) return literal(expression.text);
  if (expression.kind == Kind::negate) {
    const auto value = constant_exponent(*expression.arguments[0]);
    return value ? reduced(-value->num, value->den) : std::nullopt;
  }
  const bool arithmetic = expression.kind == Kind::add || expression.kind == Kind::subtract ||
                          expression.kind == Kind::multiply || expression.kind == Kind::divide;
  if (!arithmetic) return std::nullopt;
  const auto left = constant_exponent(*expression.arguments[0]);
  const auto right = left ? constant_exponent(*expression.arguments[1]) : std::nullopt;
  if (!right) return std::nullopt;
  const long a = left->num, b = left->den, c = right->num, d = right->den;
  switch (expression.kind) {
    case Kind::add:
      return reduced(a * d + c * b, b * d);
    case Kind::subtract:
      return reduced(a * d - c * b, b * d);
    case Kind::multiply:
      return reduced(a * c, b * d);
    default:
      return reduced(a * d, b * c);
  }
}

std::optional<std::string> literal_number(const Expression& expression) {
  using Kind = Expression::Kind;
  if (expression.kind == Kind::number) return expression.text;
  const bool negative = expression.kind == Kind::negate && expression.arguments[0]->kind == Kind::number;
  return negative ? std::optional("-" + expression.arguments[0]->text) : std::nullopt;
}

}  // namespace ergon
