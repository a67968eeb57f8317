// Torsion: the torque of a square column at a small twist, whose sections warp, and of a round column of rubber at a
// large one, which stays a cylinder.

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "runtime/mesh/mesh_build.h"
#include "tools/verify/meshes.h"
#include "tools/verify/model.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

double torque(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& forces, const std::vector<int>& vertices) {
  double sum = 0;
  for (const int v : vertices) sum += x(0, v) * forces(1, v) - x(1, v) * forces(0, v);
  return sum;
}

std::vector<int> end_of(const Mesh& mesh, double z) {
  return vertices_where(mesh, [z](const Eigen::Vector3d& X) { return std::fabs(X[2] - z) < 1e-9; });
}

void turn(Model& model, const std::vector<int>& vertices, double angle) {
  for (const int v : vertices) model.x.col(v).head<2>() = Eigen::Rotation2Dd(angle) * model.mesh().X.col(v).head<2>();
}

// Ends turn in their planes and are free to warp: Saint-Venant's torsion without any end effect.
void square(Element element, int n, std::optional<double> bound, const VerifyRows& rows) {
  constexpr double height = 2, twist = 1e-6, young = 1e6, poisson = 0.3;
  Mesh mesh = box_mesh(element, {1, 1, height}, {n, n, n / 2});
  mesh.X.topRows<2>().array() -= 0.5;
  Model model(std::move(mesh));
  model.add("linear_elasticity", {{"E", {young}}, {"nu", {poisson}}});
  const std::vector<int> low = end_of(model.mesh(), 0), high = end_of(model.mesh(), height);
  model.hold(low, "xy");
  model.hold(high, "xy");
  model.hold({vertex_near(model.mesh(), {0, 0, height / 2})}, "z");
  turn(model, high, twist);
  model.solve(1e-13);
  const double unit = young / (2 * (1 + poisson)) * twist / height;
  rows.add({"square, small twist: torque/(G theta a^4)", name_of(element), fmt::format("{}x{}x{}", n, n, n / 2),
            torque(model.x, model.reactions(), high) / unit, 0.1405770, bound, bound ? "" : "coarse"});
}

// Ends turn as they are, plane and round.
void round(Element element, int n, const VerifyRows& rows) {
  constexpr double mu = 1, height = 2;
  Model model(round_column(element, 1, height, n));
  model.add("isochoric_neo_hookean", {{"mu", {mu}}, {"K", {1000 * mu}}});
  const std::vector<int> low = end_of(model.mesh(), 0), high = end_of(model.mesh(), height);
  model.hold(low);
  model.hold(high);
  double twist = 0;
  for (const double wanted : {0.5, 1.0, 2.0}) {
    for (; twist < wanted - 1e-9; twist += 0.125) {
      // The motion of the whole is foretold, so that Newton starts near.
      for (int v = 0; v < model.mesh().vertices(); ++v)
        model.x.col(v).head<2>() = Eigen::Rotation2Dd(0.125 * model.mesh().X(2, v) / height) * model.x.col(v).head<2>();
      turn(model, high, twist + 0.125);
      model.solve(1e-9);
    }
    rows.add({fmt::format("round, {:g} rad per radius: torque/(mu a^3)", wanted / height), name_of(element),
              fmt::format("{} cells", model.mesh().cell_count()), torque(model.x, model.reactions(), high) / mu,
              M_PI / 2 * wanted / height});
  }
}

void run(const VerifyRows& rows) {
  square(Element::hex8, 8, std::nullopt, rows);
  square(Element::hex27, 4, 0.01, rows);
  round(Element::hex27, 2, rows);
  if (rows.quick()) return;
  square(Element::hex8, 16, 0.01, rows);
  square(Element::hex20, 4, 0.01, rows);
  square(Element::tet10, 4, 0.01, rows);
  round(Element::hex27, 4, rows);
}

}  // namespace

VerifyCase twisted_column_case() {
  return {"twisted_column", "torque of columns at small and large twists",
          "square: Timoshenko, Goodier 1970, Theory of elasticity; round: Rivlin 1949, Large elastic "
          "deformations of isotropic materials VI, Phil. Trans. A 242, for an incompressible neo-Hookean solid",
          run};
}

}  // namespace ergon
