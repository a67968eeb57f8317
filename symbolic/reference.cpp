#include "symbolic/reference.h"

#include <cln/dfloat.h>

#include <cmath>
#include <stdexcept>

#include "symbolic/cln_algebra.h"
#include "symbolic/elaborate.h"
#include "symbolic/jet.h"
#include "symbolic/stretches.h"

namespace ergon {
namespace {

ExactInputs exact(const Inputs& inputs) {
  ExactInputs result;
  for (const auto& [name, values] : inputs) {
    for (const double value : values) {
      if (!std::isfinite(value)) throw std::invalid_argument("the value of '" + name + "' is not finite");
      result[name].push_back(cln::rational(cln::cl_DF(value)));
    }
  }
  return result;
}

}  // namespace

ReferenceValue evaluate_reference(const Energy& energy, const std::string& case_name, const Inputs& inputs,
                                  int digits) {
  return evaluate_reference_at(energy, case_name, exact(inputs), digits);
}

ReferenceValue evaluate_reference_at(const Energy& energy, const std::string& case_name, const ExactInputs& values,
                                     int digits) {
  ClnAlgebra numbers(values, digits_for_derivatives(energy, digits));
  JetAlgebra<ClnAlgebra> jets(energy, numbers);
  const Elaborated<Jet<ClnNumber>> result = elaborate(energy, case_name, jets);

  const auto n = static_cast<size_t>(jets.variables());
  ReferenceValue reference;
  reference.value = to_double(result.value.value);
  reference.gradient.assign(n, 0.0);
  reference.hessian.assign(n * n, 0.0);
  for (size_t i = 0; i < result.value.gradient.size(); ++i) reference.gradient[i] = to_double(result.value.gradient[i]);
  if (!result.value.hessian.empty()) {
    for (size_t i = 0, k = 0; i < n; ++i)
      for (size_t j = 0; j <= i; ++j, ++k)
        reference.hessian[i * n + j] = reference.hessian[j * n + i] = to_double(result.value.hessian[k]);
  }
  for (const auto& margin : result.active) reference.active.push_back(to_double(margin.value));
  for (const auto& margin : result.require) reference.require.push_back(to_double(margin.value));
  for (const auto& component : result.update) reference.update.push_back(to_double(component.value));
  return reference;
}

}  // namespace ergon
