#pragma once
// Floats of any number of digits (CLN) as an algebra.

#include <cln/float.h>
#include <cln/rational.h>
#include <cln/real.h>

#include <map>
#include <string>
#include <vector>

#include "symbolic/energy.h"
#include "symbolic/functions.h"
#include "symbolic/singular_values.h"
#include "symbolic/tensor.h"

namespace ergon {

// Exact values of symbols by name, components column by column.
using ExactInputs = std::map<std::string, std::vector<cln::cl_RA>>;

// The exact value of a decimal literal: "0.5", "1e-24".
cln::cl_RA exact_decimal(const std::string& text);

// The value for a component of a symbol. Throws std::invalid_argument naming the symbol when `inputs` lacks it or holds
// another number of components.
const cln::cl_RA& exact_input(const ExactInputs& inputs, const Symbol& symbol, int component);

// A real number, or the mark that an operation had no real and finite result.
struct ClnNumber {
  cln::cl_R value;
  bool defined = true;
};

// The nearest double; NaN when not defined.
double to_double(const ClnNumber& number);

class ClnAlgebra {
 public:
  using Scalar = ClnNumber;

  ClnAlgebra(const ExactInputs& inputs, int digits)
      : inputs_(inputs), format_(cln::float_format(static_cast<uintptr_t>(digits))) {}

  Scalar number(const std::string& decimal) const;
  Scalar pi() const { return {cln::pi(format_)}; }
  Scalar add(const Scalar& a, const Scalar& b) const;
  Scalar subtract(const Scalar& a, const Scalar& b) const;
  Scalar multiply(const Scalar& a, const Scalar& b) const;
  Scalar divide(const Scalar& a, const Scalar& b) const;
  Scalar negate(const Scalar& a) const { return {-a.value, a.defined}; }
  Scalar power(const Scalar& a, long num, long den) const;
  Scalar power(const Scalar& a, const Scalar& b) const;
  Scalar call(Function f, const std::vector<Scalar>& arguments) const;
  Scalar input(const Symbol& symbol, int component) const;
  std::vector<Scalar> stretches(const Tensor<Scalar>& F) const;
  // Of a matrix whose singular values are neither equal nor zero, and as near to F as half of the digits tell.
  Decomposed<Scalar> decompose_apart(const std::vector<Scalar>& F) const;
  void named(const std::string&, int, int, const Scalar&) const {}

  bool is_zero(const Scalar& a) const;
  bool less(const Scalar& a, const Scalar& b) const { return a.defined && b.defined && a.value < b.value; }

 private:
  cln::cl_F rounded(const cln::cl_R& x) const { return cln::cl_float(x, format_); }
  cln::cl_R function(Function f, const cln::cl_F& x) const;
  cln::cl_R log1p(const cln::cl_F& x) const;
  cln::cl_R expm1(const cln::cl_F& x) const;
  Decomposed<Scalar> decomposed(const std::vector<Scalar>& F, bool apart) const;

  const ExactInputs& inputs_;
  cln::float_format_t format_;
};

}  // namespace ergon
