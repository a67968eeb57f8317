// Damping in proportion to the stiffness that a potential has at the start of a step.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "runtime/error.h"
#include "tests/runtime/body_scene.h"

namespace ergon {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double mass = 0.5, stiffness = 200, beta = 0.01, end = 0.4;

// A point on a spring of next to no length, that is a linear oscillator in the plane.
BodyScene oscillator(const std::string& integrator, double dt) {
  Matrix3Xd X = Matrix3Xd::Zero(3, 2);
  X(0, 1) = 1e-12;
  BodyScene scene(X, Eigen::Vector2d(1, mass), Vector3d::Zero(), {1, 0});
  scene.add_springs({0, 1}, stiffness, X);
  scene.system.damp(2, beta);
  scene.state.x.col(1) = Vector3d(1, 0, 0);
  scene.state.v.col(1) = Vector3d(0, 10, 0);
  scene.start({.dt = dt, .integrator = integrator, .tolerance = 1e-11});
  return scene;
}

// x'' + 2 zeta w x' + w^2 x = 0 with zeta = beta*w/2: Craig, Kurdila 2006, Fundamentals of Structural Dynamics, 2nd
// ed., proportional damping.
Vector3d damped_oscillation(double t) {
  const double w = std::sqrt(stiffness / mass), zeta = beta * w / 2, wd = w * std::sqrt(1 - zeta * zeta);
  const double decay = std::exp(-zeta * w * t), c = std::cos(wd * t), s = std::sin(wd * t);
  return {decay * (c + zeta * w / wd * s), decay * 10 / wd * s, 0};
}

double error_of(const std::string& integrator, int steps) {
  BodyScene scene = oscillator(integrator, end / steps);
  for (int i = 0; i < steps; ++i) EXPECT_TRUE(scene.step().accepted);
  return (scene.state.x.col(1) - damped_oscillation(end)).norm();
}

TEST(StiffnessDamping, GivesAnOscillatorItsRatioInTheOrderOfEachIntegrator) {
  for (const std::string integrator :
       {"implicit_euler", "bdf2", "sdirk2", "tr_bdf2", "newmark", "midpoint", "generalised_alpha"}) {
    const double coarse = error_of(integrator, 160), fine = error_of(integrator, 320);
    EXPECT_GT(std::log2(coarse / fine), integrator == "implicit_euler" ? 0.9 : 1.9) << integrator;
    EXPECT_LT(fine, integrator == "implicit_euler" ? 0.05 : 2e-3) << integrator;
  }
}

TEST(StiffnessDamping, TakesTheEnergyThatTheBudgetSays) {
  BodyScene scene = oscillator("implicit_euler", 0.01);
  for (int i = 0; i < 30; ++i) {
    const StepRecord record = scene.step();
    const Vector3d way = scene.state.x.col(1) - scene.state.last_x.col(1);
    EXPECT_NEAR(record.budget.damping, beta * stiffness * way.squaredNorm() / 0.01, 1e-10);
    EXPECT_NEAR(record.budget.residual, 0, 1e-9);
    EXPECT_NEAR(record.budget.change + record.budget.damping + record.budget.integrator, 0, 1e-9);
  }
}

TEST(StiffnessDamping, IsRefusedWithoutATimeOrAStiffness) {
  BodyScene scene = oscillator("implicit_euler", 0.01);
  const auto refusal = [&](int potential, double time) {
    try {
      scene.system.damp(potential, time);
    } catch (const InputError& bad) {
      return std::string(bad.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal(2, -1), "stiffness damping of spring is -1 s; it must be above 0 and finite");
  EXPECT_EQ(refusal(1, 0.1), "gravity has no stiffness that damping could be in proportion to");
}

// A body of four control points that carries vertex 5, and vertices 6 free, 7 guided, 8 fixed; all joined by springs.
TEST(StiffnessDamping, HasConsistentDerivativesWhateverMovesTheVertices) {
  Matrix3Xd X(3, 8), x, from;
  X << 0, 1, 0, 0, 0.3, 2, 2, 3,  //
      0, 0, 1, 0, 0.3, 0, 1, 1,   //
      0, 0, 0, 1, 0.3, 0, 1, 2;
  from = X + 0.1 * Matrix3Xd::Random(3, 8);
  x = from + 0.1 * Matrix3Xd::Random(3, 8);
  System system(8), plain(8);
  const Eigen::Matrix3d along = Vector3d(1, 2, 2).normalized() * Vector3d(1, 2, 2).normalized().transpose();
  for (System* made : {&system, &plain}) {
    Carriers carriers;
    const int body = carriers.add_body(0);
    carriers.carry(4, body, {0.1, 0.3, 0.3, 0.3});
    made->set_fixed({0, 0, 0, 0, 0, 0, 0, 1});
    made->set_carriers(carriers);
    made->set_guides({{6, along}});
    made->add(Potential::on_stencils("spring", body_kernels::spring(), {4, 5, 5, 6, 4, 6, 6, 7, 5, 7, 0, 1}, X,
                                     {{"k", {10}}}, {}));
  }
  system.damp(0, 0.2);
  system.lag_stiffness(from);
  system.lag_motion(from, 0.05);
  system.carriers().place(x);
  Matrix3Xd full;
  system.gradient_of({0}, x, full);
  system.add_damping(system.lagged_velocity(x), full);

  const auto moved = [&](int v, int c, double by) {
    Matrix3Xd out = x;
    out(c, v) += by;
    system.carriers().place(out);
    return out;
  };
  constexpr double h = 1e-5;
  for (const int v : {0, 1, 2, 3, 5, 6, 7})
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(full(c, v), (system.value(moved(v, c, h)).value - system.value(moved(v, c, -h)).value) / (2 * h),
                  1e-7);

  Matrix3Xd g, undamped, up, down;
  BlockMatrix H, P;
  system.hessian(x, Projection::none, g, H);
  plain.hessian(x, Projection::none, undamped, P);
  EXPECT_EQ(full.col(7), g.col(7));  // what holds it
  EXPECT_LT((along * full.col(6) - g.col(6)).norm(), 1e-12);
  EXPECT_GT((g - undamped).norm(), 1);
  for (const int v : {0, 1, 2, 3, 5}) {
    system.gradient(moved(v, 0, h), up);
    system.gradient(moved(v, 0, -h), down);
    Eigen::VectorXd column;
    H.multiply(Eigen::VectorXd::Unit(H.rows(), 3 * system.block_of(v)), column);
    for (const int w : {0, 1, 2, 3, 5, 6})
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(column(3 * system.block_of(w) + c), (up(c, w) - down(c, w)) / (2 * h), 1e-6) << v << w;
  }
}

}  // namespace
}  // namespace ergon
