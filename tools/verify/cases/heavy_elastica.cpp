// A clamped beam under its own weight: how far its tip hangs down, by how far it reaches.

#include <fmt/format.h>

#include "tools/verify/beams.h"
#include "tools/verify/elastica.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

struct HangingState {
  double load, ratio;  // rho g A L^3/(EI), drop over reach
};
constexpr HangingState states[] = {{1, 0.1246}, {10, 1.0668}, {100, 5.8881}};

std::vector<BeamAnswer> ratios(Beam& beam) {
  const int load = beam.model.add_load(beam.length, Eigen::Vector3d::Zero());
  double reached = 0;
  std::vector<BeamAnswer> out;
  for (const HangingState& state : states) {
    while (reached < state.load) {
      reached = std::min(state.load, reached + std::max(1.0, reached / 4));
      beam.model.set_load(load, {0, 0, -reached});
      beam.model.solve(1e-7);
    }
    const Eigen::Vector3d tip = beam.tip_place();
    const double middle = beam.model.mesh().X.row(2).dot(beam.tip);
    const ElasticaTip stiff = heavy_elastica_tip(state.load / beam.stiffness);
    out.push_back({fmt::format("H/W at rho g A L^3/EI = {:g}", state.load), (middle - tip.z()) / tip.x(), state.ratio,
                   stiff.down / (1 - stiff.back)});
  }
  return out;
}

void run(const VerifyRows& rows) {
  compare_beam({.element = Element::edge2, .along = 80}, ratios, rows);
  compare_beam({.element = Element::hex27, .along = 80, .height = 0.005}, ratios, rows);
  if (rows.quick()) return;
  compare_hinges({.element = Element::tri3, .along = 80}, ratios, rows);
  compare_beam({.element = Element::tri3, .along = 80, .sheet = Sheet::koiter}, ratios, rows);
  for (const Element element : {Element::tet10, Element::hex8, Element::tet4})
    compare_beam({.element = element, .along = 80, .height = 0.005}, ratios, rows);
}

}  // namespace

VerifyCase heavy_elastica_case() {
  return {"heavy_elastica", "a cantilever under its own weight",
          "theta'' = -Gamma (1 - s) cos(theta), as Romero, Ly, Rasheed, Charrondiere, Lazarus, Neukirch, "
          "Bertails-Descoubes "
          "2021, Physical validation of simulators in computer graphics, TOG 40(4), test Cantilever",
          run};
}

}  // namespace ergon
