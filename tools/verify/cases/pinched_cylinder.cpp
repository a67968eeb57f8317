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
constexpr PinchedState published[] = {
    {0.05, 9.561, -0.233}, {0.1, 23.164, -2.391}, {0.2, 56.373, 10.448}, {0.5, 73.790, 25.381}, {1, 83.102, 34.272}};

Mesh eighth(Element element, int along, int around) {
  if (dimension_of(element) == 3) return pipe_sector(element, radius, thickness, half_length, M_PI / 2, along, around);
  Mesh mesh = alternating_triangles(element, {half_length, M_PI / 2, 1}, {along, around, 1});
  for (int v = 0; v < mesh.vertices(); ++v)
    mesh.X.col(v).tail<2>() = radius * Eigen::Vector2d(std::sin(mesh.X(1, v)), std::cos(mesh.X(1, v)));
  return mesh;
}

// The published states up to `most_part` of the force, as they are found.
std::vector<PinchedState> found(Element element, int along, int around, double most_part) {
  const bool solid = dimension_of(element) == 3;
  Model model(eighth(element, along, around), !solid);
  const Mesh& mesh = model.mesh();
  for (const char axis : {'x', 'y', 'z'}) model.mirror(axis);
  if (solid) {
    // Two points along each axis instead of three: curved cells of degree 2 lock in their middle surface otherwise.
    constexpr int reduced = 3;
    model.add("st_venant_kirchhoff", {{"E", {young}}, {"nu", {poisson}}}, reduced);
  } else {
    model.add("st_venant_kirchhoff_membrane", {{"E", {young}}, {"nu", {poisson}}, {"h", {thickness}}});
    model.add("koiter_bending", {{"E", {young}}, {"nu", {poisson}}, {"h", {thickness}}});
  }
  constexpr double rounding = 1e-9 * radius;
  // The diaphragm holds the middle surface alone: the shell turns there by 60 degrees, and were inner and outer nodes
  // held as well, it would have to grow twice as thick.
  model.hold(vertices_where(mesh,
                            [](const Eigen::Vector3d& X) {
                              return X[0] > half_length - rounding &&
                                     std::abs(X.tail<2>().norm() - radius) < 1e-3 * thickness;
                            }),
             "yz");
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
  std::vector<PinchedState> out;
  for (int step = 1; step <= most_part * steps; ++step) {
    model.set_load(load, {0, 0, -most / 4 * step / steps});
    model.solve(1e-5);
    for (const PinchedState& state : published)
      if (std::abs(state.part * steps - step) < 1e-9)
        out.push_back({state.part, mesh.X(2, A) - model.x(2, A), model.x(1, B) - mesh.X(1, B)});
  }
  return out;
}

struct PinchedRow {
  std::string element, mesh;
  std::vector<PinchedState> states;
};

void against_published(const PinchedRow& row, const std::vector<bool>& judged, const VerifyRows& rows) {
  const std::string note = "where cells resolve the folds a force 5 percent smaller does as much";
  for (size_t k = 0; k < row.states.size(); ++k) {
    const std::string at = fmt::format(" at P = {:g}", published[k].part * most);
    rows.add({"-W at A" + at, row.element, row.mesh, row.states[k].down, published[k].down,
              judged[k] ? std::optional(0.01) : std::nullopt, judged[k] ? "" : note});
    rows.add({"U at B" + at, row.element, row.mesh, row.states[k].out, published[k].out, std::nullopt, note});
  }
}

void against(const PinchedRow& solid, const PinchedRow& row, const VerifyRows& rows) {
  for (size_t k = 0; k < row.states.size(); ++k) {
    const std::string at = fmt::format(" at P = {:g}, of solids", published[k].part * most);
    rows.add({"-W at A" + at, row.element, row.mesh, row.states[k].down, solid.states[k].down});
    rows.add({"U at B" + at, row.element, row.mesh, row.states[k].out, solid.states[k].out, 0.02});
  }
}

void run(const VerifyRows& rows) {
  const PinchedRow solid{"Hex20, 2x2x2 points", "16x48", found(Element::hex20, 16, 48, rows.quick() ? 0.1 : 1)};
  against_published(solid, {true, false, false, true, true}, rows);
  if (rows.quick()) return;
  const PinchedRow shell{"Tri3, Koiter", "64x64", found(Element::tri3, 64, 64, 1)};
  against_published(shell, std::vector<bool>(shell.states.size(), false), rows);
  against(solid, shell, rows);
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
