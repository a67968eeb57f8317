#pragma once
// The expression tree of an energy, exactly as its author wrote it: no simplification, no reordering. Shape and unit
// are filled in by analyse() (symbolic/analyse.h).

#include <memory>
#include <string>
#include <vector>

#include "symbolic/diagnostic.h"
#include "symbolic/units.h"

namespace ergon {

// rows x cols; a vector has cols = 1, a scalar is 1 x 1. Components are stored column by column.
struct Shape {
  int rows = 1;
  int cols = 1;
  int size() const { return rows * cols; }
  bool scalar() const { return rows == 1 && cols == 1; }
  bool operator==(const Shape&) const = default;
};

// "scalar", "vector of 3", "3x3 matrix".
std::string to_string(Shape shape);

struct Expression;
using ExpressionPtr = std::shared_ptr<const Expression>;

struct Expression {
  enum class Kind {
    number,  // text holds the decimal literal: "0.5", "1e-24", "3"
    name,    // text holds the name
    negate,  // 1 argument
    add,     // 2 arguments, and so on for the binary operators
    subtract,
    multiply,   // scalar*tensor, matrix*matrix, matrix*vector
    divide,     // tensor/scalar
    power,      // scalar^scalar
    transpose,  // postfix '
    call,       // text holds the function name
    index,      // arguments: tensor, row literal[, column literal], counted from 0
    literal     // [a, b; c, d]: shape tells rows and columns, arguments are row by row
  };
  Kind kind;
  std::string text;
  std::vector<ExpressionPtr> arguments;
  Place place;
  mutable Shape shape;  // set by analyse()
  mutable Unit unit;    // set by analyse()
};

}  // namespace ergon
