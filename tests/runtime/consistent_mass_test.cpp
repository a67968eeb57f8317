// Consistent masses: of a mesh, and in a system.

#include "runtime/mesh/consistent_mass.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "runtime/mesh/mesh_build.h"
#include "runtime/mesh/mesh_tools.h"
#include "runtime/system.h"
#include "tests/runtime/mesh_helpers.h"

namespace ergon {
namespace {

// A box of the element with one corner at the origin, brought by an affine map where the moments are known.
struct MappedBox {
  Mesh mesh;
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();  // integral of X X' over it
  double measure = 0;
};

MappedBox mapped_box(Element element) {
  const Eigen::Vector3d size(2, 0.75, 1.25);
  const int dimension = dimension_of(element);
  MappedBox out{box_mesh(element, size, {3, dimension > 1 ? 2 : 1, dimension > 2 ? 2 : 1})};
  Eigen::Matrix3d map;
  map << 1.25, 0.5, -0.25, 0.125, 0.75, 0.5, -0.5, 0.25, 1;
  const Eigen::MatrixXd axes = map.leftCols(dimension);
  double straight = 1;
  for (int i = 0; i < dimension; ++i) straight *= size[i];
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (int i = 0; i < dimension; ++i)
    for (int j = 0; j < dimension; ++j) moments(i, j) = straight * size[i] * size[j] / (i == j ? 3 : 4);
  const double stretch = std::sqrt((axes.transpose() * axes).determinant());
  out.measure = stretch * straight;
  out.moments = stretch * map * moments * map.transpose();
  out.mesh.X = map * out.mesh.X;
  return out;
}

double kinetic(const CoupledMass::Matrix& mass, const Eigen::Matrix3Xd& v) {
  Eigen::Matrix3Xd momentum = Eigen::Matrix3Xd::Zero(3, v.cols());
  add_product(mass, v, 1, momentum);
  return momentum.cwiseProduct(v).sum() / 2;
}

Eigen::Matrix3Xd rotation(const Eigen::Matrix3Xd& X, const Eigen::Vector3d& w) {
  Eigen::Matrix3Xd v = X;
  for (int i = 0; i < X.cols(); ++i) v.col(i) = w.cross(Eigen::Vector3d(X.col(i)));
  return v;
}

TEST(consistent_mass, turns_as_the_solid_does_whatever_the_element) {
  const Eigen::Vector3d w(0.5, -2, 1.5);
  for (const Element element : all_elements()) {
    if (element == Element::point) continue;
    const MappedBox box = mapped_box(element);
    const CoupledMass made = consistent_mass(box.mesh, 7);
    const double exact = 3.5 * (w.squaredNorm() * box.moments.trace() - w.dot(box.moments * w));
    const Eigen::Matrix3Xd v = rotation(box.mesh.X, w);
    EXPECT_NEAR(kinetic(made.mass, v), exact, 1e-12 * exact) << name_of(element);
    EXPECT_NEAR(made.mass.sum(), 7 * box.measure, 1e-12 * 7 * box.measure) << name_of(element);
    // Which lumped masses turn alike, of those of degree 2, is what lumping_suits says.
    const CoupledMass::Matrix lumped(lumped_masses(box.mesh, 7).asDiagonal());
    const bool alike = std::abs(kinetic(lumped, v) - exact) < 1e-12 * exact;
    EXPECT_EQ(lumping_suits(element), alike || degree_of(element) == 1) << name_of(element);
  }
}

TEST(consistent_mass, of_one_tet10_has_the_moments_that_its_lumped_masses_miss) {
  Mesh tet = to_quadratic(box_tets({1, 1, 1}, {1, 1, 1}), Element::tet10);
  tet.cells.resize(10);
  const double volume = rest_volumes(tet)[0];
  Eigen::Matrix4Xd at(4, tet.vertices());  // barycentric coordinates of the nodes
  at.setZero();
  constexpr int ends[10][2] = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
  for (int i = 0; i < 10; ++i)
    for (const int end : ends[i]) at(end, tet.cells[static_cast<size_t>(i)]) += 0.5;
  const CoupledMass::Matrix consistent = consistent_mass(tet, 1 / volume).mass;
  const Eigen::VectorXd lumped = lumped_masses(tet, 1 / volume);
  EXPECT_NEAR(at.row(0) * (consistent * at.row(1).transpose()), 1.0 / 20, 1e-15);
  EXPECT_NEAR(at.row(0) * lumped.asDiagonal() * at.row(1).transpose(), 1.0 / 27, 1e-15);
}

TEST(consistent_mass, is_bounded_by_masses_of_single_vertices_also_where_cells_are_curved) {
  for (const Element element : {Element::tet4, Element::tet10, Element::hex20, Element::hex27, Element::prism6}) {
    Mesh mesh = box_mesh(element, {1, 1, 1}, {2, 2, 1});
    for (int v = 0; v < mesh.vertices(); ++v)
      mesh.X.col(v) += 0.05 * Eigen::Vector3d(std::sin(7 * v), std::sin(11 * v + 1), std::sin(13 * v + 2));
    const CoupledMass made = consistent_mass(mesh, 3);
    EXPECT_GT(made.bound.minCoeff(), 0) << name_of(element);
    const Eigen::MatrixXd rest = Eigen::MatrixXd(made.mass) - Eigen::MatrixXd(made.bound.asDiagonal());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(rest, Eigen::EigenvaluesOnly);
    EXPECT_GT(eigen.eigenvalues()[0], -1e-15) << name_of(element);
    double volume = 0;
    for (const double part : rest_volumes(mesh)) volume += part;
    EXPECT_NEAR(made.mass.sum(), 3 * volume, 1e-13) << name_of(element);
  }
  EXPECT_EQ(message_of([] {
              consistent_mass(box_tets({1, 1, 1}, {1, 1, 1}), -1);
            }),
            "box: density is -1; it must be positive and finite");
  Mesh inverted = box_mesh(Element::hex20, {1, 1, 1}, {1, 1, 1});
  inverted.X.row(0) *= -1;
  EXPECT_EQ(message_of([&] { consistent_mass(inverted, 1); }),
            "box: cell 0 is inverted at a point of its mass; repair the mesh, or take mass = \"lumped\"");
}

TEST(consistent_mass, in_a_system_is_a_quadratic_form_with_its_derivatives) {
  const Mesh mesh = box_mesh(Element::tet10, {1, 1, 1}, {1, 1, 1});
  const int n = mesh.vertices();
  System system(n);
  std::vector<char> fixed(static_cast<size_t>(n), 0);
  fixed[3] = fixed[5] = 1;
  system.set_fixed(fixed);
  CoupledMass mass = consistent_mass(mesh, 2);
  mass.drag = 5 * mass.mass;
  const Eigen::MatrixXd M = mass.mass;
  system.set_coupled_mass(std::move(mass));
  const Eigen::Matrix3Xd xhat = 0.5 * mesh.X, xlag = 0.25 * mesh.X;
  BlockMatrix matrix;
  Eigen::Matrix3Xd gradient;
  for (const double dt : {0.1, 0.2, 0.2}) {
    const double lag_dt = 2 * dt;
    system.lag_coupled_mass(xhat, dt, xlag, lag_dt);
    const Eigen::Matrix3Xd hat = mesh.X - xhat, lag = mesh.X - xlag;
    const double energy =
        (hat * M).cwiseProduct(hat).sum() / (2 * dt * dt) + 5 * (lag * M).cwiseProduct(lag).sum() / (2 * lag_dt);
    const Evaluation evaluation = system.hessian(mesh.X, Projection::clamp, gradient, matrix);
    EXPECT_NEAR(evaluation.value, energy, 1e-12 * energy);
    EXPECT_EQ(evaluation.by_potential.size(), 0U);
    EXPECT_NEAR(system.value(mesh.X).value, energy, 1e-12 * energy);
    EXPECT_TRUE(gradient.isApprox(hat * M / (dt * dt) + 5 * lag * M / lag_dt, 1e-12));
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const int row = system.block_of(i), column = system.block_of(j);
        if (row < column || column < 0) continue;
        const ptrdiff_t at = matrix.find(row, column);
        const double found = at < 0 ? 0 : matrix.values()[static_cast<size_t>(at)];
        EXPECT_NEAR(found, M(i, j) * (1 / (dt * dt) + 5 / lag_dt), 1e-12);
        if (at < 0) continue;
        EXPECT_EQ(matrix.values()[static_cast<size_t>(at + matrix.column_stride(column) + 1)], found);
        EXPECT_EQ(matrix.values()[static_cast<size_t>(at + 1)], 0);
      }
  }
  EXPECT_EQ(system.skipped(), std::vector<std::string>{"consistent mass: Hessian is constant, assembled once"});
  EXPECT_EQ(message_of([] {
              System(3).set_coupled_mass(consistent_mass(box_tets({1, 1, 1}, {1, 1, 1}), 1));
            }),
            "a mass matrix of 8 rows for a system of 3 vertices");
}

}  // namespace
}  // namespace ergon
