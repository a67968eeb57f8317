// A square plate sags under its weight by much less than its thickness: a quarter of it, by symmetry.

#include <fmt/format.h>

#include <cmath>

#include "runtime/mesh/mesh_build.h"
#include "runtime/mesh/mesh_tools.h"
#include "tools/verify/model.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

constexpr double thickness = 0.01, young = 1e9, poisson = 0.3;  // of a plate of side 1 m

// Of a supported plate of one layer of Hex8 with sides `cell`, in lengths of its thickness: sag D/(q a^4). Cells do not
// thin where they bend, which makes a bending stiffness D of (1 - nu)^2/(1 - 2 nu) D and couples the two curvatures by
// nu/(1 - nu) of that; and they shear when bent, which adds G h l^2/12 to each. Navier's series for such a plate:
// Timoshenko, Woinowsky-Krieger 1959, section 85.
double locked_sag(double cell) {
  const double bends = (1 - poisson) * (1 - poisson) / (1 - 2 * poisson);
  const double shears = (1 - poisson) / 2 * cell * cell;
  const double both = bends * poisson / (1 - poisson) + (1 - poisson);
  double sag = 0;
  for (int m = 1; m < 60; m += 2)
    for (int n = 1; n < 60; n += 2)
      sag += ((m + n) / 2 % 2 == 1 ? 1 : -1) /
             (m * n * ((bends + shears) * (std::pow(m, 4) + std::pow(n, 4)) + 2 * both * m * m * n * n));
  return 16 / std::pow(M_PI, 6) * sag;
}

void compare(Element element, int n, bool clamped, std::optional<double> bound, const std::string& note,
             const VerifyRows& rows) {
  const double bending = young * std::pow(thickness, 3) / (12 * (1 - poisson * poisson));
  const double reference = clamped ? 0.00126532 : 0.00406235, weight = 1e-6 * bending / reference;  // N/m^2
  const Eigen::Vector3d size(0.5, 0.5, thickness);
  Model model(box_mesh(element, size, {n, n, 1}));
  const Mesh& mesh = model.mesh();
  model.add("st_venant_kirchhoff", {{"E", {young}}, {"nu", {poisson}}});
  model.add_load(lumped_masses(mesh, 1 / thickness), {0, 0, -weight});
  // The middle of the plate is at the origin, the outer sides at 0.5.
  model.hold(vertices_where(mesh, [](const Eigen::Vector3d& X) { return X[0] < 1e-9; }), "x");
  model.hold(vertices_where(mesh, [](const Eigen::Vector3d& X) { return X[1] < 1e-9; }), "y");
  const auto outside = [](const Eigen::Vector3d& X) { return X[0] > 0.5 - 1e-9 || X[1] > 0.5 - 1e-9; };
  if (clamped) {
    model.hold(vertices_where(mesh, outside));
  } else {
    // Hard support: along the sides nothing moves, across them the section turns.
    model.hold(vertices_where(mesh, [](const Eigen::Vector3d& X) { return X[0] > 0.5 - 1e-9; }), "yz");
    model.hold(vertices_where(mesh, [](const Eigen::Vector3d& X) { return X[1] > 0.5 - 1e-9; }), "xz");
  }
  model.solve(1e-13);
  const int middle = vertex_near(mesh, {0, 0, thickness / 2});
  const double sag = mesh.X(2, middle) - model.x(2, middle);
  VerifyRow row{fmt::format("{}: sag D/(q a^4)", clamped ? "clamped" : "supported"),
                name_of(element),
                fmt::format("{}x{}", n, n),
                sag * bending / weight,
                reference,
                bound,
                note};
  rows.add(row);
  if (element != Element::hex8 || clamped) return;
  row.quantity += ", locked";
  row.reference = locked_sag(0.5 / n / thickness);
  row.bound = 0.01;
  row.note = "by the series of a plate whose cells shear when bent and do not thin";
  rows.add(row);
}

// A shell of triangles as scenes make them of boxes, whose vertices may be shifted by a part of a cell.
void compare_shell(int n, bool clamped, double shift, std::optional<double> bound, const std::string& note,
                   const VerifyRows& rows) {
  const double bending = young * std::pow(thickness, 3) / (12 * (1 - poisson * poisson));
  const double reference = clamped ? 0.00126532 : 0.00406235, weight = 1e-6 * bending / reference;  // N/m^2
  Mesh mesh = alternating_triangles(Element::tri3, {0.5, 0.5, 1}, {n, n, 1});
  for (int v = 0; v < mesh.vertices(); ++v) {
    auto X = mesh.X.col(v).head<2>();
    if (X.minCoeff() > 1e-9 && X.maxCoeff() < 0.5 - 1e-9)
      X += shift * 0.5 / n * Eigen::Vector2d(std::sin(12.9 * v), std::sin(78.2 * v));
  }
  Model model(mesh, true);
  model.mirror('x');
  model.mirror('y');
  model.add("st_venant_kirchhoff_membrane", {{"E", {young}}, {"nu", {poisson}}, {"h", {thickness}}});
  model.add("koiter_bending", {{"E", {young}}, {"nu", {poisson}}, {"h", {thickness}}});
  model.add_load(lumped_masses(mesh, 1), {0, 0, -weight});
  const std::vector<int> rim =
      vertices_where(mesh, [](const Eigen::Vector3d& X) { return X[0] > 0.5 - 1e-9 || X[1] > 0.5 - 1e-9; });
  model.hold(rim, clamped ? "xyz" : "z");
  if (clamped) model.hold_normals(rim);
  model.solve(1e-13);
  const int middle = vertex_near(mesh, {0, 0, 0});
  rows.add({fmt::format("{}: sag D/(q a^4)", clamped ? "clamped" : "supported"),
            shift == 0 ? "Tri3, Koiter" : "Tri3, Koiter, irregular", fmt::format("{}x{}", n, n),
            (mesh.X(2, middle) - model.x(2, middle)) * bending / weight, reference, bound, note});
}

void run(const VerifyRows& rows) {
  for (const bool clamped : {false, true}) {
    compare(Element::hex27, 4, clamped, clamped ? std::nullopt : std::optional(0.01), clamped ? "coarse" : "", rows);
    compare_shell(8, clamped, 0, std::nullopt, "coarse", rows);
    if (rows.quick()) continue;
    for (const double shift : {0.0, 0.25}) compare_shell(32, clamped, shift, 0.01, "", rows);
    compare(Element::hex27, 16, clamped, 0.01, "", rows);
    compare(Element::hex20, 24, clamped, 0.01, "", rows);
    compare(Element::tet10, 24, clamped, 0.01, "", rows);
    compare(Element::hex8, 16, clamped, std::nullopt, "locks in bending: cells shear, and do not thin", rows);
  }
}

}  // namespace

VerifyCase plate_under_gravity_case() {
  return {"plate_under_gravity", "sag of a square plate under its weight",
          "Timoshenko, Woinowsky-Krieger 1959, Theory of plates and shells (0.00406 and 0.00126), with "
          "the digits of their series",
          run};
}

}  // namespace ergon
