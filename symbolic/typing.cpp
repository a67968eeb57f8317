#include "symbolic/typing.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "symbolic/constant.h"
#include "symbolic/function_types.h"

namespace ergon {
namespace {

using Kind = Expression::Kind;

const char* sign_of(Kind kind) {
  switch (kind) {
    case Kind::add:
      return "+";
    case Kind::subtract:
      return "-";
    case Kind::multiply:
      return "*";
    case Kind::divide:
      return "/";
    default:
      return "^";
  }
}

class Typing {
 public:
  explicit Typing(const Quantities& names) : names_(names) {}

  Quantity of(const Expression& e) const {
    try {
      const Quantity q = kind(e);
      e.shape = q.shape;
      e.unit = q.unit;
      return q;
    } catch (const std::invalid_argument& error) {
      throw SourceError(e.place, error.what());
    }
  }

 private:
  Quantity argument(const Expression& e, size_t i) const { return of(*e.arguments[i]); }

  Quantity kind(const Expression& e) const {
    switch (e.kind) {
      case Kind::number:
        return number(e);
      case Kind::name:
        return e.text == "pi" ? Quantity{} : names_.at(e.text);
      case Kind::negate:
        return argument(e, 0);
      case Kind::add:
      case Kind::subtract:
        return sum(e);
      case Kind::multiply:
        return product(e);
      case Kind::divide:
        return quotient(e);
      case Kind::power: {
        const Quantity base = argument(e, 0);
        return power(e, base, argument(e, 1), *e.arguments[1]);
      }
      case Kind::transpose: {
        const Quantity q = argument(e, 0);
        if (q.shape.scalar()) throw SourceError(e.place, "a transpose (') expects a vector or a matrix, found scalar");
        return {{q.shape.cols, q.shape.rows}, q.unit, q.any_unit};
      }
      case Kind::index:
        return index(e);
      case Kind::literal:
        return literal(e);
      default:
        return call(e);
    }
  }

  static Quantity number(const Expression& e) {
    const std::string mantissa = e.text.substr(0, e.text.find_first_of("eE"));
    const bool zero = mantissa.find_first_of("123456789") == std::string::npos;
    const double value = std::strtod(e.text.c_str(), nullptr);
    if (!std::isfinite(value)) throw SourceError(e.place, fmt::format("the number {} is too large", e.text));
    if (value == 0 && !zero) throw SourceError(e.place, fmt::format("the number {} is too small", e.text));
    return {{}, {}, zero};
  }

  Quantity sum(const Expression& e) const {
    const Quantity left = argument(e, 0);
    const Quantity right = argument(e, 1);
    if (left.shape != right.shape) {
      const Shape larger = left.shape.scalar() ? right.shape : left.shape;
      const bool unit_matrix = (left.shape.scalar() || right.shape.scalar()) && larger.rows == larger.cols;
      throw SourceError(e.place,
                        fmt::format("'{}' needs the same shape on both sides: expected {}, found {}", sign_of(e.kind),
                                    to_string(left.shape), to_string(right.shape)) +
                            (unit_matrix ? fmt::format("; the unit matrix is identity({})", larger.rows) : ""));
    }
    if (const std::string conflict = unit_conflict(left, right); !conflict.empty())
      throw SourceError(e.place, fmt::format("'{}' needs the same unit on both sides: {}", sign_of(e.kind), conflict));
    return left.any_unit ? right : left;
  }

  Quantity product(const Expression& e) const {
    const Quantity left = argument(e, 0);
    const Quantity right = argument(e, 1);
    const Unit unit = left.unit * right.unit;
    const bool any = left.any_unit || right.any_unit;
    if (left.shape.scalar()) return {right.shape, unit, any};
    if (right.shape.scalar()) return {left.shape, unit, any};
    if (left.shape.cols == 1 && right.shape.cols == 1 && left.shape.rows == right.shape.rows)
      throw SourceError(e.place, "'*' has no meaning between two vectors; use dot(a, b), cross(a, b) or outer(a, b)");
    if (left.shape.cols != right.shape.rows)
      throw SourceError(e.place, fmt::format("'*' expects a right side with {} rows for a {} on the left, found {}",
                                             left.shape.cols, to_string(left.shape), to_string(right.shape)));
    return {{left.shape.rows, right.shape.cols}, unit, any};
  }

  Quantity quotient(const Expression& e) const {
    const Quantity left = argument(e, 0);
    const Quantity right = argument(e, 1);
    if (!right.shape.scalar())
      throw SourceError(e.place, fmt::format("'/' expects a scalar on its right, found {}", to_string(right.shape)));
    if (e.arguments[1]->kind == Kind::number && right.any_unit) throw SourceError(e.place, "division by 0");
    return {left.shape, left.unit / right.unit, left.any_unit};
  }

  Quantity index(const Expression& e) const {
    const Quantity q = argument(e, 0);
    const size_t given = e.arguments.size() - 1;
    if (q.shape.scalar()) throw SourceError(e.place, "an index expects a vector or a matrix, found scalar");
    if (given == 1 && q.shape.cols > 1)
      throw SourceError(e.place, fmt::format("a {} takes two indices, [row, column], found one", to_string(q.shape)));
    const int sizes[] = {q.shape.rows, q.shape.cols};
    for (size_t i = 0; i < given; ++i) {
      const int value = std::atoi(e.arguments[i + 1]->text.c_str());
      if (value >= sizes[i])
        throw SourceError(e.arguments[i + 1]->place,
                          fmt::format("index {} is out of range: a {} has {} 0 to {}", value, to_string(q.shape),
                                      i == 0 ? "rows" : "columns", sizes[i] - 1));
    }
    return {{}, q.unit, q.any_unit};
  }

  Quantity literal(const Expression& e) const {
    Quantity all{e.shape, {}, true};
    for (const ExpressionPtr& item : e.arguments) {
      const Quantity q = of(*item);
      if (!q.shape.scalar())
        throw SourceError(start_of(*item), fmt::format("a list in [ ] is made of scalars, found {}; "
                                                       "columns(a, b, c) joins vectors",
                                                       to_string(q.shape)));
      if (const std::string conflict = unit_conflict(all, q); !conflict.empty())
        throw SourceError(start_of(*item), "the components of a vector or matrix have one unit: " + conflict);
      if (all.any_unit) all = {e.shape, q.unit, q.any_unit};
    }
    return all;
  }

  Quantity call(const Expression& e) const {
    std::vector<Quantity> arguments;
    for (const ExpressionPtr& a : e.arguments) arguments.push_back(of(*a));
    return type_of_call(e, arguments);
  }

  const Quantities& names_;
};

}  // namespace

Quantity type_of(const Expression& expression, const Quantities& names) { return Typing(names).of(expression); }

std::string unit_conflict(const Quantity& expected, const Quantity& found) {
  if (expected.any_unit || found.any_unit || expected.unit == found.unit) return "";
  return fmt::format("expected {}, found {}", describe(expected.unit), to_string(found.unit));
}

Place start_of(const Expression& expression) {
  const Expression* e = &expression;
  while (e->kind == Kind::add || e->kind == Kind::subtract || e->kind == Kind::multiply || e->kind == Kind::divide ||
         e->kind == Kind::power || e->kind == Kind::transpose || e->kind == Kind::index)
    e = e->arguments[0].get();
  return e->place;
}

}  // namespace ergon
