#pragma once
// Where an energy may fail to be smooth. Its functions are smooth but at certain arguments (abs at 0, the divisor of a
// quotient at 0, ...): this algebra keeps, for every such place of the text, the quantity that is zero there, with its
// first derivatives by all symbols.

#include <utility>
#include <vector>

#include "symbolic/elaborate.h"
#include "symbolic/jet.h"

namespace ergon {

enum class Cause { division, root, power, logarithm, absolute, extremum, angle, cut, arc, tangent };

// One operation of an expression; its `ordinal` counts the operations with such a quantity within the expression.
struct CriticalSite {
  const Expression* expression = nullptr;
  int ordinal = 0;
  Cause cause = Cause::division;
  bool operator==(const CriticalSite&) const = default;
};

template <class B>
class CriticalAlgebra : public JetAlgebra<B> {
 public:
  using Jets = JetAlgebra<B>;
  using Scalar = typename Jets::Scalar;
  using Record = std::pair<CriticalSite, Scalar>;

  // Where values alone are asked for, derivatives by none are much cheaper.
  CriticalAlgebra(const Energy& energy, B& base, typename Jets::Variables variables = Jets::Variables::all)
      : Jets(energy, base, Jets::Order::first, variables) {}

  void at(const Expression& e) {
    expression_ = &e;
    ordinal_ = 0;
  }

  Scalar divide(const Scalar& x, const Scalar& y) {
    keep(Cause::division, y);
    return Jets::divide(x, y);
  }

  Scalar power(const Scalar& x, long num, long den) {
    if (num < 0 || den > 1) keep(den == 2 ? Cause::root : Cause::power, x);
    return Jets::power(x, num, den);
  }

  Scalar power(const Scalar& x, const Scalar& y) {
    keep(Cause::power, x);
    return Jets::power(x, y);
  }

  Scalar call(Function f, const std::vector<Scalar>& x) {
    const Scalar one = this->number("1");
    if (f == Function::sqrt) keep(Cause::root, x[0]);
    if (f == Function::log) keep(Cause::logarithm, x[0]);
    if (f == Function::log1p) keep(Cause::logarithm, this->add(one, x[0]));
    if (f == Function::abs) keep(Cause::absolute, x[0]);
    if (f == Function::min || f == Function::max) keep(Cause::extremum, this->subtract(x[0], x[1]));
    if (f == Function::tan) keep(Cause::tangent, Jets::call(Function::cos, {x[0]}));
    if (f == Function::asin || f == Function::acos)
      keep(Cause::arc, this->multiply(this->subtract(one, x[0]), this->add(one, x[0])));
    if (f == Function::atan2) {
      keep(Cause::angle, this->add(this->multiply(x[0], x[0]), this->multiply(x[1], x[1])));
      keep(Cause::cut, x[0]);  // where the other argument is negative
    }
    return Jets::call(f, x);
  }

  const std::vector<Record>& records() const { return records_; }

 private:
  void keep(Cause cause, const Scalar& quantity) {
    if (expression_ != nullptr) records_.push_back({{expression_, ordinal_++, cause}, quantity});
  }

  const Expression* expression_ = nullptr;
  int ordinal_ = 0;
  std::vector<Record> records_;
};

}  // namespace ergon
