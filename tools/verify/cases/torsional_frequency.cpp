// Small torsional vibrations of a square column, by the tangent and the masses that time steps use: whether these keep
// the moments of inertia of cells.

#include <fmt/format.h>

#include <cmath>

#include "runtime/mesh/consistent_mass.h"
#include "runtime/mesh/mesh_build.h"
#include "runtime/mesh/mesh_tools.h"
#include "tools/verify/modes.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

constexpr double side = 0.1, length = 2, density = 1000, E = 1e6, nu = 0.3;  // m, kg/m^3, Pa

// The torsional constant of a square with sides of 1: Prandtl's function on it as a series.
double torsional_constant() {
  double sum = 0;
  for (int n = 1; n < 200; n += 2) sum += std::tanh(n * M_PI / 2) / std::pow(n, 5);
  return 1.0 / 3 - 64 / std::pow(M_PI, 5) * sum;
}

void compare(Element element, int along, int across, bool lumped, const VerifyRows& rows) {
  Mesh mesh = box_mesh(element, {length, side, side}, {along, across, across});
  mesh.X.colwise() -= Eigen::Vector3d(0, side / 2, side / 2);
  Model model(mesh);
  model.add("linear_elasticity", {{"E", {E}}, {"nu", {nu}}});
  // An end that does not turn but is free to warp, and an axis that does not move, as it does not where a column
  // twists.
  model.hold(vertices_where(mesh, [](const Eigen::Vector3d& X) { return X[0] < 1e-9; }), "yz");
  model.hold(vertices_where(mesh, [](const Eigen::Vector3d& X) { return std::hypot(X[1], X[2]) < 1e-9; }));
  const CoupledMass::Matrix mass =
      lumped ? CoupledMass::Matrix(lumped_masses(mesh, density).asDiagonal()) : mass_matrix(mesh, density);
  const double omega = lowest_frequencies(model, mass, 1)[0];
  const double shear = E / (2 * (1 + nu));
  const double polar = 1.0 / 6;  // moment of area of that square
  const double exact = M_PI / (2 * length) * std::sqrt(shear / density * torsional_constant() / polar);
  VerifyRow row{"omega/omega of St. Venant's torsion", name_of(element), fmt::format("{}x{}x{}", along, across, across),
                omega / exact, 1};
  if (lumped) {
    row.quantity += ", lumped";
    row.bound.reset();
    row.note = "masses as with mass = \"lumped\": their moment of inertia is not that of the section";
  } else if (degree_of(element) == 1 && across < 8) {
    // Masses at the corners of n x n squares have a polar moment of (1 + 2/n^2)/6.
    row.bound.reset();
    row.note = fmt::format(
        "{0} cells across: masses at corners have {1:g} times the section's moment of inertia, and it "
        "warps too little",
        across, 1 + 2.0 / (across * across));
  } else if (element == Element::tet10 && across == 2) {
    row.bound.reset();
    row.note = "a coarser mesh: two cells of tetrahedra across";
  }
  rows.add(row);
  if (!lumped) return;
  const Eigen::VectorXd masses = mass * Eigen::VectorXd::Ones(mass.cols());
  const double inertia =
      masses.dot(mesh.X.bottomRows<2>().colwise().squaredNorm()) / (density * length * polar * std::pow(side, 4));
  row.quantity = "the same, by the moment of the masses";
  row.value *= std::sqrt(inertia);
  row.bound = 0.01;
  row.note = fmt::format("masses that have {:.4g} times the moment of inertia of the section", inertia);
  rows.add(row);
}

void run(const VerifyRows& rows) {
  compare(Element::hex20, 10, 2, false, rows);
  compare(Element::hex20, 10, 2, true, rows);
  if (rows.quick()) return;
  compare(Element::tet10, 20, 2, false, rows);
  compare(Element::tet10, 40, 4, false, rows);
  compare(Element::tet10, 40, 4, true, rows);
  compare(Element::hex27, 10, 2, false, rows);
  compare(Element::hex8, 40, 2, false, rows);
  compare(Element::hex8, 40, 4, false, rows);
  compare(Element::hex8, 80, 8, false, rows);
}

}  // namespace

VerifyCase torsional_frequency_case() {
  return {"torsional_frequency", "the first torsional frequency of a square column of two cells across",
          "St. Venant's torsion, omega = pi/(2 L) sqrt(G J/(rho I)), J of a square by its series", run};
}

}  // namespace ergon
