#pragma once
// The meaning of an energy, written once and interpreted in any algebra: a graph being built, exact symbols, 50-digit
// numbers with derivatives, plain doubles. Lets are elaborated once each, in their order, and shared.
//
// An algebra A supplies
//   using Scalar = ...;                              copyable
//   Scalar number(const std::string& decimal);       an exact literal: "2", "0.5", "1e-24"
//   Scalar pi();                                     optional: where a double's digits are not enough
//   Scalar add(a, b), subtract(a, b), multiply(a, b), divide(a, b), negate(a);
//   Scalar power(a, long num, long den);             constant rational exponent in lowest terms, den > 0
//   Scalar power(a, b);                              any other exponent
//   Scalar call(Function f, const std::vector<Scalar>& arguments);
//   Scalar input(const Symbol& symbol, int component);          column by column
//   void named(const std::string& let, int component, int size, const Scalar& value);   a let's component was formed;
//                                                    it may return a Scalar that stands for it from then on
//   std::vector<Scalar> stretches(const Tensor<Scalar>& F);     optional: the singular values of F, of which one that
//                                                    lacks them throws std::domain_error
// and, when it wants to know where it is in the text,
//   void at(const Expression& e);                              the operations that follow are those of e
//   void formed(const Expression& e, const std::vector<Scalar>& components);   the result of e

#include <map>
#include <string>
#include <vector>

#include "symbolic/energy.h"
#include "symbolic/functions.h"
#include "symbolic/tensor.h"

namespace ergon {

template <class S>
struct Elaborated {
  S value;
  std::vector<S> active;   // margins: positive where the condition holds
  std::vector<S> require;  // margins
  std::vector<S> update;   // components of the new values of Energy::updates, one after the other
};

// `case_name` must be one of energy.cases, or "" when the energy has none.
template <class A>
Elaborated<typename A::Scalar> elaborate(const Energy& energy, const std::string& case_name, A& algebra);

// One expression that type_of() has seen (symbolic/typing.h), of names that have these values.
template <class A>
Tensor<typename A::Scalar> evaluate(const Expression& expression,
                                    const std::map<std::string, Tensor<typename A::Scalar>>& names, A& algebra);

}  // namespace ergon

#include "symbolic/elaborate_impl.h"
