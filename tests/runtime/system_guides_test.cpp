#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "runtime/solver/newton.h"
#include "tests/runtime/body_kernels.h"
#include "tests/runtime/mesh_helpers.h"

namespace ergon {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// A tetrahedron of springs, stretched, its first point held.
struct Frame {
  Matrix3Xd X{3, 4}, x;
  System system{4};
  Frame() {
    X << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
    x = 1.2 * X;
    x(1, 1) += 0.1;
    system.set_fixed({1, 0, 0, 0});
    system.add(Potential::on_stencils("spring", body_kernels::spring(), {0, 1, 0, 2, 0, 3, 1, 2, 1, 3, 2, 3}, X,
                                      {{"k", {10}}}, {}));
  }
};

Eigen::MatrixXd dense(const BlockMatrix& matrix) {
  Eigen::MatrixXd out(matrix.rows(), matrix.rows());
  Eigen::VectorXd column;
  for (int j = 0; j < matrix.rows(); ++j) {
    matrix.multiply(Eigen::VectorXd::Unit(matrix.rows(), j), column);
    out.col(j) = column;
  }
  return out;
}

TEST(Guides, MatrixAndGradientAreProjected) {
  Frame plain, guided;
  const Vector3d normal = Vector3d(1, 2, -1).normalized(), axis = Vector3d(0, 1, 1).normalized();
  const Matrix3d plane = Matrix3d::Identity() - normal * normal.transpose(), line = axis * axis.transpose();
  guided.system.set_guides({{1, plane}, {3, line}});
  Matrix3Xd g, projected;
  BlockMatrix H, P;
  plain.system.hessian(plain.x, Projection::none, g, H);
  guided.system.hessian(guided.x, Projection::none, projected, P);

  Eigen::MatrixXd along = Eigen::MatrixXd::Identity(9, 9);
  along.block<3, 3>(0, 0) = plane;
  along.block<3, 3>(6, 6) = line;
  const Eigen::MatrixXd rest = dense(P) - along * dense(H) * along;
  // What is left is a positive multiple of the directions that are held, vertex by vertex.
  const double s = rest(0, 0) / (1 - plane(0, 0)), t = rest(6, 6) / (1 - line(0, 0));
  EXPECT_GT(s, 0);
  EXPECT_GT(t, 0);
  Eigen::MatrixXd held = Eigen::MatrixXd::Zero(9, 9);
  held.block<3, 3>(0, 0) = s * (Matrix3d::Identity() - plane);
  held.block<3, 3>(6, 6) = t * (Matrix3d::Identity() - line);
  EXPECT_LT((rest - held).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((projected.col(1) - plane * g.col(1)).norm() + (projected.col(3) - line * g.col(3)).norm(), 1e-14);
  EXPECT_EQ(projected.col(2), g.col(2));

  Matrix3Xd reactions;
  guided.system.gradient_of({0}, guided.x, reactions);
  EXPECT_LT((reactions - g).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(Guides, NewtonFindsTheMinimumAlongThem) {
  Frame frame;
  const Vector3d normal = Vector3d(1, 2, -1).normalized();
  const Matrix3d plane = Matrix3d::Identity() - normal * normal.transpose();
  frame.system.set_guides({{1, plane}});
  Newton newton;
  NewtonOptions options;
  options.tolerance = 1e-10;
  options.on_demand = true;
  const Vector3d start = frame.x.col(1);
  // Turns about the held point have no stiffness: two more points keep to axes.
  frame.system.set_guides({{1, plane},
                           {2, Vector3d::UnitY() * Vector3d::UnitY().transpose()},
                           {3, Vector3d::UnitZ() * Vector3d::UnitZ().transpose()}});
  const NewtonResult result = newton.minimise(frame.system, frame.x, options);
  ASSERT_TRUE(result.converged) << result.reason;
  EXPECT_LT(std::abs(normal.dot(frame.x.col(1) - start)), 1e-14);
  EXPECT_LT(result.residual, 1e-9);
  Matrix3Xd reactions;
  frame.system.gradient_of({0}, frame.x, reactions);
  EXPECT_GT(reactions.col(1).norm(), 0.1);  // what the guide bears
  EXPECT_LT(reactions.col(1).cross(normal).norm(), 1e-9);
}

TEST(Guides, RefuseWhatTheyAreNot) {
  Frame frame;
  EXPECT_EQ(message_of([&] {
              frame.system.set_guides({{4, Matrix3d::Identity()}});
            }),
            "vertex 4 of a guide is not one of the 4 vertices");
  EXPECT_EQ(message_of([&] {
              frame.system.set_guides({{1, 2 * Matrix3d::Identity()}});
            }),
            "the guide of vertex 1 is no orthogonal projector");
  EXPECT_EQ(message_of([&] {
              frame.system.set_guides({{1, Matrix3d::Identity()}, {1, Matrix3d::Identity()}});
            }),
            "vertex 1 has two guides");
}

}  // namespace
}  // namespace ergon
