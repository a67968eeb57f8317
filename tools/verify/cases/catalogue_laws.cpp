// Every hyperelastic law of the catalogue, under the tests that laboratories make: one element, the stress that holds
// it against that of the law as it is written, evaluated with 50 digits on a path that shares nothing with the compiler
// or the runtime but the text of the law.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "symbolic/reference.h"
#include "tools/installation.h"
#include "tools/law_point.h"
#include "tools/load_path.h"
#include "tools/verify/model.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

// The corners of the unit simplex: F is the difference of its points, and their forces are the stress times its volume.
Mesh unit_simplex(int dimension) {
  constexpr Element elements[] = {Element::edge2, Element::tri3, Element::tet4};
  Mesh mesh;
  mesh.element = elements[dimension - 1];
  mesh.X = Eigen::Matrix3Xd::Zero(3, dimension + 1);
  for (int k = 0; k < dimension; ++k) mesh.X(k, k + 1) = 1;
  for (int k = 0; k <= dimension; ++k) mesh.cells.push_back(k);
  return mesh;
}

// From the undeformed state in small steps; component c of F is coordinate c % 3 of point c/3 + 1.
double stress_of_element(const Energy& energy, const Parameters& data, const LoadPath& path, double stretch) {
  const int dimension = static_cast<int>(path.start.size()) / 3;
  Model model(unit_simplex(dimension));
  model.add(energy.name, data);
  model.hold({0});
  for (int c = 0; c < path.start.size(); ++c)
    if (std::find(path.free.begin(), path.free.end(), c) == path.free.end())
      model.hold({c / 3 + 1}, std::string(1, "xyz"[c % 3]));
  constexpr int steps = 5;
  for (int step = 1; step <= steps; ++step) {
    const Eigen::VectorXd F = path.start + (path.rest + (stretch - path.rest) * step / steps) * path.direction;
    for (int c = 0; c < F.size(); ++c)
      if (std::find(path.free.begin(), path.free.end(), c) == path.free.end()) model.x(c % 3, c / 3 + 1) = F[c];
    if (!path.free.empty()) model.solve(1e-12);
  }
  const Eigen::Matrix3Xd forces = model.reactions();
  constexpr double volumes[] = {1, 1.0 / 2, 1.0 / 6};
  double sum = 0;
  for (const auto& [c, weight] : path.measured) sum += weight * forces(c % 3, c / 3 + 1) / volumes[dimension - 1];
  return sum;
}

double stress_of_reference(const Energy& energy, const Parameters& data, const LoadPath& path,
                           const Eigen::VectorXd& F) {
  Inputs inputs(data.begin(), data.end());
  inputs[energy.with_role(Role::dof).front()->name] = std::vector<double>(F.begin(), F.end());
  const ReferenceValue at = evaluate_reference(energy, "", inputs);
  double sum = 0;
  for (const auto& [c, weight] : path.measured) sum += weight * at.gradient[static_cast<size_t>(c)];
  return sum;
}

void compare(const Energy& energy, const LoadPath& path, double stretch, const VerifyRows& rows) {
  const Parameters data = usual_data(energy, {});
  const LawPoint law(energy, "", data);
  const std::optional<LoadState> state = along(law, path, {stretch}).front();
  if (!state) return;  // the law alone has no equilibrium there
  const double reference = stress_of_reference(energy, data, path, state->F);
  if (reference == 0) return;
  VerifyRow row{.quantity = fmt::format("{} {:g}, stress (Pa{})", path.name, stretch,
                                        energy.geometry == "membrane" ? " m"
                                        : energy.geometry == "line"   ? " m^2"
                                                                      : ""),
                .element = energy.name,
                .mesh = name_of(unit_simplex(static_cast<int>(path.start.size()) / 3).element),
                .reference = reference,
                .bound = 1e-7};
  try {
    row.value = stress_of_element(energy, data, path, stretch);
  } catch (const std::runtime_error& failure) {
    row.note = failure.what();
  }
  rows.add(row);
}

void run(const VerifyRows& rows) {
  for (const std::string& name : catalogue_names()) {
    const Energy energy = find_energy(name);
    if (energy.kind != Energy::Kind::density || !energy.with_role(Role::rest).empty() ||
        !energy.with_role(Role::lag).empty())
      continue;
    for (const LoadPath& path : load_paths(energy.geometry)) {
      // A part of a sum has no stiffness of its own in every direction: nothing of F can be left free.
      if (!energy.part_of.empty() && !path.free.empty()) continue;
      compare(energy, path, path.name == "simple_shear" ? 0.4 : 1.25, rows);
      if (path.name == "uniaxial") compare(energy, path, 0.8, rows);
    }
  }
}

}  // namespace

VerifyCase catalogue_laws_case() {
  return {
      "catalogue_laws", "uniaxial, equibiaxial and shear tests of every hyperelastic law",
      "the text of each law in 50 digits (its paper is named in its file); tests: Treloar 1944, Trans. Faraday Soc. 40",
      run};
}

}  // namespace ergon
