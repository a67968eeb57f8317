#pragma once
// GiNaC expressions as an algebra: rational numbers stay exact, symbols stay symbols. This header is slow to compile.

#include <ginac/ginac.h>

#include <map>
#include <string>
#include <vector>

#include "symbolic/cln_algebra.h"
#include "symbolic/energy.h"
#include "symbolic/functions.h"

namespace ergon {

class GinacAlgebra {
 public:
  using Scalar = GiNaC::ex;

  // Symbols of the energy that are named in `values` are replaced by them; the others stay symbolic, and are known to
  // be positive where their range says so.
  explicit GinacAlgebra(ExactInputs values = {}) : values_(std::move(values)) {}

  Scalar number(const std::string& decimal) const { return GiNaC::numeric(exact_decimal(decimal)); }
  Scalar pi() const { return GiNaC::Pi; }
  Scalar add(const Scalar& a, const Scalar& b) const { return a + b; }
  Scalar subtract(const Scalar& a, const Scalar& b) const { return a - b; }
  Scalar multiply(const Scalar& a, const Scalar& b) const { return a * b; }
  Scalar divide(const Scalar& a, const Scalar& b) const { return a / b; }
  Scalar negate(const Scalar& a) const { return -a; }
  Scalar power(const Scalar& a, long num, long den) const { return GiNaC::pow(a, GiNaC::numeric(num, den)); }
  Scalar power(const Scalar& a, const Scalar& b) const { return GiNaC::pow(a, b); }
  Scalar call(Function f, const std::vector<Scalar>& arguments) const;
  Scalar input(const Symbol& symbol, int component);
  void named(const std::string& let, int component, int size, const Scalar& value);

  // Of a matrix of numbers that is diagonal, such as the undeformed F: first derivatives of symmetric functions of the
  // singular values follow from it. Throws std::domain_error for any other.
  Decomposed<Scalar> decompose_apart(const std::vector<Scalar>& F) const;

  bool is_zero(const Scalar& a) const { return a.is_zero(); }
  // Throws std::domain_error when that depends on a symbol.
  bool less(const Scalar& a, const Scalar& b) const;

  const std::map<std::string, std::vector<GiNaC::ex>>& symbols() const { return symbols_; }
  const std::map<std::string, std::vector<GiNaC::ex>>& lets() const { return lets_; }

 private:
  ExactInputs values_;
  std::map<std::string, std::vector<GiNaC::ex>> symbols_;  // components that were asked for, column by column
  std::map<std::string, std::vector<GiNaC::ex>> lets_;
};

// An energy as GiNaC expressions over its symbols.
struct SymbolicEnergy {
  GiNaC::ex value;
  std::vector<GiNaC::ex> active;   // margins
  std::vector<GiNaC::ex> require;  // margins
  std::map<std::string, std::vector<GiNaC::ex>> symbols;
  std::map<std::string, std::vector<GiNaC::ex>> lets;
};

SymbolicEnergy to_ginac(const Energy& energy, const std::string& case_name);

}  // namespace ergon
