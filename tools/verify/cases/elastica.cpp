// Euler's elastica: a clamped beam under a force at its tip that keeps its direction.

#include <fmt/format.h>

#include "tools/verify/beams.h"
#include "tools/verify/elastica.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

struct ElasticaState {
  double load, down, back;  // P L^2/(EI), w/L, u/L
};
constexpr ElasticaState states[] = {
    {1, 0.30172, 0.05643}, {2, 0.49346, 0.16064}, {5, 0.71379, 0.38763}, {10, 0.81061, 0.55500}};

std::vector<BeamAnswer> tips(Beam& beam) {
  const int load = beam.model.add_load(beam.tip, Eigen::Vector3d::Zero());
  double reached = 0;
  std::vector<BeamAnswer> out;
  for (const ElasticaState& state : states) {
    while (reached < state.load) {
      reached = std::min(state.load, reached + 0.5);
      beam.model.set_load(load, {0, 0, -reached});
      beam.model.solve(1e-7);
    }
    const Eigen::Vector3d moved = beam.tip_place() - beam.model.mesh().X * beam.tip;
    const std::string at = fmt::format(" at P L^2/EI = {:g}", state.load);
    const ElasticaTip tip = elastica_tip(state.load / beam.stiffness);
    out.push_back({"w/L" + at, -moved.z(), state.down, tip.down});
    out.push_back({"u/L" + at, -moved.x(), state.back, tip.back});
  }
  return out;
}

void run(const VerifyRows& rows) {
  compare_beam({.element = Element::edge2, .along = 40}, tips, rows);
  compare_beam({.element = Element::hex27, .along = 40}, tips, rows);
  if (rows.quick()) return;
  compare_hinges({.element = Element::tri3, .along = 80}, tips, rows);
  compare_beam({.element = Element::tri3, .along = 80, .sheet = Sheet::koiter}, tips, rows);
  for (const Element element : {Element::hex20, Element::tet10, Element::hex8, Element::tet4})
    compare_beam({.element = element, .along = 40}, tips, rows);
}

}  // namespace

VerifyCase elastica_case() {
  return {"elastica", "large deflections of a cantilever under a dead tip load",
          "Mattiasson 1981, Numerical results from large deflection beam and frame problems analysed by means of "
          "elliptic integrals, IJNME 17",
          run};
}

}  // namespace ergon
