#pragma once
// The independent oracle: value, gradient and Hessian of an energy at any number of digits, by second-order
// forward differentiation over CLN floats. Shares nothing with the compiler but the expression tree.

#include <map>
#include <string>
#include <vector>

#include "symbolic/cln_algebra.h"
#include "symbolic/energy.h"

namespace ergon {

// Values of every symbol by name, components column by column (double inputs are taken as exact).
using Inputs = std::map<std::string, std::vector<double>>;

struct ReferenceValue {
  double value = 0;
  std::vector<double> gradient;  // over all dof components in order of declaration: size n
  std::vector<double> hessian;   // n x n, column by column; each entry correctly rounded from `digits` digits
  std::vector<double> active;    // margins
  std::vector<double> require;   // margins
  std::vector<double> update;    // of Energy::updates, one after the other
};

// What has no real and finite result (log of a negative number, division by zero) is NaN. Throws std::invalid_argument
// when a symbol has no value, or not as many components as it should.
ReferenceValue evaluate_reference(const Energy& energy, const std::string& case_name, const Inputs& inputs,
                                  int digits = 50);
// The same at exact values, such as an F that is not made of doubles.
ReferenceValue evaluate_reference_at(const Energy& energy, const std::string& case_name, const ExactInputs& inputs,
                                     int digits = 50);

}  // namespace ergon
