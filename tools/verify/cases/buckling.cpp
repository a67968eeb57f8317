// Loads at which straight beams give way: pressed at the tip, standing under their own weight, and bent edgewise.

#include <fmt/format.h>

#include <cmath>

#include "runtime/mesh/load_shares.h"
#include "runtime/mesh/mesh_build.h"
#include "tools/verify/beams.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

// `load` of 1 N spread as the beam's `shares` are, along it.
double gives_way(Beam& beam, const Eigen::VectorXd& shares, double about) {
  const int load = beam.model.add_load(shares, Eigen::Vector3d::Zero());
  const auto press = [&](double size) { beam.model.set_load(load, {-size, 0, 0}); };
  const double critical = critical_load(beam.model, press, 0.8 * about, 1.2 * about, 2);
  press(0);
  beam.model.to_rest();
  return critical;
}

std::vector<BeamAnswer> critical_loads(Beam& beam) {
  constexpr double euler = M_PI * M_PI / 4, greenhill = 7.83735;
  const double pressed = gives_way(beam, beam.tip, euler), stands = gives_way(beam, beam.length, greenhill);
  return {{"Euler load P L^2/EI", pressed, euler, euler * beam.stiffness},
          {"Greenhill's weight rho g A L^3/EI", stands, greenhill, greenhill * beam.stiffness}};
}

// A strip on edge, 1 m long; nu = 0.
void lateral(Element element, std::array<int, 3> cells, const VerifyRows& rows) {
  constexpr double depth = 0.05, thickness = 0.00125, young = 1e9, reference = 4.01260;
  const double minor = depth * std::pow(thickness, 3) / 12;
  // Saint-Venant's torsion of a rectangle: Timoshenko, Goodier 1970, Theory of elasticity.
  double series = 0;
  for (int n = 1; n < 20; n += 2) series += std::tanh(n * M_PI * depth / (2 * thickness)) / std::pow(n, 5);
  const double torsion =
      depth * std::pow(thickness, 3) / 3 * (1 - 192 / std::pow(M_PI, 5) * thickness / depth * series);
  const double unit = young * std::sqrt(minor * torsion / 2);  // sqrt(EI GJ), N m^2
  Model model(box_mesh(element, {1, thickness, depth}, cells));
  const Mesh& mesh = model.mesh();
  model.add("st_venant_kirchhoff", {{"E", {young}}, {"nu", {0.0}}});
  // Clamped, but free to warp, as the theory has it: warping is nothing along both middle lines of the face.
  model.hold(vertices_where(mesh, [](const Eigen::Vector3d& X) { return X[0] < 1e-9; }), "yz");
  model.hold(vertices_where(mesh,
                            [](const Eigen::Vector3d& X) {
                              return X[0] < 1e-9 &&
                                     (std::fabs(X[1] - thickness / 2) < 1e-9 || std::fabs(X[2] - depth / 2) < 1e-9);
                            }),
             "x");
  // At the centroid of the end: along the middle line of its face.
  const std::vector<int> centre = vertices_where(mesh, [&](const Eigen::Vector3d& X) {
    return X[0] > 1 - 1e-9 && std::fabs(X[2] - depth / 2) < 1e-9 && std::fabs(X[1] - thickness / 2) < 1e-9;
  });
  const int load = model.add_load(load_shares(mesh, centre).shares, Eigen::Vector3d::Zero());
  const double critical = critical_load(
      model,
      [&](double size) {
        model.set_load(load, {0, 0, -size * unit});
      },
      0.8 * reference, 1.2 * reference, 1);
  rows.add({"lateral buckling P L^2/sqrt(EI GJ)", name_of(element),
            fmt::format("{}x{}x{}", cells[0], cells[1], cells[2]), critical, reference});
}

void run(const VerifyRows& rows) {
  compare_beam({.element = Element::edge2, .along = 40}, critical_loads, rows);
  compare_beam({.element = Element::hex27, .along = 10, .height = 0.02}, critical_loads, rows);
  if (rows.quick()) return;
  compare_hinges({.element = Element::tri3, .along = 80}, critical_loads, rows);
  compare_beam({.element = Element::tri3, .along = 80, .sheet = Sheet::koiter}, critical_loads, rows);
  compare_beam({.element = Element::hex20, .along = 10, .height = 0.02}, critical_loads, rows);
  lateral(Element::hex27, {40, 1, 8}, rows);
}

}  // namespace

VerifyCase buckling_case() {
  return {"buckling", "critical loads of columns and of a strip bent edgewise",
          "Timoshenko, Gere 1961, Theory of elastic stability; the zero of Bessel's J_(-1/3) "
          "for a column under its weight (Greenhill 1881)",
          run};
}

}  // namespace ergon
