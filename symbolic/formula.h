#pragma once
// A formula in rest position X (m) and time t (s), in the language of energies, as a value of a param.

#include <array>
#include <map>
#include <string>
#include <vector>

#include "symbolic/expression.h"
#include "symbolic/tensor.h"
#include "symbolic/typing.h"

namespace ergon {

class Formula {
 public:
  struct Constant {
    Quantity quantity;
    std::vector<double> values;  // SI, column by column
    Place place;
  };

  // `text` begins at `place`. Throws SourceError there for what the language refuses, for an unknown name and for a
  // constant that is not used, at its own place.
  Formula(const std::string& text, const Place& place, const std::map<std::string, Constant>& constants);

  const Quantity& quantity() const { return quantity_; }
  bool of_position() const { return of_position_; }
  bool of_time() const { return of_time_; }
  // Components column by column; NaN where the formula has no value.
  std::vector<double> at(const std::array<double, 3>& X, double t) const;

 private:
  ExpressionPtr expression_;
  Quantity quantity_;
  std::map<std::string, Tensor<double>> names_;  // the constants
  bool of_position_ = false, of_time_ = false;
};

}  // namespace ergon
