// Small vibrations of a cantilever, by the tangent and the masses that time steps use.

#include <fmt/format.h>

#include <cmath>

#include "tools/verify/beams.h"
#include "tools/verify/modes.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

constexpr double roots[] = {1.8751040687, 4.6940911330, 7.8547574382};  // of cos(x) cosh(x) = -1

void compare(const BeamForm& form, const VerifyRows& rows) {
  Beam beam = make_beam(form);
  const std::vector<double> found = lowest_frequencies(beam.model, beam.mass, 3);
  // A wide sheet twists at a lower frequency than that of the third mode.
  const size_t modes = form.element == Element::tri3 ? 2 : 3;
  for (size_t k = 0; k < modes; ++k)
    rows.add({fmt::format("mode {}, omega/sqrt(EI/(rho A L^4))", k + 1), beam.element, beam.mesh, found[k],
              roots[k] * roots[k], beam.bound(), beam.limits});
  if (beam.locks_by == 1) return;
  for (size_t k = 0; k < modes; ++k)
    rows.add({fmt::format("mode {}, by the stiffness that it locks to", k + 1), beam.element, beam.mesh,
              found[k] / std::sqrt(beam.locks_by), roots[k] * roots[k], 0.01, "see above"});
}

void run(const VerifyRows& rows) {
  compare({.element = Element::edge2, .along = 80}, rows);
  compare({.element = Element::hex27, .along = 40}, rows);
  compare({.element = Element::tri3, .along = 80}, rows);
  if (rows.quick()) return;
  compare({.element = Element::tri3, .along = 80, .right_angled = true}, rows);
  compare({.element = Element::hex20, .along = 40}, rows);
  compare({.element = Element::tet10, .along = 80}, rows);
  compare({.element = Element::hex8, .along = 80}, rows);
  compare({.element = Element::tet4, .along = 80}, rows);
}

}  // namespace

VerifyCase cantilever_frequencies_case() {
  return {"cantilever_frequencies", "the first three bending frequencies of a slender beam",
          "Euler-Bernoulli beam, cos(beta L) cosh(beta L) = -1: Rao 2007, Vibration of continuous systems", run};
}

}  // namespace ergon
