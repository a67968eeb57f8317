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

struct StripForm {
  Element element = Element::tri3;
  int along = 60;  // cells
  Bending bending = Bending::koiter;
  bool right_angled = false;
  double poisson = 0;  // of bending
};

// Sheets of hinges turn at their vertices only: their first edges are held, and their middle is at x = 0. A Koiter
// shell has normals that are held at x = 0.
Mesh strip(const StripForm& form) {
  if (dimension_of(form.element) == 3) return box_mesh(form.element, {length, width, thickness}, {form.along, 2, 1});
  const double beyond = form.bending == Bending::koiter ? 0 : 0.5, cell = length / (form.along - beyond);
  const int across = std::max(1, static_cast<int>(std::lround(std::sqrt(0.75) * width / cell)));
  Mesh mesh = form.right_angled ? box_mesh(form.element, {cell * form.along, width, 1}, {form.along, across, 1})
                                : equilateral_strip(cell, form.along, across);
  mesh.X.row(0).array() -= beyond * cell;
  return mesh;
}

void compare(const StripForm& form, std::optional<double> bound, const std::string& note, const VerifyRows& rows) {
  const bool solid = dimension_of(form.element) == 3, koiter = !solid && form.bending == Bending::koiter;
  Model model(strip(form), koiter);
  const Mesh& mesh = model.mesh();
  const double bending = young * thickness * thickness * thickness / 12;  // N m, per width, without curvature across
  if (solid) {
    model.add("st_venant_kirchhoff", {{"E", {young}}, {"nu", {0.0}}});
  } else {
    model.add("st_venant_kirchhoff_membrane", {{"E", {young}}, {"nu", {0.0}}, {"h", {thickness}}});
    if (koiter)
      model.add("koiter_bending",
                {{"E", {young * (1 - form.poisson * form.poisson)}}, {"nu", {form.poisson}}, {"h", {thickness}}});
    else
      model.add("discrete_shell_hinge", {{"k", {bending / 6}}});
  }
  const double held = solid || koiter ? 1e-9 : 0.51 * length / (form.along - 0.5);
  const std::vector<int> end = vertices_where(mesh, [&](const Eigen::Vector3d& X) { return X[0] < held; });
  model.hold(end);
  if (koiter) model.hold_normals(end);
  const Eigen::VectorXd tip =
      load_shares(mesh, vertices_where(mesh, [](const Eigen::Vector3d& X) { return X[0] > length - 1e-9; })).shares;
  const int load = model.add_load(tip, Eigen::Vector3d::Zero());
  const double wide = mesh.X.row(1).maxCoeff() / width;  // equilateral triangles come to somewhat less or more
  constexpr int steps = 20;
  for (int step = 1; step <= steps; ++step) {
    model.set_load(load, {0, 0, wide * most * step / steps});
    model.solve(1e-6);
    for (const StripState& state : states) {
      if (std::abs(state.part * steps - step) > 1e-9) continue;
      const Eigen::Vector3d moved = (model.x.leftCols(mesh.vertices()) - mesh.X) * tip;
      const std::string at = fmt::format(" at P = {:g}", state.part * most);
      const std::string law = solid ? "" : koiter ? ", Koiter" : ", hinges";
      const std::string name = name_of(form.element) + law + (form.right_angled ? ", right" : "");
      const std::string cells = solid ? fmt::format("{}x2", form.along) : fmt::format("{} cells", mesh.cell_count());
      rows.add({"-U" + at, name, cells, -moved.x(), state.back, bound, note});
      rows.add({"W" + at, name, cells, moved.z(), state.up, bound, note});
    }
  }
}

// Rows of two meshes of hinges, and what they tend to: a Koiter shell with the Poisson's ratio of hinges between
// equilateral triangles (tools/verify/beams.cpp).
void compare_hinges(const VerifyRows& rows) {
  const auto rows_of = [](const StripForm& form) {
    std::vector<VerifyRow> out;
    compare(form, std::nullopt, "an isotropic plate of Poisson's ratio -1/3, and free sides are softer",
            VerifyRows(false, [&](const VerifyRow& row) { out.push_back(row); }));
    return out;
  };
  const std::vector<VerifyRow> coarse = rows_of({.bending = Bending::hinges}),
                               fine = rows_of({.along = 120, .bending = Bending::hinges}),
                               plate = rows_of({.poisson = -1. / 3});
  for (size_t k = 0; k < fine.size(); ++k) {
    rows.add(coarse[k]);
    rows.add(fine[k]);
    rows.add(limit_of(coarse[k], fine[k], plate[k].value));
  }
}

void run(const VerifyRows& rows) {
  compare({.element = Element::hex27, .along = 16}, rows.quick() ? std::optional(0.02) : std::nullopt, "coarse", rows);
  if (rows.quick()) return;
  compare({.element = Element::hex27, .along = 32}, 0.01, "", rows);
  compare({.element = Element::hex20, .along = 32}, 0.01, "", rows);
  compare({.right_angled = false}, 0.01, "", rows);
  compare({.right_angled = true}, 0.01, "", rows);
  compare_hinges(rows);
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
