#include "tools/verify/beams.h"

#include <fmt/format.h>

#include <cmath>

#include "runtime/mesh/consistent_mass.h"
#include "runtime/mesh/load_shares.h"
#include "runtime/mesh/mesh_build.h"
#include "tools/verify/meshes.h"

namespace ergon {
namespace {

constexpr double sheet_width = 0.25;  // m

Mesh beam_mesh(const BeamForm& form, double width) {
  const int dimension = dimension_of(form.element);
  const double cell = dimension == 3 ? 1.0 / form.along : 1 / (form.along - 0.5);
  const int across = std::max(1, static_cast<int>(std::lround(width / cell)));
  Mesh mesh = dimension == 2 && !form.right_angled ? equilateral_strip(cell, form.along, across)
                                                   : box_mesh(form.element, {cell * form.along, width, form.height},
                                                              {form.along, dimension == 2 ? across : 1, form.across});
  if (dimension < 3) mesh.X.row(0).array() -= cell / 2;
  return mesh;
}

}  // namespace

Beam make_beam(const BeamForm& form) {
  const int dimension = dimension_of(form.element);
  const double wanted = dimension == 2 ? sheet_width : form.height;
  Mesh made = beam_mesh(form, wanted);
  const double width = dimension == 2 ? made.X.row(1).maxCoeff() : wanted;
  const double young = 12 / (width * std::pow(form.height, 3));
  Beam out{Model(std::move(made)), {}, {}, {}, "", "", ""};
  Model& model = out.model;
  const Mesh& mesh = model.mesh();
  if (dimension == 3) {
    model.add("st_venant_kirchhoff", {{"E", {young}}, {"nu", {0.0}}});
    out.element = name_of(form.element);
    out.mesh = fmt::format("{}x{}", form.along, form.across);
    if (degree_of(form.element) == 1) out.limits = "locks in bending";
    if (form.element == Element::hex8 && form.across == 1) {
      // Bent by a curvature c, a trilinear cell of the length l shears by c*x, -l/2 < x < l/2: beside E c^2 h^2/24 of
      // bending there are G c^2 l^2/24 of energy per volume, with E = 2 G here.
      const double slender = 1 / (form.along * form.height);
      out.locks_by = 1 + slender * slender / 2;
      out.limits = fmt::format("locks in bending: it shears, which makes it 1 + (l/h)^2/2 = {:.4g} times as stiff",
                               out.locks_by);
    }
  } else if (dimension == 2) {
    model.add("st_venant_kirchhoff_membrane", {{"E", {young}}, {"nu", {0.0}}, {"h", {form.height}}});
    // On equilateral triangles a free strip has the bending stiffness 6 k per width: an edge of length a with height h
    // turns by curvature*h along its normal, which makes 3 k times the sum of squares over three directions per area,
    // and the least of that over the curvature across is 3 k times the square of the curvature along.
    model.add("discrete_shell_hinge", {{"k", {1 / (6 * width)}}});
    out.element = form.right_angled ? "Tri3, hinges, right" : "Tri3, hinges";
    out.mesh = fmt::format("{} cells", mesh.cell_count());
    out.limits = form.right_angled ? "hinges on right angles: a free strip is 0.8 times as stiff, as bending twists it"
                                   : "hinges: free sides are softer, in proportion to cell/width";
  } else {
    model.add("rod_stretching", {{"EA", {young * width * form.height}}});
    model.add("rod_bending", {{"EI", {1}}});
    out.element = "Edge2, rod";
    out.mesh = fmt::format("{}", form.along);
  }
  model.hold(vertices_where(mesh, [](const Eigen::Vector3d&) { return true; }), "y");
  const double held = dimension == 3 ? 1e-9 : 0.51 / (form.along - 0.5);
  model.hold(vertices_where(mesh, [&](const Eigen::Vector3d& X) { return X[0] < held; }));
  out.tip = load_shares(mesh, vertices_where(mesh, [](const Eigen::Vector3d& X) { return X[0] > 1 - 1e-9; })).shares;
  const double section = dimension == 3 ? width * form.height : dimension == 2 ? width : 1;
  out.mass = mass_matrix(mesh, 1 / section);
  out.length = out.mass * Eigen::VectorXd::Ones(out.mass.cols());
  return out;
}

double critical_load(Model& model, const std::function<void(double load)>& apply, double low, double high, int axis) {
  const double size = model.mesh().X.row(0).maxCoeff();
  while (high - low > 1e-4 * high) {
    const double load = (low + high) / 2;
    model.x = model.mesh().X;
    apply(load);
    model.solve(1e-9 * size);
    const double aside = (model.x - model.mesh().X).row(axis).cwiseAbs().maxCoeff();
    (model.stable() && aside < 1e-4 * size ? low : high) = load;
  }
  return (low + high) / 2;
}

}  // namespace ergon
