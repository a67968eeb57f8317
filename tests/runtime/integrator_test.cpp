// Time integrators: the energy that they keep, their order, and what they do at contact.
#include "runtime/solver/integrator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "runtime/error.h"
#include "tests/runtime/body_scene.h"

namespace ergon {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// A point of 0.5 kg on a spring from the origin, at first along it: omega = 20/s.
BodyScene oscillator() {
  Matrix3Xd X(3, 2);
  X << 0, 1, 0, 0, 0, 0;
  BodyScene scene(X, Eigen::Vector2d(1, 0.5), Vector3d::Zero(), {1, 0});
  scene.add_springs({0, 1}, 0.5 * 20 * 20, X);
  return scene;
}

std::vector<std::string> moving_integrators() {
  std::vector<std::string> names = integrator_names();
  std::erase_if(names, [](const std::string& name) { return !integrator_named(name).has_inertia; });
  return names;
}

class EveryIntegrator : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(runtime, EveryIntegrator, testing::ValuesIn(moving_integrators()),
                         [](const auto& info) { return info.param; });

// Moduli of the largest root per step for x'' = -omega^2 x, omega dt = 0.1, squared over a period. The one of implicit
// Euler is (1 + 0.01)^(-2 pi/0.1).
TEST_P(EveryIntegrator, KeepsOfAnOscillatorsEnergyWhatItsRootsSay) {
  const std::map<std::string, double> kept = {{"implicit_euler", 0.5352}, {"bdf2", 0.99694}, {"sdirk2", 0.999954},
                                              {"tr_bdf2", 0.999954},      {"midpoint", 1},   {"newmark", 1}};
  BodyScene scene = oscillator();
  scene.state.x(0, 1) = 1.2;
  scene.start({.dt = 0.1 / 20, .integrator = GetParam(), .tolerance = 1e-10});
  // Whole periods, as the energy of some methods swings within one.
  const int settle = 628, steps = 1257;
  double before = 0, after = 0;
  for (int i = 0; i < settle + steps; ++i) {
    const StepRecord record = scene.step();
    ASSERT_TRUE(record.converged) << record.reason;
    if (i + 1 == settle) before = record.energy.total;
    after = record.energy.total;
  }
  const double per_period = std::pow(after / before, 2 * M_PI / 0.1 / steps);
  if (const auto known = kept.find(GetParam()); known != kept.end())
    EXPECT_NEAR(per_period, known->second, known->second == 1 ? 1e-9 : 5e-5);
  else
    EXPECT_NEAR(per_period, 1, 1e-4);
}

// A point swings on a spring that stretches: nonlinear. Where it is after 0.4 s.
Vector3d swung(const std::string& integrator, int steps, bool uneven = false) {
  Matrix3Xd X(3, 2);
  X << 0, 1, 0, 0, 0, 0;
  BodyScene scene(X, Eigen::Vector2d(1, 0.5), Vector3d(0, -9.81, 0), {1, 0});
  scene.add_springs({0, 1}, 40, X);
  const double dt = 0.4 / steps;
  scene.start({.dt = dt, .integrator = integrator, .tolerance = 1e-12});
  for (int i = 0; i < steps; ++i) {
    if (uneven) scene.stepper->options().dt = dt * (i % 2 == 0 ? 1.5 : 0.5);
    const StepRecord record = scene.step();
    EXPECT_TRUE(record.converged) << record.reason;
  }
  EXPECT_NEAR(scene.state.time, 0.4, 1e-12);
  return scene.state.x.col(1);
}

TEST_P(EveryIntegrator, ConvergesWithItsOrder) {
  const Vector3d exact = swung("newmark", 8192);
  const double coarse = (swung(GetParam(), 64) - exact).norm(), fine = (swung(GetParam(), 128) - exact).norm();
  const int order = integrator_named(GetParam()).order;
  EXPECT_GT(coarse, 1e-6);
  EXPECT_NEAR(std::log2(coarse / fine), order, 0.15);
}

TEST(Integrator, Bdf2KeepsItsOrderWithUnevenSteps) {
  const Vector3d exact = swung("newmark", 8192);
  const double coarse = (swung("bdf2", 128, true) - exact).norm(), fine = (swung("bdf2", 256, true) - exact).norm();
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.15);
}

// A parabola is a polynomial of second degree.
TEST_P(EveryIntegrator, OfSecondOrderFallsExactly) {
  if (integrator_named(GetParam()).order < 2) return;
  BodyScene scene = point_scene(Vector3d(0.3, 10, -2), Vector3d(1, 2, 3), Vector3d(0, -9.81, 0), 0.7);
  scene.start({.dt = 0.05, .integrator = GetParam()});
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(scene.step().accepted);
  const Vector3d exact = Vector3d(0.3, 10, -2) + Vector3d(1, 2, 3) + Vector3d(0, -9.81, 0) / 2;
  EXPECT_LT((scene.state.x.col(0) - exact).norm(), 1e-11);
  EXPECT_LT((scene.state.v.col(0) - Vector3d(1, 2 - 9.81, 3)).norm(), 1e-11);
  EXPECT_LT((scene.state.a.col(0) - Vector3d(0, -9.81, 0)).norm(), 1e-9);
}

// Sums of momenta: springs between free points give none.
TEST_P(EveryIntegrator, KeepsLinearMomentum) {
  BodyScene scene = cube_scene(0.3, 1, 2, 300, Vector3d::Zero());
  scene.state.v.setRandom();
  const Vector3d before = scene.state.v * scene.mass;
  scene.start({.dt = 0.01, .integrator = GetParam(), .tolerance = 1e-7});
  for (int i = 0; i < 20; ++i) {
    const StepRecord record = scene.step();
    ASSERT_TRUE(record.accepted) << record.reason;
  }
  EXPECT_LT((scene.state.v * scene.mass - before).norm(), 1e-6);
}

// A dropped cube stays above the ground, or the step that would not says why.
TEST_P(EveryIntegrator, StaysAboveTheGroundOrSaysWhy) {
  BodyScene scene = cube_scene(0.2, 0.05, 1, 2000, Vector3d(0, -9.81, 0));
  scene.add_ground({{.friction = 0.3}});
  scene.start({.dt = 0.01, .integrator = GetParam()});
  StepRecord record;
  for (int i = 0; i < 60; ++i) {
    const Matrix3Xd before = scene.state.x;
    record = scene.step();
    EXPECT_GT(scene.state.x.row(1).minCoeff(), 0);
    if (record.accepted) continue;
    EXPECT_EQ(scene.state.x, before);
    break;
  }
  const bool goes_beyond = !integrator_named(GetParam()).end_x.empty();
  if (goes_beyond && !record.accepted)
    EXPECT_EQ(record.reason,
              "the integrator " + GetParam() +
                  " ends its step beyond its last stage, where surfaces collide; take one that does not, "
                  "as sdirk2 or bdf2");
  else
    EXPECT_TRUE(record.accepted) << record.reason;
}

TEST(Integrator, NamesTheIntegratorsThereAre) {
  try {
    integrator_named("euler");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "there is no integrator 'euler'; there are implicit_euler, bdf2, sdirk2, tr_bdf2, midpoint, newmark, "
                 "generalised_alpha, quasi_static");
  }
}

}  // namespace
}  // namespace ergon
