// Steps whose dt follows the estimated error of the integrator.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/error.h"
#include "runtime/solver/step_control.h"
#include "tests/runtime/body_scene.h"

namespace ergon {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// Of newmark 1/6 - beta with beta = 1/4; of midpoint the same; implicit Euler makes t^2 of t^2/2.
TEST(ErrorConstant, IsWhatTheMethodMakesOfAPower) {
  EXPECT_NEAR(error_constant(integrator_named("newmark")), 1.0 / 12, 1e-15);
  EXPECT_NEAR(error_constant(integrator_named("midpoint")), 1.0 / 12, 1e-15);
  EXPECT_NEAR(error_constant(integrator_named("implicit_euler")), 0.5, 1e-15);
  for (const char* name : {"bdf2", "sdirk2", "tr_bdf2", "generalised_alpha"}) {
    EXPECT_GT(error_constant(integrator_named(name)), 0.01) << name;
    EXPECT_LT(error_constant(integrator_named(name)), 1) << name;
  }
}

class AdaptiveStep : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(runtime, AdaptiveStep,
                         testing::Values("implicit_euler", "bdf2", "sdirk2", "tr_bdf2", "midpoint", "newmark",
                                         "generalised_alpha"),
                         [](const auto& info) { return info.param; });

struct Swing {
  Vector3d x;
  int steps = 0, refused = 0;
  double largest_error = 0;
};

// A point of 0.5 kg swings on a spring for 0.4 s; infinite tolerance: in steps of `dt`.
Swing swing(const std::string& integrator, double dt, double tolerance) {
  Matrix3Xd X(3, 2);
  X << 0, 1, 0, 0, 0, 0;
  BodyScene scene(X, Eigen::Vector2d(1, 0.5), Vector3d(0, -9.81, 0), {1, 0});
  scene.add_springs({0, 1}, 40, X);
  scene.start({.dt = dt, .integrator = integrator, .tolerance = 1e-12});
  StepControl control(*scene.stepper, {.largest = dt, .smallest = 1e-9, .interval = 0.1, .tolerance = tolerance});
  Swing out;
  while (scene.state.time < 0.4) {
    const StepRecord record = control.step(scene.state);
    EXPECT_TRUE(record.accepted) << record.reason;
    ++out.steps;
    out.refused += record.refused;
    out.largest_error = std::max(out.largest_error, record.error);
  }
  out.x = scene.state.x.col(1);
  return out;
}

// Error per step of order p + 1, so that of the whole motion goes as tolerance^(p/(p + 1)): over three decades.
TEST_P(AdaptiveStep, ErrorFollowsTheTolerance) {
  const Vector3d exact = swing("newmark", 0.4 / 8192, INFINITY).x;
  const int order = integrator_named(GetParam()).order;
  const double first = order == 1 ? 1e-4 : 1e-5;
  std::vector<double> errors;
  for (int decade = 0; decade <= 3; ++decade) {
    const double tolerance = first * std::pow(10, -decade);
    const Swing run = swing(GetParam(), 0.1, tolerance);
    errors.push_back((run.x - exact).norm());
    EXPECT_LE(run.largest_error, tolerance);
    EXPECT_LT(run.refused, 10 + run.steps / 10);
    EXPECT_LT(errors.back(), 60 * std::pow(tolerance, order / (order + 1.0)));
  }
  const double slope = std::log10(errors.front() / errors.back()) / 3;
  EXPECT_NEAR(slope, order / (order + 1.0), 0.12);
}

// A stiff, nearly elastic bounce takes short steps while it lasts and long ones in the air.
TEST(AdaptiveStepOf, BounceIsResolvedAndFramesAreHitExactly) {
  BodyScene scene = point_scene(Vector3d(0, 0.1, 0), Vector3d::Zero(), Vector3d(0, -9.81, 0));
  scene.add_ground({Ground{.stiffness = 1e6}});
  scene.start({.dt = 0.02, .integrator = "newmark", .tolerance = 1e-8});
  const double start = scene.stepper->energies(scene.state).total;
  StepControl control(*scene.stepper, {.largest = 0.02, .smallest = 1e-9, .interval = 0.02, .tolerance = 1e-8});
  std::vector<double> times;
  double shortest = 1, longest = 0, energy = 0;
  while (scene.state.time < 0.4) {
    const StepRecord record = control.step(scene.state);
    ASSERT_TRUE(record.accepted) << record.reason;
    times.push_back(record.time);
    shortest = std::min(shortest, record.dt);
    longest = std::max(longest, record.dt);
    energy = record.energy.total;
    ASSERT_LT(times.size(), 20000u);
  }
  for (int frame = 1; frame <= 20; ++frame) EXPECT_THAT(times, testing::Contains(frame * 0.02));
  EXPECT_LT(shortest, longest / 100);
  EXPECT_NEAR(energy, start, 0.001 * start);
  // Up again after twice the time of the fall.
  const double fall = std::sqrt(2 * 0.1 / 9.81), t = scene.state.time - 2 * fall;
  EXPECT_NEAR(scene.state.x(1, 0), 0.1 - 9.81 / 2 * t * t, 1e-3);
}

TEST(AdaptiveStepOf, RefusesATolerance) {
  BodyScene scene = point_scene(Vector3d(0, 1, 0), Vector3d::Zero(), Vector3d::Zero());
  const auto message = [&](const std::string& integrator, double tolerance) -> std::string {
    scene.start({.dt = 0.01, .integrator = integrator});
    try {
      StepControl control(*scene.stepper, {.largest = 1, .smallest = 1e-3, .interval = 1, .tolerance = tolerance});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message("bdf2", 0), "the tolerance is 0 m; it must be above 0");
  EXPECT_EQ(message("quasi_static", 1e-3), "without inertia a step has no error in time that a tolerance could be for");
}

}  // namespace
}  // namespace ergon
