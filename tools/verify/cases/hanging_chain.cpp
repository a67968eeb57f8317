// A chain that does not stretch hangs between two points of one height.

#include <fmt/format.h>

#include "runtime/mesh/mesh_build.h"
#include "runtime/mesh/mesh_tools.h"
#include "tools/verify/model.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

void compare(Element element, int cells, double length, double reference, const VerifyRows& rows) {
  Model model(box_mesh(element, {length, 1, 1}, {cells, 1, 1}));
  const Mesh& mesh = model.mesh();
  constexpr double weight = 1;  // N/m
  model.add("rod_stretching", {{"EA", {1e4 * weight}}});
  model.add_load(lumped_masses(mesh, 1), {0, 0, -weight});
  const double depth = std::sqrt(length * length - 1) / 2;
  // Two straight legs, which have the right length.
  for (int v = 0; v < mesh.vertices(); ++v) {
    const double s = mesh.X(0, v) / length;
    model.x.col(v) = Eigen::Vector3d(s, 0, -2 * depth * std::min(s, 1 - s));
  }
  model.hold(vertices_where(mesh, [](const Eigen::Vector3d&) { return true; }), "y");
  model.hold(vertices_where(mesh, [&](const Eigen::Vector3d& X) { return X[0] < 1e-9 || X[0] > length - 1e-9; }));
  model.solve(1e-8);
  rows.add({fmt::format("sag/span, length/span {:g}", length), name_of(element), std::to_string(cells),
            -model.x.row(2).minCoeff(), reference});
}

void run(const VerifyRows& rows) {
  constexpr double states[][2] = {{1.05, 0.139304}, {1.2, 0.292344}, {1.5, 0.502633}, {2, 0.796388}};
  for (const auto& [length, sag] : states) compare(Element::edge2, 40, length, sag, rows);
}

}  // namespace

VerifyCase hanging_chain_case() {
  return {
      "hanging_chain", "a chain between two points",
      "catenary: sinh(b)/b = length/span, sag/span = (cosh(b) - 1)/(2 b): Routh 1891, Treatise on analytical statics",
      run};
}

}  // namespace ergon
