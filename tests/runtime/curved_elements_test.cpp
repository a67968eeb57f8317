#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <numeric>

#include "runtime/error.h"
#include "runtime/lanes/lanes.h"
#include "runtime/mesh/mesh_build.h"
#include "runtime/mesh/mesh_tools.h"
#include "runtime/mesh/quadrature.h"
#include "runtime/system.h"
#include "tests/runtime/dense_oracle.h"

namespace ergon {
namespace {

using namespace testing;  // NOLINT

class CurvedElements : public ::testing::TestWithParam<Element> {
 protected:
  // A box (rectangle, line) of 1 m bent to a quarter of a tube between the radii 1 m and 2 m, around z; a membrane is
  // the tube of radius 1 m, a line its arc.
  Mesh bent(int cells) const {
    const int dimension = dimension_of(GetParam());
    Mesh mesh = box_mesh(GetParam(), {1, 1, 1}, {cells, cells, cells});
    for (int v = 0; v < mesh.vertices(); ++v) {
      const Eigen::Vector3d X = mesh.X.col(v);
      const double radius = dimension == 3 ? 1 + X.x() : 1;
      const double angle = std::numbers::pi / 2 * (dimension == 3 ? X.y() : X.x());
      mesh.X.col(v) << radius * std::cos(angle), radius * std::sin(angle), dimension == 3 ? X.z() : X.y();
    }
    return mesh;
  }
  double exact() const { return dimension_of(GetParam()) == 3 ? 0.75 * std::numbers::pi : std::numbers::pi / 2; }
  static double total(const Mesh& mesh) {
    const auto volumes = rest_volumes(mesh);
    return std::accumulate(volumes.begin(), volumes.end(), 0.0);
  }
};

std::vector<Element> all_but_points() {
  std::vector<Element> elements = all_elements();
  elements.erase(elements.begin());
  return elements;
}
INSTANTIATE_TEST_SUITE_P(Every, CurvedElements, ::testing::ValuesIn(all_but_points()),
                         [](const auto& info) { return name_of(info.param); });

TEST_P(CurvedElements, VolumesConvergeWithTheExpectedOrder) {
  const double coarse = std::abs(total(bent(3)) - exact()), fine = std::abs(total(bent(6)) - exact());
  EXPECT_LT(fine, 0.03);
  // The boundary is interpolated with an error of order degree + 1.
  EXPECT_GT(std::log2(coarse / fine), degree_of(GetParam()) + 0.9);
}

TEST_P(CurvedElements, MassesArePositiveAndAddUp) {
  const Mesh mesh = bent(3);
  check_mesh(mesh);
  const Eigen::VectorXd masses = lumped_masses(mesh, 1000);
  EXPECT_GT(masses.minCoeff(), 0);
  EXPECT_NEAR(masses.sum(), 1000 * total(mesh), 1e-9);
}

// An affine deformation has one deformation gradient, however the cells are bent.
TEST_P(CurvedElements, AffineDeformationsGiveTheEnergyOfOneState) {
  const int dimension = dimension_of(GetParam());
  const Mesh mesh = bent(2);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  const double stretch = 1.2;
  const Eigen::Matrix3Xd x = (stretch * turn * mesh.X).colwise() + Eigen::Vector3d(3, -1, 2);
  for (const int exactness : {default_exactness(GetParam()), 5}) {
    const QuadratureRule rule = quadrature(GetParam(), exactness);
    double volume = 0;
    for (int cell = 0; cell < mesh.cell_count(); ++cell) {
      Eigen::Matrix3Xd nodes(3, nodes_of(GetParam()));
      for (int a = 0; a < nodes.cols(); ++a) {
        nodes.col(a) = mesh.X.col(mesh.cells[static_cast<size_t>(cell * nodes_of(GetParam()) + a)]);
      }
      for (size_t p = 0; p < rule.points.size(); ++p) {
        const Eigen::MatrixXd map = nodes * shape_gradients(GetParam(), rule.points[p]);
        volume += rule.weights[p] * std::sqrt((map.transpose() * map).determinant());
      }
    }
    System system(mesh.vertices());
    double density = 0;
    if (dimension == 3) {
      const double params[2] = {3, 7};
      const Eigen::Matrix3d F = stretch * turn;
      density = NeoHookeanLaw::psi(F.data(), nullptr, params);
      system.add(Potential::on_mesh("law", kernel_of<NeoHookeanLaw>(lanes::best_lanes()), mesh, 0,
                                    {{"mu", {3.0}}, {"lambda", {7.0}}}, exactness));
    } else if (dimension == 1) {
      const double params[1] = {5};
      const Eigen::Vector3d F = stretch * turn.col(0);
      density = LineLaw::psi(F.data(), nullptr, params);
      system.add(
          Potential::on_mesh("law", kernel_of<LineLaw>(lanes::best_lanes()), mesh, 0, {{"k", {5.0}}}, exactness));
    } else {
      const double params[1] = {5};
      const Eigen::Matrix<double, 3, 2> F = stretch * turn.leftCols(2);
      density = MembraneLaw::psi(F.data(), nullptr, params);
      system.add(
          Potential::on_mesh("law", kernel_of<MembraneLaw>(lanes::best_lanes()), mesh, 0, {{"k", {5.0}}}, exactness));
    }
    EXPECT_EQ(system.potential(0).quadrature_points(), static_cast<int>(rule.points.size()));
    EXPECT_NEAR(system.value(x).value, density * volume, 1e-12 * density * volume);
  }
}

TEST(CurvedElementErrors, NodesThatFoldACellAreFound) {
  const auto message = [](const Mesh& mesh) -> std::string {
    try {
      check_mesh(mesh);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  Mesh line = box_mesh(Element::edge3, {1, 1, 1}, {1, 1, 1});
  line.X.col(1).x() = 0.8;  // the middle: beyond three quarters the map turns back
  EXPECT_EQ(
      message(line),
      "box: cell 0 (Edge3, vertices 0 2 1) is inverted: length 1 m, but -0.2 m per unit at one of its points; 1 of 1 "
      "cells inverted or flat; reverse the order of its vertices or repair the mesh");
  line.X.col(1) << 0.5, 0.4, 0;
  EXPECT_EQ(message(line), "no error");
  Mesh sheet = box_mesh(Element::quad4, {1, 1, 1}, {1, 1, 1});
  sheet.X.col(3) << 0.2, 0.2, 0;
  EXPECT_EQ(message(sheet).substr(0, 52), "box: cell 0 (Quad4, vertices 0 1 3 2) is inverted: a");
  Mesh tet = to_quadratic(box_tets({1, 1, 1}, {1, 1, 1}), Element::tet10);
  EXPECT_EQ(message(tet), "no error");
  tet.X.col(8) *= 0.3;
  EXPECT_EQ(message(tet).substr(0, 28), "box: cell 0 (Tet10, vertices");
}

}  // namespace
}  // namespace ergon
