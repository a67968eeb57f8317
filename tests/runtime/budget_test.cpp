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

// A force that varies in time works: what it gives is nobody's dissipation. Of a free point implicit Euler dissipates
// m/2*|change of v|^2, newmark nothing, and of second order what is left falls with the square of dt.
TEST(Budget, OfAForceThatFollowsTimeIsItsWork) {
  const double m = 0.5, end = 1;
  const auto run = [&](const std::string& integrator, double dt) {
    BodyScene scene = point_scene(Vector3d::Zero(), Vector3d(0.3, 0, 0), Vector3d::Zero(), m);
    scene.system.potential(1).follow("g", [](double time) {
      return std::vector<double>{4 * std::sin(3 * time), 0, 0};
    });
    scene.start({.dt = dt, .integrator = integrator, .tolerance = 1e-12});
    double work = 0, integrators = 0, change = 0;
    while (scene.state.time < end - dt / 2) {
      const StepRecord record = scene.step();
      EXPECT_NEAR(record.budget.residual, 0, 1e-12) << integrator;
      EXPECT_NEAR(record.budget.change, record.budget.loads - record.budget.integrator, 1e-12) << integrator;
      const Vector3d dv = scene.state.v.col(0) - scene.state.last_v.col(0);
      if (integrator == "implicit_euler" || integrator == "newmark") {
        const double part = integrator == "newmark" ? 0 : m / 2;
        EXPECT_NEAR(record.budget.integrator, part * dv.squaredNorm(), 1e-12) << integrator;
      }
      work += record.budget.loads;
      integrators += record.budget.integrator;
      change += record.budget.change;
    }
    EXPECT_NEAR(change, work - integrators, 1e-12);
    return std::pair(work, integrators);
  };
  // The point goes along x(t) = (0.3 + 4/3) t - 4/9 sin(3 t); minus the integral of dg/dt m x.
  double exact = 0;
  for (int i = 0; i < 100000; ++i) {
    const double t = (i + 0.5) * 1e-5;
    exact -= m * 12 * std::cos(3 * t) * ((0.3 + 4. / 3) * t - 4. / 9 * std::sin(3 * t)) * 1e-5;
  }
  run("implicit_euler", 0.01);
  for (const std::string integrator : {"bdf2", "tr_bdf2", "sdirk2", "midpoint", "newmark", "generalised_alpha"}) {
    const auto [work, integrators] = run(integrator, 0.01);
    const auto [finer_work, finer_integrators] = run(integrator, 0.005);
    EXPECT_NEAR(work, exact, 1e-3 * std::fabs(exact)) << integrator;
    EXPECT_GT(std::fabs(work - exact), 3.5 * std::fabs(finer_work - exact)) << integrator;
    EXPECT_LT(std::fabs(finer_integrators), std::fabs(integrators) / 3 + 1e-12) << integrator;
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

// A point on a spring slides to and fro: each stage of a method of several dissipates by its own speed. Over the whole
// step the last stage's friction would do so with the wrong sign where the motion turns.
TEST(Budget, OfStagesIsThatOfEach) {
  const double mu = 0.2, m = 0.5, k = 400;
  for (const std::string integrator : {"sdirk2", "tr_bdf2"}) {
    Matrix3Xd X(3, 2);
    X << 0, 1, 5e-4, 5e-4, 0, 0;
    BodyScene scene(X, Eigen::Vector2d(1, m), Vector3d(0, -9.81, 0), {1, 0});
    scene.add_springs({0, 1}, k, X);
    scene.add_ground({{.friction = mu}});
    scene.start({.dt = 2e-3,
                 .integrator = integrator,
                 .tolerance = 1e-7,
                 .friction_lag_iterations = 20,
                 .friction_tolerance = 1e-6});
    scene.state.x(0, 1) = 1.1;
    double total = scene.stepper->energies(scene.state).total, friction = 0, way = 0;
    for (int i = 0; i < 200; ++i) {
      const StepRecord record = scene.step();
      ASSERT_TRUE(record.accepted) << record.reason;
      const Budget& b = record.budget;
      EXPECT_NEAR(b.change, record.energy.total - total, 1e-10) << integrator;
      EXPECT_NEAR(b.residual, 0, 5e-7) << integrator << " step " << i;
      EXPECT_GE(b.friction, 0) << integrator << " step " << i;
      total = record.energy.total;
      friction += b.friction;
      way += std::abs(scene.state.x(0, 1) - scene.state.last_x(0, 1));
    }
    EXPECT_GT(way, 0.2);
    EXPECT_NEAR(friction, mu * m * 9.81 * way, 0.05 * friction) << integrator;
  }
}

TEST(Integrator, WeighsTheSlopesOfItsStagesAsItsTableSays) {
  EXPECT_TRUE(slope_weights(integrator_named("bdf2")).empty());
  const double gamma = 1 - std::sqrt(0.5), side = std::sqrt(2.0) / 4;
  const std::map<std::string, std::vector<double>> tables = {{"sdirk2", {0, 0, 1 - gamma, gamma}},
                                                             {"tr_bdf2", {0, side, side, gamma}}};
  for (const auto& [name, table] : tables) {
    const std::vector<double> found = slope_weights(integrator_named(name));
    ASSERT_EQ(found.size(), table.size()) << name;
    for (size_t i = 0; i < table.size(); ++i) EXPECT_NEAR(found[i], table[i], 1e-15) << name;
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
