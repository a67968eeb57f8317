// Where energy goes in a step, and which momenta integrators keep.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>

#include "tests/runtime/body_scene.h"

namespace ergon {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// Implicit Euler dissipates m/2*|change of v|^2 + k/2*|change of x|^2 of a linear oscillator; newmark and midpoint
// nothing.
TEST(Budget, OfAnOscillatorIsTheIntegratorsAlone) {
  const double m = 0.5, k = 200;
  for (const std::string integrator : {"implicit_euler", "newmark", "midpoint"}) {
    Matrix3Xd X(3, 2);
    X << 0, 1, 0, 0, 0, 0;
    BodyScene scene(X, Eigen::Vector2d(1, m), Vector3d::Zero(), {1, 0});
    scene.add_springs({0, 1}, k, X);
    scene.state.x(0, 1) = 1.2;
    scene.start({.dt = 0.01, .integrator = integrator, .tolerance = 1e-10});
    for (int i = 0; i < 30; ++i) {
      const double dissipated = [&] {
        const StepRecord record = scene.step();
        EXPECT_NEAR(record.budget.residual, 0, 1e-12);
        EXPECT_NEAR(record.budget.change, -record.budget.integrator, 1e-12);
        EXPECT_EQ(record.budget.script, 0);
        return record.budget.integrator;
      }();
      const double dv = scene.state.v(0, 1) - scene.state.last_v(0, 1),
                   dx = scene.state.x(0, 1) - scene.state.last_x(0, 1);
      EXPECT_NEAR(dissipated, integrator == "implicit_euler" ? m / 2 * dv * dv + k / 2 * dx * dx : 0, 1e-12);
    }
  }
}

// Friction takes mu*m*g times the way that a point slides; the ground and its weight balance.
TEST(Budget, OfASlidingPointIsThatOfCoulomb) {
  const double mu = 0.3, m = 2;
  for (const std::string integrator : {"implicit_euler", "bdf2", "sdirk2", "tr_bdf2"}) {
    BodyScene scene = point_scene(Vector3d(0, 5e-4, 0), Vector3d::Zero(), Vector3d(0, -9.81, 0), m);
    scene.add_ground({{.friction = mu}});
    scene.start({.dt = 1e-3, .integrator = integrator, .tolerance = 1e-8});
    for (int i = 0; i < 200; ++i) ASSERT_TRUE(scene.step().accepted);
    scene.state.v.col(0) = Vector3d(1, 0, 0);
    double friction = 0;
    const double start = scene.state.x(0, 0);
    for (int i = 0; i < 200; ++i) {
      const StepRecord record = scene.step();
      ASSERT_TRUE(record.accepted) << record.reason;
      EXPECT_NEAR(record.budget.residual, 0, 1e-9) << integrator;
      friction += record.budget.friction;
    }
    const double way = scene.state.x(0, 0) - start;
    EXPECT_GT(way, 0.13);
    EXPECT_NEAR(friction, mu * m * 9.81 * way, 0.03 * friction) << integrator;
  }
}

// A cube of springs that spins and trembles, free of forces: which momenta stay. All keep the linear one. The angular
// one is a quadratic invariant, which symplectic Gauss methods, of which midpoint is the first, keep: Brugnano,
// Iavernaro, Trigiante 2010, arXiv:1005.1930, section 1; others lose it with their order.
TEST(Momentum, IsKeptAsTheIntegratorsTheorySays) {
  const std::map<std::string, double> lost = {{"implicit_euler", 1},     {"bdf2", 0.1},    {"sdirk2", 0.1},
                                              {"tr_bdf2", 0.1},          {"newmark", 0.1}, {"midpoint", 1e-6},
                                              {"generalised_alpha", 0.1}};
  for (const auto& [integrator, bound] : lost) {
    BodyScene scene = cube_scene(0.3, 1, 2, 300, Vector3d::Zero());
    const Vector3d center = scene.state.x.rowwise().mean();
    for (int i = 0; i < 8; ++i) {
      const Vector3d arm = scene.state.x.col(i) - center;
      scene.state.v.col(i) = Vector3d(0.1, 0.2, -0.1) + Vector3d(1, 3, 2).cross(arm) + 0.5 * (i % 3) * arm;
    }
    scene.start({.dt = 0.01, .integrator = integrator, .tolerance = 1e-7});
    Momentum first, last;
    for (int i = 0; i < 100; ++i) {
      const StepRecord record = scene.step();
      ASSERT_TRUE(record.accepted) << record.reason;
      (i == 0 ? first : last) = record.momentum;
      EXPECT_NEAR(record.budget.residual, 0, 1e-6);  // 10 times tolerance*mass*speed
    }
    EXPECT_LT((last.linear - first.linear).norm(), 1e-6 * first.linear.norm()) << integrator;
    const Vector3d spin = first.angular - center.cross(first.linear);
    const double change = (last.angular - first.angular).norm() / spin.norm();
    EXPECT_LT(change, bound) << integrator;
  }
}

}  // namespace
}  // namespace ergon
