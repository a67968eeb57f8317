// Small vibrations of a cantilever, by the tangent and the masses that time steps use.

#include <fmt/format.h>

#include <cmath>

#include "tools/verify/beams.h"
#include "tools/verify/modes.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

constexpr double roots[] = {1.8751040687, 4.6940911330, 7.8547574382};  // of cos(x) cosh(x) = -1

std::vector<BeamAnswer> frequencies(Beam& beam) {
  const std::vector<double> found = lowest_frequencies(beam.model, beam.mass, 3);
  // A wide sheet twists at a lower frequency than that of the third mode.
  const size_t modes = dimension_of(beam.model.mesh().element) == 2 ? 2 : 3;
  std::vector<BeamAnswer> out;
  for (size_t k = 0; k < modes; ++k) {
    const double reference = roots[k] * roots[k];
    out.push_back({fmt::format("mode {}, omega/sqrt(EI/(rho A L^4))", k + 1), found[k], reference,
                   reference * std::sqrt(beam.stiffness)});
  }
  return out;
}

void run(const VerifyRows& rows) {
  compare_beam({.element = Element::edge2, .along = 80}, frequencies, rows);
  compare_beam({.element = Element::hex27, .along = 40}, frequencies, rows);
  if (rows.quick()) return;
  compare_hinges({.element = Element::tri3, .along = 80}, frequencies, rows);
  for (const Sheet sheet : {Sheet::right_angled_hinges, Sheet::alternating_hinges})
    compare_hinges({.element = Element::tri3, .along = 80, .sheet = sheet}, frequencies, rows);
  compare_beam({.element = Element::tri3, .along = 80, .sheet = Sheet::koiter}, frequencies, rows);
  compare_beam({.element = Element::hex20, .along = 40}, frequencies, rows);
  for (const Element element : {Element::tet10, Element::hex8, Element::tet4})
    compare_beam({.element = element, .along = 80}, frequencies, rows);
}

}  // namespace

VerifyCase cantilever_frequencies_case() {
  return {"cantilever_frequencies", "the first three bending frequencies of a slender beam",
          "Euler-Bernoulli beam, cos(beta L) cosh(beta L) = -1: Rao 2007, Vibration of continuous systems", run};
}

}  // namespace ergon
