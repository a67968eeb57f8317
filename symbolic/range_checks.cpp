// How far from the undeformed state a solid stays stiff.

#include <fmt/format.h>

#include <cln/dfloat.h>

#include <cmath>

#include "symbolic/double_algebra.h"
#include "symbolic/eigenvalues.h"
#include "symbolic/elaborate.h"
#include "symbolic/exact_checks.h"
#include "symbolic/jet.h"
#include "symbolic/sample_states.h"

namespace ergon {
namespace {

constexpr double least = 0.01, most = 100;

// The smallest eigenvalue of the stiffness against small symmetric strains where these components of F (column by
// column) have this value and all others are those of the undeformed state.
double weakest_stiffness(const Energy& energy, const std::string& case_name, ExactInputs inputs,
                         const std::vector<size_t>& components, double value) {
  inputs.at("F") = undeformed({3, 3});
  for (const size_t component : components) inputs.at("F")[component] = cln::rational(cln::cl_DF(value));
  DoubleAlgebra numbers(inputs);
  JetAlgebra<DoubleAlgebra> jets(energy, numbers);
  const Jet<double> jet = elaborate(energy, case_name, jets).value;
  auto entry = [&](size_t i, size_t j) {
    if (i < j) std::swap(i, j);
    return jet.hessian.empty() ? 0 : jet.hessian[i * (i + 1) / 2 + j];
  };
  std::vector<double> matrix;
  constexpr size_t pairs[6][2] = {{0, 0}, {4, 4}, {8, 8}, {1, 3}, {2, 6}, {5, 7}};
  for (const auto& a : pairs)
    for (const auto& b : pairs)
      matrix.push_back((entry(a[0], b[0]) + entry(a[0], b[1]) + entry(a[1], b[0]) + entry(a[1], b[1])) / 4);
  return symmetric_eigenvalues(matrix, 6).front();
}

}  // namespace

std::optional<Finding> check_range(const Energy& energy, const std::string& case_name) {
  if (energy.kind != Energy::Kind::density || energy.geometry != "solid") return std::nullopt;
  StateSampler sampler;
  ExactInputs inputs = sampler.any(energy);
  std::string params;
  for (const auto& [name, value] : {std::pair("E", Rational(1)), std::pair("nu", Rational(3) / 10)}) {
    const Symbol* symbol = energy.find(name);
    if (symbol == nullptr || !symbol->shape.scalar() || !symbol->range.contains(cln::double_approx(value))) continue;
    inputs.at(name) = {value};
    params += fmt::format("{}{} = {}", params.empty() ? "" : ", ", name, cln::double_approx(value));
  }
  auto stiff = [&](const std::vector<size_t>& components, double value) {
    return weakest_stiffness(energy, case_name, inputs, components, value) > 0;
  };
  if (!stiff({}, 1)) return std::nullopt;  // other checks tell
  auto end = [&](const std::vector<size_t>& components, double first, double factor) {
    double inside = first;
    if (!stiff(components, inside)) return 0.0;
    while (inside * factor > least && inside * factor < most && stiff(components, inside * factor)) inside *= factor;
    double outside = inside * factor;
    if (!(outside > least && outside < most)) return factor < 1 ? least : most;
    for (int i = 0; i < 40; ++i) {
      const double middle = (inside + outside) / 2;
      (stiff(components, middle) ? inside : outside) = middle;
    }
    return inside;
  };
  auto both = [&](const std::vector<size_t>& axes) {
    return fmt::format("{:.3g} to {:.3g}", end(axes, 1, 0.97), end(axes, 1, 1 / 0.97));
  };
  return Finding{
      Severity::ok,
      "stiffness",
      fmt::format("every small strain costs energy from {} times the length along one axis, {} along two, {} "
                  "along three, and up to a shear of {:.3g}{}",
                  both({0}), both({0, 4}), both({0, 4, 8}), end({3}, least, 1 / 0.97),
                  params.empty() ? "" : fmt::format(" ({})", params)),
      {},
      ""};
}

}  // namespace ergon
