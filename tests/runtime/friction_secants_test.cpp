// Points that Newton's method would send past rest are held by the secant of friction's force, and nothing else
// changes.

#include "runtime/contact/friction_secants.h"

#include <gtest/gtest.h>

#include "tests/runtime/body_scene.h"
#include "tests/runtime/dense_oracle.h"

namespace ergon {
namespace {

using Eigen::Vector3d;

constexpr double eps = 1e-6;   // m
constexpr double force = 3.0;  // N

// The midpoint of two vertices slides along x over a third, across y.
struct Sliding {
  System system{3};
  FrictionSecants secants{system, body_kernels::friction_secant(), 2, 4};
  Eigen::Matrix3Xd x{3, 3};
  BlockMatrix matrix;
  Eigen::Matrix3Xd gradient;

  explicit Sliding(double way) {
    x << 1, 3, 2, 1, 1, 0, 5, 5, 5;
    const SlidingPoint point{{0, 1, 2, 0}, {0.5, 0.5, -1, 0}, Vector3d::UnitY(), Vector3d(-way, 1, 0), force};
    secants.set({point}, eps);
  }
  Eigen::Matrix3Xd step(double length) const {
    Eigen::Matrix3Xd direction = Eigen::Matrix3Xd::Zero(3, 3);
    direction.col(2) = Vector3d(-length, 100 * eps, 0);  // what is across does not count
    return direction;
  }
  // Of the relative position, in x.
  double stiffness() {
    system.hessian(x, Projection::none, gradient, matrix);
    const Eigen::MatrixXd H = testing::to_dense(matrix);
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(9, 9);
    const Vector3d weight(0.5, 0.5, -1);
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) expected(3 * a, 3 * b) = H(6, 6) * weight[a] * weight[b];
    }
    EXPECT_LT((H - expected).norm(), 1e-15 * H.norm() + 1e-300);
    EXPECT_EQ(gradient.norm(), 0);
    return H(6, 6);
  }
};

TEST(FrictionSecants, HoldsWhatWouldSlidePastRestUntilItsStepsAreSmall) {
  const double way = 10 * eps;
  Sliding s(way);
  EXPECT_EQ(s.stiffness(), 0);
  s.secants.judge_step(s.x, s.step(-9 * eps));
  EXPECT_EQ(s.secants.held(), 0);
  s.secants.judge_step(s.x, s.step(-10.4 * eps));  // into the static part of the other side
  EXPECT_EQ(s.secants.held(), 0);
  s.secants.judge_step(s.x, s.step(-11 * eps));
  EXPECT_EQ(s.secants.held(), 1);
  EXPECT_EQ(s.stiffness(), 0);
  s.secants.begin_hessian(s.x);
  EXPECT_NEAR(s.stiffness(), force / way, 1e-9 * force / way);
  s.secants.end_hessian();
  EXPECT_EQ(s.stiffness(), 0);
  s.secants.judge_step(s.x, s.step(-6 * eps));
  EXPECT_EQ(s.secants.held(), 1);
  s.secants.judge_step(s.x, s.step(-2.9 * eps));
  EXPECT_EQ(s.secants.held(), 0);
}

// There slope and secant add to force*(2 - y)/eps, y = way/eps.
TEST(FrictionSecants, FillsUpTheSlopeOfStaticFriction) {
  const double y = 0.75;
  Sliding s(y * eps);
  s.secants.judge_step(s.x, s.step(-2 * eps));
  ASSERT_EQ(s.secants.held(), 1);
  s.secants.begin_hessian(s.x);
  EXPECT_NEAR(s.stiffness(), force / eps * ((2 - y) - (2 - 2 * y)), 1e-6 * force / eps);
}

TEST(FrictionSecants, AreNoneWithoutTheirLaw) {
  System system(3);
  FrictionSecants none(system, {}, 2, 4);
  EXPECT_EQ(system.potential_count(), 0);
  none.set({{{0, 1, 0, 0}, {1, -1, 0, 0}, Vector3d::UnitY(), Vector3d::Zero(), force}}, eps);
  Eigen::Matrix3Xd x = Eigen::Matrix3Xd::Random(3, 3);
  none.begin_hessian(x);
  none.judge_step(x, -3 * x);
  EXPECT_EQ(none.held(), 0);
  EXPECT_FALSE(none.owns(-1));
}

// A row of points that slide into each other on the ground and come to rest one by one: steps end where they end
// without secants, with fewer iterations.
TEST(FrictionSecants, LeaveTheResultAndSaveIterations) {
  constexpr int points = 40;
  Eigen::Matrix3Xd X(3, points), v(3, points);
  std::vector<int> edges;
  for (int i = 0; i < points; ++i) {
    X.col(i) = Vector3d(0.01 * i, 4e-4, 0.002 * (i % 3));
    v.col(i) = 0.1 * Vector3d(std::sin(3.0 * i), 0, std::cos(5.0 * i));
    if (i > 0) edges.insert(edges.end(), {i - 1, i});
  }
  int iterations[2];
  Eigen::Matrix3Xd end[2];
  for (const int with : {0, 1}) {
    BodyScene scene(X, Eigen::VectorXd::Constant(points, 0.01), Vector3d(0, -10, 0));
    scene.add_springs(edges, 3000, X);
    Ground ground;
    ground.friction = 0.5;
    ground.epsv = 1e-5;
    scene.add_ground({ground}, with == 1 ? body_kernels::friction_secant() : Kernel{});
    StepOptions options;
    options.dt = 0.01;
    options.tolerance = 1e-7;
    scene.start(options);
    scene.state.v = v;
    iterations[with] = 0;
    for (int step = 0; step < 20; ++step) {
      const StepRecord record = scene.step();
      ASSERT_TRUE(record.converged) << step;
      iterations[with] += record.newton_iterations;
    }
    end[with] = scene.state.x;
  }
  EXPECT_LT((end[0] - end[1]).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT(iterations[1], 0.85 * iterations[0]) << iterations[0] << " without, " << iterations[1] << " with";
}

}  // namespace
}  // namespace ergon
