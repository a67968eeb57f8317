// A cylinder between rigid diaphragms, pinched by two opposite forces until their points have moved by most of its
// radius: an eighth of it, by symmetry.

#include <fmt/format.h>

#include <cmath>

#include "runtime/mesh/load_shares.h"
#include "runtime/mesh/mesh_build.h"
#include "tools/verify/meshes.h"
#include "tools/verify/model.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

constexpr double young = 30e3, poisson = 0.3, radius = 100, half_length = 100, thickness = 1, most = 12000;

struct PinchedState {
  double part, down, out;  // P/Pmax, -W of A under the force, U of B a quarter of a turn away
};
constexpr PinchedState states[] = {
    {0.1, 23.164, -2.391}, {0.2, 56.373, 10.448}, {0.5, 73.790, 25.381}, {1, 83.102, 34.272}};

Mesh eighth(Element element, int n) {
  if (dimension_of(element) == 3) return pipe_sector(element, radius, thickness, half_length, M_PI / 2, n, n);
  Mesh mesh = alternating_triangles(element, {half_length, M_PI / 2, 1}, {n, n, 1});
  for (int v = 0; v < mesh.vertices(); ++v)
    mesh.X.col(v).tail<2>() = radius * Eigen::Vector2d(std::sin(mesh.X(1, v)), std::cos(mesh.X(1, v)));
  return mesh;
}

void compare(Element element, int n, std::optional<int> exactness, std::optional<double> bound, const std::string& note,
             const VerifyRows& rows) {
  const bool solid = dimension_of(element) == 3;
  Model model(eighth(element, n), !solid);
  const Mesh& mesh = model.mesh();
  for (const char axis : {'x', 'y', 'z'}) model.mirror(axis);
  if (solid) {
    model.add("st_venant_kirchhoff", {{"E", {young}}, {"nu", {poisson}}}, exactness);
  } else {
    model.add("st_venant_kirchhoff_membrane", {{"E", {young}}, {"nu", {poisson}}, {"h", {thickness}}});
    model.add("koiter_bending", {{"E", {young}}, {"nu", {poisson}}, {"h", {thickness}}});
  }
  constexpr double rounding = 1e-9 * radius;
  model.hold(vertices_where(mesh, [](const Eigen::Vector3d& X) { return X[0] > half_length - rounding; }), "yz");
  // Through the thickness under the force.
  const std::vector<int> pinched =
      vertices_where(mesh, [](const Eigen::Vector3d& X) { return X[0] < rounding && X[1] < rounding; });
  Eigen::VectorXd shares = Eigen::VectorXd::Zero(mesh.vertices());
  if (solid)
    shares = load_shares(mesh, pinched).shares;
  else
    shares[pinched[0]] = 1;
  const int load = model.add_load(shares, Eigen::Vector3d::Zero());
  const int A = vertex_near(mesh, {0, 0, radius}), B = vertex_near(mesh, {0, radius, 0});
  constexpr int steps = 40;
  for (int step = 1; step <= steps; ++step) {
    model.set_load(load, {0, 0, -most / 4 * step / steps});
    model.solve(1e-5);
    for (const PinchedState& state : states) {
      if (std::abs(state.part * steps - step) > 1e-9) continue;
      const std::string at = fmt::format(" at P = {:g}", state.part * most);
      // Before folds form, the solid is judged: the force on a point is not resolved to better than this.
      const std::optional<double> judged = exactness && state.part == states[0].part ? std::optional(0.02) : bound;
      const std::string name = name_of(element) + (!solid ? ", Koiter" : exactness ? ", 2x2x2 points" : "");
      rows.add(
          {"-W at A" + at, name, fmt::format("{}x{}", n, n), mesh.X(2, A) - model.x(2, A), state.down, judged, note});
      rows.add(
          {"U at B" + at, name, fmt::format("{}x{}", n, n), model.x(1, B) - mesh.X(1, B), state.out, judged, note});
    }
    if (rows.quick() && step == steps / 5) return;
  }
}

void run(const VerifyRows& rows) {
  // Two points along each axis instead of three: curved cells of degree 2 lock in their middle surface otherwise.
  constexpr int reduced = 3;
  compare(Element::hex20, 16, reduced, std::nullopt, "folds at the force are as narrow as cells", rows);
  if (rows.quick()) return;
  compare(Element::hex20, 32, reduced, std::nullopt, "folds at the force are as narrow as cells", rows);
  compare(Element::hex27, 16, std::nullopt, std::nullopt, "locks where quadrature is full", rows);
  for (const int n : {16, 32})
    compare(Element::tri3, n, std::nullopt, std::nullopt, "folds at the force are as narrow as cells", rows);
}

}  // namespace

VerifyCase pinched_cylinder_case() {
  return {
      "pinched_cylinder", "a thin cylinder with end diaphragms under two opposite forces",
      "Sze, Liu, Lo 2004, Popular benchmark problems for geometric nonlinear analysis of shells, Finite Elem. Anal. "
      "Des. 40, section 3.6",
      run};
}

}  // namespace ergon
