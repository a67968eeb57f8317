// Params that vary: over regions, cells, vertices, by a formula, in time. Held against sums of uniform pieces, the
// 50-digit reference and closed forms.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <random>

#include "runtime/mesh/mesh_build.h"
#include "runtime/mesh/quadrature.h"
#include "runtime/mesh/sites.h"
#include "symbolic/reference.h"
#include "symbolic/varied.h"
#include "tests/scenes/finish_scene.h"

namespace ergon {
namespace {

namespace fs = std::filesystem;

Energy law(const std::string& name) { return shipped_energies().read_complete(name, "", {}); }

Kernel kernel_of(const Energy& energy) { return real_kernels({{&energy, ""}})[0]; }

Eigen::Matrix3Xd moved(const Eigen::Matrix3Xd& X, double by) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, by);
  Eigen::Matrix3Xd x = X;
  for (double& c : x.reshaped()) c += normal(random);
  return x;
}

struct Sum {
  double value;
  Eigen::Matrix3Xd gradient;
  Eigen::MatrixXd hessian;
};

Sum evaluate_all(const std::vector<Potential>& potentials, const Eigen::Matrix3Xd& x, Projection projection) {
  System system(static_cast<int>(x.cols()));
  for (const Potential& potential : potentials) system.add(potential);
  Sum out;
  BlockMatrix matrix;
  out.value = system.hessian(x, projection, out.gradient, matrix).value;
  EXPECT_NEAR(system.value(x).value, out.value, 1e-12 * std::abs(out.value));
  out.hessian.resize(x.size(), x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Eigen::VectorXd unit = Eigen::VectorXd::Unit(x.size(), i), column(x.size());
    matrix.multiply(unit, column);
    out.hessian.col(i) = column;
  }
  return out;
}

void expect_equal(const Sum& a, const Sum& b) {
  EXPECT_NEAR(a.value, b.value, 1e-12 * std::abs(b.value));
  EXPECT_LT((a.gradient - b.gradient).norm(), 1e-12 * b.gradient.norm());
  EXPECT_LT((a.hessian - b.hessian).norm(), 1e-12 * b.hessian.norm());
}

// Every other cell is of another material: one potential with a param that varies, and two of half of the cells each.
void pieces_agree(const std::string& name, Element element, const Parameters& params, const std::string& varying,
                  const std::vector<double>& other) {
  SCOPED_TRACE(name + " on " + name_of(element));
  const Energy energy = law(name), of_cells = varied(energy, {varying});
  const Mesh mesh = box_mesh(element, {0.3, 0.2, 0.1}, {2, 2, 1});
  const int n = nodes_of(element);
  Mesh half[2] = {mesh, mesh};
  for (Mesh& part : half) part.cells.clear();
  std::vector<double> values;
  for (int cell = 0; cell < mesh.cell_count(); ++cell) {
    const auto first = mesh.cells.begin() + static_cast<ptrdiff_t>(cell) * n;
    half[cell % 2].cells.insert(half[cell % 2].cells.end(), first, first + n);
    const std::vector<double>& value = cell % 2 == 0 ? params.at(varying) : other;
    values.insert(values.end(), value.begin(), value.end());
  }
  Parameters rest = params, second = params;
  rest.erase(varying);
  second[varying] = other;
  const Kernel uniform = kernel_of(energy), varies = kernel_of(of_cells);
  EXPECT_EQ(varies->constant_hessian, uniform->constant_hessian);
  EXPECT_EQ(varies->principal != nullptr, uniform->principal != nullptr);
  EXPECT_EQ(varies->stretches, uniform->stretches);
  EXPECT_EQ(varies->displacement, uniform->displacement);
  EXPECT_EQ(varies->psd_hessian, uniform->psd_hessian);
  const Potential one = Potential::on_mesh("one", varies, mesh, 0, rest, {}, {{varying, values}});
  const std::vector<Potential> pieces = {Potential::on_mesh("even", uniform, half[0], 0, params),
                                         Potential::on_mesh("odd", uniform, half[1], 0, second)};
  for (const Projection projection : {Projection::none, Projection::clamp}) {
    const Eigen::Matrix3Xd x = moved(mesh.X, 0.02);
    expect_equal(evaluate_all({one}, x, projection), evaluate_all(pieces, x, projection));
  }
}

TEST(fields, agree_with_sums_of_uniform_pieces) {
  pieces_agree("stable_neo_hookean", Element::tet4, {{"E", {2e5}}, {"nu", {0.3}}}, "E", {7e4});
  pieces_agree("stable_neo_hookean", Element::hex8, {{"E", {2e5}}, {"nu", {0.3}}}, "nu", {0.45});
  pieces_agree("linear_elasticity", Element::tet10, {{"E", {2e5}}, {"nu", {0.3}}}, "E", {7e4});
  pieces_agree("hencky", Element::tet4, {{"E", {2e5}}, {"nu", {0.3}}}, "E", {7e4});
}

// Stencils: a hinge between two materials has the mean of both.
TEST(fields, reach_stencils_by_the_cells_that_they_join) {
  const Mesh mesh = box_mesh(Element::tri3, {1, 1, 1}, {1, 1, 1});
  ASSERT_EQ(mesh.cell_count(), 2);
  const Sites edge = sites_of_stencils(mesh, {mesh.cells[0], mesh.cells[1]}, 2);
  std::vector<int> hinge(mesh.cells.begin(), mesh.cells.begin() + 3);
  for (int i = 3; i < 6; ++i)
    if (std::find(hinge.begin(), hinge.end(), mesh.cells[static_cast<size_t>(i)]) == hinge.end())
      hinge.push_back(mesh.cells[static_cast<size_t>(i)]);
  ASSERT_EQ(hinge.size(), 4u);
  const Sites both = sites_of_stencils(mesh, hinge, 4);
  EXPECT_EQ(both.of_cells({1, 4}, 1), std::vector<double>{2.5});
  EXPECT_EQ(both.of_vertices({1, 2, 3, 6}, 1), std::vector<double>{3});
  const double on_edge = edge.of_cells({1, 4}, 1)[0];
  EXPECT_TRUE(on_edge == 1 || on_edge == 2.5) << on_edge;
  EXPECT_LT((both.positions(mesh.X) - Eigen::Vector3d(0.5, 0.5, 0)).norm(), 1e-15);
}

// A formula at the points of quadrature of one distorted Hex8, against the sum of 50-digit densities.
TEST(fields, of_quadrature_points_agree_with_fifty_digits) {
  const Energy energy = law("neo_hookean"), of_points = varied(energy, {"E"});
  Mesh mesh = box_mesh(Element::hex8, {1, 1, 1}, {1, 1, 1});
  mesh.X = moved(mesh.X, 0.05);
  const Sites sites = sites_of_cells(mesh);
  ASSERT_EQ(sites.count(), 8);
  const Eigen::Matrix3Xd X = sites.positions(mesh.X);
  std::vector<double> E;
  for (int p = 0; p < 8; ++p) E.push_back(1e5 * (1 + X(0, p) + 2 * X(1, p) * X(2, p)));
  const Eigen::Matrix3Xd x = moved(mesh.X, 0.1);
  const QuadratureRule rule = default_quadrature(Element::hex8);
  double expected = 0;
  for (size_t p = 0; p < rule.points.size(); ++p) {
    const Eigen::MatrixXd gradients = shape_gradients(Element::hex8, rule.points[p]);
    const Eigen::Matrix3d map = mesh.X(Eigen::all, mesh.cells) * gradients;
    const Eigen::Matrix3d F = x(Eigen::all, mesh.cells) * gradients * map.inverse();
    const ReferenceValue at = evaluate_reference(
        energy, "", {{"E", {E[p]}}, {"nu", {0.3}}, {"F", std::vector<double>(F.data(), F.data() + 9)}});
    expected += at.value * map.determinant() * rule.weights[p];
  }
  System system(8);
  system.add(Potential::on_mesh("one", kernel_of(of_points), mesh, 0, {{"nu", {0.3}}}, {}, {{"E", E}}));
  EXPECT_NEAR(system.value(x).value, expected, 1e-13 * expected);
}

// Bending of a beam of two layers: u = (-kappa x z, 0, kappa x^2/2) is in equilibrium where nu = 0, and its energy is
// that of the sum of E_i I_i about the neutral axis z = 0 (Gere, Timoshenko 1997, Mechanics of Materials, 4th ed.,
// Section 6.2: composite beams). A Hex27 holds the displacement exactly.
TEST(fields, a_beam_of_two_layers_has_the_stiffness_of_their_sum) {
  const double L = 1, b = 0.1, h = 0.1, kappa = 1e-3, E1 = 1e6, E2 = 4e6;
  // The neutral axis: E1*h1^2 = E2*h2^2, so the lower layer is twice as thick.
  Mesh mesh = box_mesh(Element::hex27, {L, b, 3 * h}, {4, 1, 3});
  mesh.X.row(2).array() -= 2 * h;
  const Sites sites = sites_of_cells(mesh);
  const Eigen::Matrix3Xd at = sites.positions(mesh.X);
  std::vector<double> E;
  for (int i = 0; i < sites.count(); ++i) E.push_back(at(2, i) < 0 ? E1 : E2);
  const Energy stiff = varied(law("linear_elasticity"), {"E"});
  System system(mesh.vertices());
  system.add(Potential::on_mesh("beam", kernel_of(stiff), mesh, 0, {{"nu", {0}}}, {}, {{"E", E}}));
  Eigen::Matrix3Xd x = mesh.X, gradient;
  x.row(0).array() -= kappa * mesh.X.row(0).array() * mesh.X.row(2).array();
  x.row(2).array() += kappa / 2 * mesh.X.row(0).array().square();
  const double stiffness = E1 * b * std::pow(2 * h, 3) / 3 + E2 * b * std::pow(h, 3) / 3;
  EXPECT_NEAR(system.gradient(x, gradient).value, stiffness * kappa * kappa * L / 2, 1e-12 * stiffness * kappa * kappa);
  double moment = 0, inside = 0;
  for (int v = 0; v < mesh.vertices(); ++v) {
    if (mesh.X(0, v) > L - 1e-9)
      moment -= gradient(0, v) * mesh.X(2, v);
    else if (mesh.X(0, v) > 1e-9)
      inside = std::max(inside, gradient.col(v).norm());
  }
  EXPECT_NEAR(moment, stiffness * kappa, 1e-11 * stiffness * kappa);
  EXPECT_LT(inside, 1e-10 * stiffness * kappa / h);
}

// A bar that is pulled in one step so long that inertia is nothing; nu = 0, so that it is as in one dimension.
std::string bar(const std::string& E, const std::string& more = "") {
  return R"(
gravity = [0, 0, 0]
[time]
dt = 1e5
steps = 1
[solver]
tolerance = 1e-13
[[object]]
name = "bar"
box = { size = [2, 0.1, 0.1], cells = [20, 1, 1] }
element = "hex8"
density = 1
)" + more +
         R"(
fixed = [{ max = [1e-9, inf, inf] }]
scripted = [{ min = [1.999999, -inf, -inf], key = [{ time = 1e5, translate = [0.002, 0, 0] }] }]
energy = [{ law = "linear_elasticity", nu = 0, E = )" +
         E + " }]\n[[probe]]\nname = \"mid\"\nobject = \"bar\"\nnear = [1, 0, 0]\n";
}

double mid_of(const std::string& E, const std::string& more = "") {
  const FinishedScene end = finish_text(bar(E, more));
  EXPECT_EQ(end.summary.failure, "");
  return end.summary.probes.at(0).second[0] - 1;
}

TEST(fields, two_bars_in_a_row_share_the_displacement_by_their_stiffness) {
  const std::string regions =
      "region = [{ name = \"left\", max = [1, inf, inf] }, { name = \"right\", min = [1, -inf, "
      "-inf] }]\n";
  EXPECT_NEAR(mid_of("{ regions = { left = \"3 MPa\", right = \"1 MPa\" } }", regions), 0.0005, 1e-12);
  EXPECT_NEAR(mid_of("{ regions = { right = \"1 MPa\", otherwise = \"3 MPa\" } }", regions), 0.0005, 1e-12);
  EXPECT_NEAR(mid_of("\"1 MPa\""), 0.001, 1e-12);
}

// The bar as a file of Gmsh: cells of its left half are in a group with a name, those of the right in one without.
TEST(fields, regions_may_be_physical_groups_of_the_mesh_file) {
  const fs::path folder = fs::path(testing::TempDir()) / "fields_groups_test";
  fs::create_directories(folder);
  const Mesh mesh = box_mesh(Element::hex8, {2, 0.1, 0.1}, {20, 1, 1});
  std::ofstream out(folder / "bar.msh");
  out.precision(17);
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 4 \"left half\"\n$EndPhysicalNames\n$Nodes\n"
      << mesh.vertices() << "\n";
  for (int v = 0; v < mesh.vertices(); ++v)
    out << v + 1 << " " << mesh.X(0, v) << " " << mesh.X(1, v) << " " << mesh.X(2, v) << "\n";
  out << "$EndNodes\n$Elements\n20\n";
  for (int cell = 0; cell < 20; ++cell) {
    out << cell + 1 << " 5 2 " << (mesh.X(0, mesh.cells[static_cast<size_t>(8 * cell)]) < 0.95 ? 4 : 5) << " 1";
    for (int a = 0; a < 8; ++a) out << " " << mesh.cells[static_cast<size_t>(8 * cell + a)] + 1;
    out << "\n";
  }
  out << "$EndElements\n";
  out.close();
  const std::string box = "box = { size = [2, 0.1, 0.1], cells = [20, 1, 1] }\nelement = \"hex8\"";
  const auto text = [&](const std::string& group) {
    std::string made =
        bar("{ regions = { stiff = \"3 MPa\", soft = \"1 MPa\" } }",
            "region = [{ name = \"stiff\", group = \"" + group + "\" }, { name = \"soft\", group = \"5\" }]\n");
    return made.replace(made.find(box), box.size(), "mesh = \"bar.msh\"");
  };
  const std::string file = (folder / "a.toml").string();
  EXPECT_NEAR(finish(read_scene_text(text("left half"), file)).summary.probes.at(0).second[0] - 1, 0.0005, 1e-12);
  try {
    finish(read_scene_text(text("left hlf"), file));
    ADD_FAILURE();
  } catch (const SourceError& bad) {
    EXPECT_EQ(std::string(bad.what()),
              file + ":12:37: " + (folder / "bar.msh").string() +
                  " has no physical group 'left hlf' of cells (its groups: 5, left half); did you mean 'left half'?");
  }
}

// u' = force/(E*A) with E = E0*(1 + x/L): the mid moves by ln(1.5)/ln(2) of the end, where the cells' mean of 1/E is
// taken by two points of quadrature each, which is exact to 1e-6 here.
TEST(fields, a_formula_in_the_rest_position_grades_a_bar) {
  const double expected = 0.002 * std::log(1.5) / std::log(2.0);
  EXPECT_NEAR(mid_of("{ formula = \"E0*(1 + X[0]/L)\", E0 = \"1 MPa\", L = \"2 m\" }"), expected, 2e-7);
}

TEST(fields, data_of_cells_and_vertices_come_from_a_file) {
  const fs::path folder = fs::path(testing::TempDir()) / "fields_test";
  fs::create_directories(folder);
  std::ofstream cells(folder / "cells.csv"), vertices(folder / "vertices.csv");
  cells << "# the left half is stiffer\nstiffness (kPa),E (MPa)\n";
  for (int i = 0; i < 20; ++i) cells << (i < 10 ? "3000,3\n" : "1000,1\n");
  const Mesh mesh = box_mesh(Element::hex8, {2, 0.1, 0.1}, {20, 1, 1});
  vertices << "E\n";
  for (int v = 0; v < mesh.vertices(); ++v) vertices << 1e6 * (1 + mesh.X(0, v) / 2) << "\n";
  cells.close(), vertices.close();
  const auto mid = [&](const std::string& E) {
    Scene scene = read_scene_text(bar(E), (folder / "a.toml").string());
    return finish(scene).summary.probes.at(0).second[0] - 1;
  };
  EXPECT_NEAR(mid("{ cells = \"cells.csv\" }"), 0.0005, 1e-12);
  EXPECT_NEAR(mid("{ cells = \"cells.csv\", column = \"stiffness\" }"), 0.0005, 1e-12);
  EXPECT_NEAR(mid("{ vertices = \"vertices.csv\" }"), 0.002 * std::log(1.5) / std::log(2.0), 2e-7);
}

// A ramp of stiffness in time stays one number: the scene asks for the kernel of the catalogue.
TEST(fields, a_formula_in_time_is_one_number_at_the_end_of_each_step) {
  std::string text = bar("{ formula = \"E0*(1 + t/T)\", E0 = \"1 MPa\", T = \"100000 s\" }");
  const FinishedScene end = finish_text(text);
  ASSERT_EQ(end.summary.failure, "");
  // 1/2 E A/L u^2 at E = 2 MPa.
  EXPECT_NEAR(end.summary.end_energy, 0.5 * 2e6 * 0.01 / 2 * 0.002 * 0.002, 1e-10);
}

TEST(fields, a_weight_multiplies_an_energy) {
  const auto energy_of = [](const std::string& text) { return finish_text(text).summary.end_energy; };
  const double once = energy_of(bar("\"1 MPa\""));
  EXPECT_NEAR(energy_of(bar("\"1 MPa\", weight = 0.5")), once / 2, 1e-12 * once);
  EXPECT_NEAR(energy_of(bar("\"1 MPa\", weight = { formula = \"X[0]/L\", L = \"2 m\" }")),
              energy_of(bar("{ formula = \"E0*X[0]/L\", L = \"2 m\", E0 = \"1 MPa\" }")), 1e-12 * once);
}

}  // namespace
}  // namespace ergon
