#pragma once
// Which part of an energy's text answers for what was found at a state.

#include <vector>

#include "symbolic/cln_algebra.h"
#include "symbolic/energy.h"

namespace ergon {

// The first part, in the order of evaluation, whose value or derivatives by dofs are not real and finite; nullptr when
// there is none.
const Expression* first_undefined(const Energy& energy, const std::string& case_name, const ExactInputs& inputs);

// The innermost scalar part of the value that is not the same in two states, through parts that all differ.
const Expression& first_change(const Energy& energy, const std::string& case_name, const ExactInputs& a,
                               const ExactInputs& b);

// The terms of the value as a sum, with their signs, and each term's derivative by one component of the dofs.
struct ValueTerm {
  const Expression* expression;
  double value;
  double derivative;
};
std::vector<ValueTerm> terms_at(const Energy& energy, const std::string& case_name, const ExactInputs& inputs,
                                size_t component);

}  // namespace ergon
