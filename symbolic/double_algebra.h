#pragma once
// Plain doubles as an algebra: the quick look at a value, without derivatives.

#include <cmath>
#include <string>
#include <vector>

#include "symbolic/cln_algebra.h"

namespace ergon {

class DoubleAlgebra {
 public:
  using Scalar = double;

  explicit DoubleAlgebra(const ExactInputs& inputs) : inputs_(inputs) {}

  double number(const std::string& decimal) const { return std::strtod(decimal.c_str(), nullptr); }
  double add(double a, double b) const { return a + b; }
  double subtract(double a, double b) const { return a - b; }
  double multiply(double a, double b) const { return a * b; }
  double divide(double a, double b) const { return a / b; }
  double negate(double a) const { return -a; }
  double power(double a, long num, long den) const {
    return std::pow(a, static_cast<double>(num) / static_cast<double>(den));
  }
  double power(double a, double b) const { return std::pow(a, b); }
  double input(const Symbol& symbol, int component) const {
    return cln::double_approx(exact_input(inputs_, symbol, component));
  }
  void named(const std::string&, int, int, double) const {}

  std::vector<double> stretches(const Tensor<double>& F) const { return decompose(F.at, 1.0, 0x1p-50).s; }
  // As in ClnAlgebra.
  Decomposed<double> decompose_apart(std::vector<double> F) const {
    for (size_t i = 0; i < F.size(); ++i) F[i] += 0x1p-26 * general_position[i];
    return decompose(F, 1.0, 0x1p-50);
  }

  bool is_zero(double a) const { return a == 0; }
  bool less(double a, double b) const { return a < b; }

  double call(Function f, const std::vector<double>& x) const {
    switch (f) {
      case Function::sqrt:
        return std::sqrt(x[0]);
      case Function::log:
        return std::log(x[0]);
      case Function::exp:
        return std::exp(x[0]);
      case Function::log1p:
        return std::log1p(x[0]);
      case Function::expm1:
        return std::expm1(x[0]);
      case Function::sin:
        return std::sin(x[0]);
      case Function::cos:
        return std::cos(x[0]);
      case Function::tan:
        return std::tan(x[0]);
      case Function::asin:
        return std::asin(x[0]);
      case Function::acos:
        return std::acos(x[0]);
      case Function::atan:
        return std::atan(x[0]);
      case Function::atan2:
        return std::atan2(x[0], x[1]);
      case Function::abs:
        return std::fabs(x[0]);
      case Function::min:
        return x[1] < x[0] ? x[1] : x[0];
      case Function::max:
        return x[0] < x[1] ? x[1] : x[0];
    }
    return std::nan("");
  }

 private:
  const ExactInputs& inputs_;
};

}  // namespace ergon
