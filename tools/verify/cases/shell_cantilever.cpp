// A thin strip, clamped at one end and sheared at the other until it points nearly upwards.

#include <fmt/format.h>

#include <cmath>

#include "runtime/mesh/load_shares.h"
#include "runtime/mesh/mesh_build.h"
#include "tools/verify/meshes.h"
#include "tools/verify/model.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

constexpr double young = 1.2e6, length = 10, width = 1, thickness = 0.1, most = 4;

struct StripState {
  double part, back, up;  // P/Pmax, -U, W
};
constexpr StripState states[] = {{0.25, 0.563, 3.015}, {0.5, 1.604, 4.933}, {1, 3.286, 6.698}};

// Bending of sheets is that of hinges or of a Koiter shell.
enum class Bending { hinges, koiter };

// Sheets of hinges turn at their vertices only: their first edges are held, and their middle is at x = 0. A Koiter
// shell has normals that are held at x = 0.
Mesh strip(Element element, int along, bool right_angled, Bending bending) {
  if (dimension_of(element) == 3) return box_mesh(element, {length, width, thickness}, {along, 2, 1});
  const double beyond = bending == Bending::koiter ? 0 : 0.5, cell = length / (along - beyond);
  const int across = std::max(1, static_cast<int>(std::lround(std::sqrt(0.75) * width / cell)));
  Mesh mesh = right_angled ? box_mesh(element, {cell * along, width, 1}, {along, across, 1})
                           : equilateral_strip(cell, along, across);
  mesh.X.row(1) *= width / mesh.X.row(1).maxCoeff();
  mesh.X.row(0).array() -= beyond * cell;
  return mesh;
}

void compare(Element element, int along, bool right_angled, Bending bending, std::optional<double> bound,
             const std::string& note, const VerifyRows& rows) {
  const bool solid = dimension_of(element) == 3;
  Model model(strip(element, along, right_angled, bending), bending == Bending::koiter);
  const Mesh& mesh = model.mesh();
  if (solid) {
    model.add("st_venant_kirchhoff", {{"E", {young}}, {"nu", {0.0}}});
  } else {
    model.add("st_venant_kirchhoff_membrane", {{"E", {young}}, {"nu", {0.0}}, {"h", {thickness}}});
    if (bending == Bending::koiter)
      model.add("koiter_bending", {{"E", {young}}, {"nu", {0.0}}, {"h", {thickness}}});
    else
      model.add("discrete_shell_hinge", {{"k", {young * thickness * thickness * thickness / 72}}});
  }
  const double held = solid || bending == Bending::koiter ? 1e-9 : 0.51 * length / (along - 0.5);
  const std::vector<int> end = vertices_where(mesh, [&](const Eigen::Vector3d& X) { return X[0] < held; });
  model.hold(end);
  if (bending == Bending::koiter) model.hold_normals(end);
  const Eigen::VectorXd tip =
      load_shares(mesh, vertices_where(mesh, [](const Eigen::Vector3d& X) { return X[0] > length - 1e-9; })).shares;
  const int load = model.add_load(tip, Eigen::Vector3d::Zero());
  constexpr int steps = 20;
  for (int step = 1; step <= steps; ++step) {
    model.set_load(load, {0, 0, most * step / steps});
    model.solve(1e-6);
    for (const StripState& state : states) {
      if (std::abs(state.part * steps - step) > 1e-9) continue;
      const Eigen::Vector3d moved = (model.x.leftCols(mesh.vertices()) - mesh.X) * tip;
      const std::string at = fmt::format(" at P = {:g}", state.part * most);
      const std::string law = solid ? "" : bending == Bending::koiter ? ", Koiter" : ", hinges";
      const std::string name = name_of(element) + law + (!solid && right_angled ? ", right" : "");
      const std::string cells = solid ? fmt::format("{}x2", along) : fmt::format("{} cells", mesh.cell_count());
      rows.add({"-U" + at, name, cells, -moved.x(), state.back, bound, note});
      rows.add({"W" + at, name, cells, moved.z(), state.up, bound, note});
    }
  }
}

void run(const VerifyRows& rows) {
  const auto none = Bending::hinges;
  compare(Element::hex27, 16, false, none, rows.quick() ? std::optional(0.02) : std::nullopt, "coarse", rows);
  compare(Element::tri3, 60, false, Bending::hinges, std::nullopt,
          "hinges: free sides are softer, in proportion to cell/width", rows);
  if (rows.quick()) return;
  compare(Element::hex27, 32, false, none, 0.01, "", rows);
  compare(Element::hex20, 32, false, none, 0.01, "", rows);
  compare(Element::tri3, 60, true, Bending::hinges, std::nullopt,
          "hinges on right angles: a free strip is 0.8 times as stiff, as bending twists it", rows);
  compare(Element::tri3, 60, false, Bending::koiter, 0.01, "", rows);
  compare(Element::tri3, 60, true, Bending::koiter, 0.01, "", rows);
}

}  // namespace

VerifyCase shell_cantilever_case() {
  return {
      "shell_cantilever", "a thin strip under end shear",
      "Sze, Liu, Lo 2004, Popular benchmark problems for geometric nonlinear analysis of shells, Finite Elem. Anal. "
      "Des. 40, section 3.1",
      run};
}

}  // namespace ergon
