// Cook's membrane: a tapered panel, clamped on one side and sheared on the other.

#include <fmt/format.h>

#include "runtime/mesh/load_shares.h"
#include "runtime/mesh/mesh_build.h"
#include "tools/verify/model.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

constexpr double length = 48, left = 44, rise = 44, right = 16;  // mm

Mesh panel(Element element, int n) {
  Mesh mesh = dimension_of(element) == 2 && shape_of(element) == ReferenceShape::triangle
                  ? alternating_triangles(element, {1, 1, 1}, {n, n, 1})
                  : box_mesh(element, {1, 1, 1}, {n, n, 1});
  for (int v = 0; v < mesh.vertices(); ++v) {
    const double s = mesh.X(0, v), t = mesh.X(1, v), below = rise * s, above = left + (rise + right - left) * s;
    mesh.X.col(v).head<2>() = Eigen::Vector2d(length * s, below + t * (above - below));
  }
  mesh.X *= 1e-3;
  return mesh;
}

// Held on the left and in its plane; the force acts upwards on the right. The rise of the middle of that side, m.
double tip_rise(Model& model, double force, int steps) {
  const Mesh& mesh = model.mesh();
  model.hold(vertices_where(mesh, [](const Eigen::Vector3d&) { return true; }), "z");
  model.hold(vertices_where(mesh, [](const Eigen::Vector3d& X) { return X[0] < 1e-9; }));
  const std::vector<int> end = vertices_where(mesh, [](const Eigen::Vector3d& X) { return X[0] > 47.999e-3; });
  const int load = model.add_load(load_shares(mesh, end).shares, Eigen::Vector3d::Zero());
  for (int step = 1; step <= steps; ++step) {
    model.set_load(load, {0, force * step / steps, 0});
    model.solve(1e-9);
  }
  const int tip = vertex_near(mesh, {48e-3, 52e-3, 0});
  return model.x(1, tip) - mesh.X(1, tip);
}

void finite(Element element, int n, double reference, std::optional<double> bound, const std::string& note,
            const VerifyRows& rows) {
  constexpr double mu = 422.5e3, nu = 0.3;
  Model model(panel(element, n));
  model.add("isochoric_neo_hookean", {{"mu", {mu}}, {"K", {2 * mu * (1 + nu) / (3 * (1 - 2 * nu))}}});
  rows.add({"finite strain, plane strain: rise (mm)", name_of(element), fmt::format("{}x{}", n, n),
            1e3 * tip_rise(model, 1, 5), reference, bound, note});
}

// In plane stress of a sheet 1 mm thick, E = 1 MPa, at strains of 1e-7; scaled to E = 1, force 1, thickness 1.
void linear(Element element, int n, std::optional<double> bound, const std::string& note, const VerifyRows& rows) {
  Model model(panel(element, n));
  model.add("st_venant_kirchhoff_membrane", {{"E", {1e6}}, {"nu", {1.0 / 3}}, {"h", {1e-3}}});
  constexpr double force = 1e-6;  // N
  const double rise = tip_rise(model, force, 1);
  rows.add({"linear, plane stress: rise at E = F = t = 1", name_of(element), fmt::format("{}x{}", n, n),
            rise / force * 1e6 * 1e-3, 23.96, bound, note});
}

void run(const VerifyRows& rows) {
  // Side by side with the published values on the same meshes of bilinear and biquadratic cells.
  constexpr struct {
    int n;
    double linear, quadratic;
  } published[] = {{2, 8.638, 14.30}, {4, 12.07, 14.65}, {8, 13.86, 14.71}, {16, 14.49, 14.73}};
  for (const auto& at : published) {
    finite(Element::hex8, at.n, at.linear, 0.01, "the published value of this mesh", rows);
    finite(Element::hex27, at.n, at.quadratic, 0.01, at.n == 16 ? "" : "the published value of this mesh", rows);
    if (rows.quick() && at.n == 4) break;
  }
  linear(Element::quad9, 8, 0.01, "", rows);
  if (rows.quick()) return;
  finite(Element::hex20, 16, 14.74, 0.01, "", rows);
  finite(Element::tet10, 16, 14.74, 0.01, "", rows);
  finite(Element::hex8, 64, 14.74, 0.01, "", rows);
  finite(Element::tet4, 16, 14.74, std::nullopt, "stiff on a coarse mesh", rows);
  finite(Element::tet4, 64, 14.74, 0.01, "", rows);
  finite(Element::prism6, 64, 14.74, 0.01, "", rows);
  linear(Element::tri6, 16, 0.01, "", rows);
  linear(Element::quad4, 8, std::nullopt, "stiff on a coarse mesh", rows);
  linear(Element::quad4, 64, 0.01, "", rows);
  linear(Element::tri3, 64, 0.01, "", rows);
}

}  // namespace

VerifyCase cook_membrane_case() {
  return {"cook_membrane", "a tapered panel in shear and bending",
          "finite strain: Pelteret, McBride, Quasi-static finite-strain compressible elasticity, deal.II code gallery; "
          "linear: Cook 1974, Improved two-dimensional finite element, J. Struct. Div. ASCE 100, with the limit 23.96",
          run};
}

}  // namespace ergon
