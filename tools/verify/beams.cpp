#include "tools/verify/beams.h"

#include <fmt/format.h>

#include <cmath>

#include "runtime/mesh/consistent_mass.h"
#include "runtime/mesh/load_shares.h"
#include "runtime/mesh/mesh_build.h"
#include "tools/verify/meshes.h"

namespace ergon {
namespace {

constexpr double sheet_width = 0.05;  // m, so little that bending one way bends the other as if nothing held it

Mesh sheet_mesh(const BeamForm& form) {
  // The middle of the first edge of hinges is at x = 0.
  const double beyond = form.sheet == Sheet::koiter ? 0 : 0.5, cell = 1 / (form.along - beyond);
  const int across = std::max(1, static_cast<int>(std::lround(sheet_width / cell)));
  const Eigen::Vector3d size(cell * form.along, sheet_width, 1);
  const std::array<int, 3> cells = {form.along, across, 1};
  Mesh mesh = form.sheet == Sheet::right_angled_hinges  ? box_mesh(Element::tri3, size, cells)
              : form.sheet == Sheet::alternating_hinges ? alternating_triangles(Element::tri3, size, cells)
                                                        : equilateral_strip(cell, form.along, across);
  mesh.X.row(0).array() -= beyond * cell;
  return mesh;
}

Mesh beam_mesh(const BeamForm& form) {
  if (dimension_of(form.element) == 2) return sheet_mesh(form);
  const bool solid = dimension_of(form.element) == 3;
  const double cell = solid ? 1.0 / form.along : 1 / (form.along - 0.5);
  Mesh mesh = box_mesh(form.element, {cell * form.along, form.height, form.height}, {form.along, 1, form.across});
  if (!solid) mesh.X.row(0).array() -= cell / 2;
  return mesh;
}

void add_solid(const BeamForm& form, double young, Beam& out) {
  out.model.add("st_venant_kirchhoff", {{"E", {young}}, {"nu", {0.0}}});
  out.element = name_of(form.element);
  out.mesh = fmt::format("{}x{}", form.along, form.across);
  if (form.element != Element::hex8 || form.across != 1) return;
  // Bent by a curvature c, a trilinear cell of the length l shears by c*x, -l/2 < x < l/2: beside E c^2 h^2/24 of
  // bending there are G c^2 l^2/24 of energy per volume, with E = 2 G here.
  const double slender = 1 / (form.along * form.height);
  out.stiffness = 1 + slender * slender / 2;
  out.limits =
      fmt::format("locks in bending: it shears, which makes it 1 + (l/h)^2/2 = {:.4g} times as stiff", out.stiffness);
}

// Vertices on z = (c_xx x^2 + 2 c_xy x y + c_yy y^2)/2 turn an edge along t, with triangles of the height h on both
// sides, by what their planes rise towards their third corners. All edges have, per area and with the weights of
// Discrete Shells,
//   - equilateral, where they turn by h (c_nn - c_tt/3), as an edge's ends lie above its middle:
//     3 k (c_xx^2 + c_yy^2 - 2/3 c_xx c_yy + 8/3 c_xy^2), an isotropic plate with a Poisson's ratio of -1/3, whose free
//     strip is 8/9 as stiff as a wide one;
//   - with parallel diagonals: 3 k ((c_xx + c_xy)^2 + (c_yy + c_xy)^2 + 4 c_xy^2), whose least value for a given c_xx,
//     which twists, is 0.8 times 3 k c_xx^2;
//   - with diagonals that turn, where every other vertex leaves the surface by d a^2/2:
//     3 k ((c_xx + d)^2 + (c_yy + d)^2 + 4 c_xy^2 + 4 d^2) with the least d, so 5/6 of 3 k (c_xx^2 + c_yy^2 - 2/5 c_xx
//     c_yy) and 12 k c_xy^2: 0.8 again.
void add_sheet(const BeamForm& form, double young, double width, Beam& out) {
  Model& model = out.model;
  model.add("st_venant_kirchhoff_membrane", {{"E", {young}}, {"nu", {0.0}}, {"h", {form.height}}});
  out.mesh = fmt::format("{} cells", model.mesh().cell_count());
  if (form.sheet == Sheet::koiter) {
    model.add("koiter_bending", {{"E", {young}}, {"nu", {form.poisson}}, {"h", {form.height}}});
    out.element = "Tri3, Koiter";
    return;
  }
  const double wide = form.sheet == Sheet::hinges ? 9. / 8 : 1;  // N m^2, without curvature across
  model.add("discrete_shell_hinge", {{"k", {wide / (6 * width)}}});
  if (form.sheet == Sheet::hinges) {
    out.element = "Tri3, hinges";
    out.limits = "an isotropic plate of Poisson's ratio -1/3, and free sides are softer in proportion to cells";
  } else {
    out.stiffness = 0.8;
    const bool turn = form.sheet == Sheet::alternating_hinges;
    out.element = turn ? "Tri3, hinges, turned" : "Tri3, hinges, right";
    out.limits = fmt::format("a free strip of such cells is 0.8 times as stiff as a wide one{}",
                             turn ? "" : ", as bending twists it");
  }
}

// Of Tet4: what a force that is so small that all is linear finds; it lets the tip sink by P L^3/(3 EI).
double small_stiffness(Beam& beam) {
  constexpr double small = 1e-3;
  const int load = beam.model.add_load(beam.tip, {0, 0, -small});
  beam.model.solve(1e-13);
  const double sinks = (beam.model.mesh().X * beam.tip - beam.tip_place()).z();
  beam.model.set_load(load, Eigen::Vector3d::Zero());
  beam.model.to_rest();
  return small / 3 / sinks;
}

}  // namespace

Beam make_beam(const BeamForm& form) {
  const int dimension = dimension_of(form.element);
  Mesh made = beam_mesh(form);
  const double width = dimension == 2 ? made.X.row(1).maxCoeff() : form.height;
  const double young = 12 / (width * std::pow(form.height, 3));
  const bool koiter = dimension == 2 && form.sheet == Sheet::koiter;
  Beam out{Model(std::move(made), koiter), {}, {}, {}, "", "", ""};
  Model& model = out.model;
  const Mesh& mesh = model.mesh();
  if (dimension == 3) {
    add_solid(form, young, out);
  } else if (dimension == 2) {
    add_sheet(form, young, width, out);
  } else {
    model.add("rod_stretching", {{"EA", {young * width * form.height}}});
    model.add("rod_bending", {{"EI", {1}}});
    out.element = "Edge2, rod";
    out.mesh = fmt::format("{}", form.along);
  }
  model.hold(vertices_where(mesh, [](const Eigen::Vector3d&) { return true; }), "y");
  const double held = dimension == 3 || koiter ? 1e-9 : 0.51 / (form.along - 0.5);
  const std::vector<int> end = vertices_where(mesh, [&](const Eigen::Vector3d& X) { return X[0] < held; });
  model.hold(end);
  if (koiter) model.hold_normals(end);
  out.tip = load_shares(mesh, vertices_where(mesh, [](const Eigen::Vector3d& X) { return X[0] > 1 - 1e-9; })).shares;
  const double section = dimension == 3 ? width * form.height : dimension == 2 ? width : 1;
  out.mass = mass_matrix(mesh, 1 / section);
  out.length = out.mass * Eigen::VectorXd::Ones(out.mass.cols());
  if (form.element == Element::tet4) {
    out.stiffness = small_stiffness(out);
    out.limits = fmt::format("locks in bending: {:.4g} times as stiff under a small force", out.stiffness);
  }
  return out;
}

void compare_beam(const BeamForm& form, const BeamQuestion& question, const VerifyRows& rows) {
  Beam beam = make_beam(form);
  for (const BeamAnswer& answer : question(beam)) {
    rows.add({answer.quantity, beam.element, beam.mesh, answer.value, answer.reference, beam.bound(), beam.limits});
    if (beam.stiffness != 1)
      rows.add({answer.quantity + ", locked", beam.element, beam.mesh, answer.value, answer.of_stiffness, 0.01,
                fmt::format("by the closed form of a beam {:.4g} times as stiff", beam.stiffness)});
  }
}

void compare_hinges(BeamForm form, const BeamQuestion& question, const VerifyRows& rows) {
  Beam coarse = make_beam(form);
  const bool isotropic = form.sheet == Sheet::hinges;
  std::vector<BeamAnswer> of_plate;
  if (isotropic) {
    BeamForm plate_form = form;
    plate_form.sheet = Sheet::koiter;
    plate_form.poisson = -1. / 3;
    Beam plate = make_beam(plate_form);
    of_plate = question(plate);
  }
  form.along *= 2;
  Beam fine = make_beam(form);
  const std::vector<BeamAnswer> of_coarse = question(coarse), of_fine = question(fine);
  const auto row_of = [](const Beam& beam, const BeamAnswer& answer) {
    return VerifyRow{answer.quantity,  beam.element, beam.mesh,  answer.value,
                     answer.reference, beam.bound(), beam.limits};
  };
  for (size_t k = 0; k < of_fine.size(); ++k) {
    const VerifyRow first = row_of(coarse, of_coarse[k]), second = row_of(fine, of_fine[k]);
    rows.add(first);
    rows.add(second);
    rows.add(limit_of(first, second, isotropic ? of_plate[k].value : of_fine[k].of_stiffness));
  }
}

double critical_load(Model& model, const std::function<void(double load)>& apply, double low, double high, int axis) {
  const Eigen::Matrix3Xd& X = model.mesh().X;
  const double size = X.row(0).maxCoeff();
  while (high - low > 1e-4 * high) {
    const double load = (low + high) / 2;
    model.to_rest();
    apply(load);
    model.solve(1e-9 * size);
    const double aside = (model.x.leftCols(X.cols()) - X).row(axis).cwiseAbs().maxCoeff();
    (model.stable() && aside < 1e-4 * size ? low : high) = load;
  }
  return (low + high) / 2;
}

}  // namespace ergon
