// What a density does as it collapses: its value on the way to where a length is nothing.

#include <fmt/format.h>

#include <cmath>

#include "symbolic/elaborate.h"
#include "symbolic/exact_checks.h"
#include "symbolic/sample_states.h"
#include "symbolic/state_text.h"
#include "symbolic/typing.h"

namespace ergon {

std::optional<Finding> check_collapse(const Energy& energy, const std::string& case_name) {
  if (energy.kind != Energy::Kind::density) return std::nullopt;
  StateSampler sampler;
  ExactInputs inputs = sampler.any(energy);
  const Shape shape = energy.symbols[0].shape;
  const Rational million(1000000);
  // At 1e-6, 1e-12 and 1e-18 of the length along the first axis.
  Rational left = Rational(1);
  double value[3];  // infinite where it is above all doubles
  for (double& at : value) {
    left = left / million;
    std::vector<Rational> F = undeformed(shape);
    F[0] = left;
    inputs.at("F") = F;
    ClnAlgebra numbers(inputs, 60);
    const ClnNumber found = elaborate(energy, case_name, numbers).value;
    if (!found.defined) return std::nullopt;  // check_defined and check_inversion tell
    at = to_double(found);
  }
  const char* when = "as the length along one axis falls to 0";
  // A logarithm grows by as much each time, a power by more; what has a limit hardly changes any more.
  const double first = value[1] - value[0], second = value[2] - value[1];
  if (std::isinf(value[2]) ? value[2] > 0 : second > 0.5 * first && first > 0)
    return Finding{Severity::ok, "collapse", fmt::format("the value grows without bound {}", when), {}, ""};
  if (std::isinf(value[2]) || (second < 0.5 * first && first < 0))
    return Finding{Severity::warning, "collapse",
                   fmt::format("the value falls without bound {}; add what resists the loss of volume", when),
                   start_of(*energy.value), state_text(energy, inputs)};
  return Finding{Severity::ok, "collapse", fmt::format("the value stays finite {}", when), {}, ""};
}

}  // namespace ergon
