#include "runtime/mesh/solid_moments.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "runtime/mesh/element.h"
#include "runtime/mesh/mesh_build.h"
#include "runtime/mesh/mesh_tools.h"
#include "runtime/mesh/quadrature.h"
#include "runtime/mesh/shapes.h"
#include "tests/runtime/mesh_helpers.h"

namespace ergon {
namespace {

// The boundary of cells, over the vertices of all.
Mesh boundary(const Mesh& cells) {
  Mesh surface{cells.X, Element::tri3, {}, "box"};
  for (const auto& t : surface_triangles(cells)) surface.cells.insert(surface.cells.end(), t.begin(), t.end());
  return surface;
}

Mesh turned_box(const Eigen::Vector3d& size, const Eigen::Vector3d& at) {
  return transformed(box_hexes(size, {3, 2, 2}), {1, Eigen::Vector3d(1, 2, 3), 0.7, at});
}

TEST(SolidMoments, OfABoxAreThoseOfTheFormula) {
  const Eigen::Vector3d size(0.3, 0.2, 0.1), at(10, -20, 30);
  const SolidMoments m = solid_moments(boundary(turned_box(size, at)));
  const double volume = size.prod();
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Eigen::Matrix3d second = R * (volume / 12 * size.cwiseAbs2()).asDiagonal() * R.transpose();
  EXPECT_NEAR(m.volume, volume, 1e-12 * volume);
  EXPECT_LT((m.center - (R * size / 2 + at)).norm(), 1e-13 * 30);
  EXPECT_LT((m.second - second).norm(), 1e-10 * second.norm());
}

// Pappus: 2 pi R * pi r^2; the mesh lies within.
TEST(SolidMoments, OfATorusComeNearTheFormula) {
  const SolidMoments m = solid_moments(torus_surface(2, 0.5, 400, 200));
  EXPECT_NEAR(m.volume, 2 * M_PI * 2 * M_PI * 0.25, 4e-3);
  EXPECT_NEAR(m.second(2, 2) / m.volume, 0.25 / 4, 1e-3);
  EXPECT_NEAR(m.second(0, 0) / m.volume, (4 + 3.0 / 4 * 0.25) / 2, 2e-3);
  EXPECT_LT(m.center.norm(), 1e-12);
}

TEST(SolidMoments, ACavityCountsAgainst) {
  Mesh outer = boundary(box_hexes({1, 1, 1}, {1, 1, 1}));
  const Mesh inner = transformed(boundary(box_hexes({1, 1, 1}, {1, 1, 1})), {0.5, {0, 0, 1}, 0, {0.25, 0.25, 0.25}});
  const int first = outer.vertices();
  outer.X.conservativeResize(3, first + inner.vertices());
  outer.X.rightCols(inner.vertices()) = inner.X;
  for (const int v : inner.cells) outer.cells.push_back(first + v);
  const SolidMoments m = solid_moments(outer);
  EXPECT_NEAR(m.volume, 1 - 0.125, 1e-14);
  EXPECT_NEAR(m.second(1, 1), (1 - std::pow(0.5, 5)) / 12, 1e-14);
}

TEST(SolidMoments, RefusesAnOpenSurface) {
  Mesh surface = boundary(box_hexes({1, 1, 1}, {1, 1, 1}));
  surface.cells.resize(surface.cells.size() - 3);
  EXPECT_EQ(message_of([&] { solid_moments(surface); }).substr(0, 38), "box: the surface is open: 3 edges have");
}

// integral(w_i w_j) = volume/4 for i = j, else 0, by quadrature over the cells of the solid.
TEST(EquimomentalPoints, HaveTheKineticEnergyOfTheSolid) {
  const Mesh cells = turned_box({0.3, 0.2, 0.1}, {1, 2, 3});
  const SolidMoments m = solid_moments(boundary(cells));
  const Eigen::Matrix<double, 3, 4> points = equimomental_points(m);
  const QuadratureRule rule = quadrature(cells.element, 5);
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  for (int cell = 0; cell < cells.cell_count(); ++cell) {
    Eigen::Matrix<double, 3, 8> X;
    for (int a = 0; a < 8; ++a) X.col(a) = cells.X.col(cells.cells[static_cast<size_t>(8 * cell + a)]);
    for (size_t p = 0; p < rule.points.size(); ++p) {
      const Eigen::Matrix3d map = X * shape_gradients(cells.element, rule.points[p]);
      const std::array<double, 4> w = barycentric(points, X * shape_values(cells.element, rule.points[p]));
      const Eigen::Map<const Eigen::Vector4d> weights(w.data());
      sum += rule.weights[p] * map.determinant() * weights * weights.transpose();
    }
  }
  EXPECT_LT((sum - m.volume / 4 * Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff(), 1e-12 * m.volume);
  const Eigen::Vector3d a = points.col(1) - points.col(0), b = points.col(2) - points.col(0);
  EXPECT_GT(a.cross(b).dot(points.col(3) - points.col(0)), 0);
}

}  // namespace
}  // namespace ergon
