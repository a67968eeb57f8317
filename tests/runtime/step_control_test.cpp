// Steps whose length adapts, and equilibria that follow a load.
#include "runtime/solver/step_control.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/error.h"
#include "tests/runtime/body_scene.h"

namespace ergon {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using testing::HasSubstr;

// A shallow dome of three bars: points on a circle hold an apex that is pressed down.
struct Dome {
  double radius = 1, height = 0.2, k = 300, weight = 1;
  double length() const { return std::hypot(radius, height); }

  // Force that the apex bears at height y.
  double force(double y) const { return 3 * k * y * (length() / std::hypot(radius, y) - 1); }
  // The force is greatest where its derivative 3*k*(length*radius^2/l^3 - 1) is zero.
  double limit_height() const {
    const double l = std::cbrt(length() * radius * radius);
    return std::sqrt(l * l - radius * radius);
  }

  BodyScene scene() const {
    Matrix3Xd X(3, 4);
    for (int i = 0; i < 3; ++i) X.col(i) = radius * Vector3d(std::cos(2 * M_PI / 3 * i), 0, std::sin(2 * M_PI / 3 * i));
    X.col(3) = Vector3d(0, height, 0);
    BodyScene out(X, Eigen::VectorXd::Ones(4), Vector3d(0, -weight, 0), {1, 1, 1, 0}, false);
    out.add_springs({0, 3, 1, 3, 2, 3}, k, X);
    out.start({.dt = 0.1, .integrator = "quasi_static", .tolerance = 1e-9, .project_on_demand = true});
    out.stepper->grow_loads({{0, "g", {0, -weight, 0}}}, 1);
    return out;
  }
};

const StepLimits limits{.largest = 0.1, .smallest = 1e-4, .interval = 0.1};

TEST(LoadStep, FollowsTheLoadToItsEnd) {
  Dome dome;
  dome.weight = 0.9 * dome.force(dome.limit_height());
  BodyScene scene = dome.scene();
  StepControl control(*scene.stepper, limits);
  while (scene.state.time < 1) {
    const StepRecord record = control.step(scene.state);
    ASSERT_TRUE(record.accepted) << record.reason;
    EXPECT_NEAR(dome.force(scene.state.x(1, 3)), record.load_factor * dome.weight, 1e-9 * dome.weight);
    EXPECT_EQ(record.energy.kinetic, 0);
  }
  EXPECT_EQ(scene.state.time, 1);
}

TEST(LoadStep, StopsAtALimitPointAndKeepsTheStateThere) {
  Dome dome;
  const double limit = dome.force(dome.limit_height());
  dome.weight = 2 * limit;
  BodyScene scene = dome.scene();
  StepControl control(*scene.stepper, limits);
  StepRecord record;
  State before;
  int refused = 0;
  do {
    before = scene.state;
    record = control.step(scene.state);
    refused += record.refused;
  } while (record.accepted && scene.state.time < 1);
  EXPECT_EQ(scene.state.x, before.x);
  EXPECT_EQ(scene.state.time, before.time);
  EXPECT_LE(scene.state.time, 0.5);
  EXPECT_GT(scene.state.time, 0.5 - 2e-4);
  EXPECT_NEAR(scene.state.x(1, 3), dome.limit_height(), 0.01 * dome.height);
  EXPECT_THAT(record.reason, testing::StartsWith("no stable equilibrium was found past load factor 0.49"));
  EXPECT_GT(refused, 0);
}

// A script that pulls the apex down by a soft spring has no load to speak of: the place is told as a time.
TEST(LoadStep, StopsAtALimitPointOfAScriptAndSaysWhen) {
  const Dome dome;
  Matrix3Xd X(3, 5);
  X.leftCols(4) = dome.scene().state.x;
  X.col(4) = X.col(3) - Vector3d(0, 1, 0);
  BodyScene scene(X, Eigen::VectorXd::Ones(5), Vector3d::Zero(), {1, 1, 1, 0, 1}, false);
  scene.add_springs({0, 3, 1, 3, 2, 3}, dome.k, X);
  scene.add_springs({3, 4}, 1, X);
  Script script;
  script.add({4}, X, X.col(4), {{1, {0, -10, 0}, {0, 0, 0}}});
  TimeStepper stepper(scene.system, scene.mass, nullptr,
                      {.dt = 0.1, .integrator = "quasi_static", .tolerance = 1e-9, .project_on_demand = true}, script);
  StepControl control(stepper, limits);
  StepRecord record;
  do record = control.step(scene.state);
  while (record.accepted);
  // The spring's force is greatest where the dome's is, at a time that its length tells.
  const double time = (dome.force(dome.limit_height()) + dome.height - dome.limit_height()) / 10;
  EXPECT_NEAR(scene.state.time, time, 1e-3);
  EXPECT_THAT(record.reason, testing::StartsWith("no stable equilibrium was found past 0.14375 s, as at a limit point; "
                                                 "the one there is kept. 0.000195 s later: the equilibrium found"));
}

// Pushed on by force, the dome snaps through to where its bars are in tension.
TEST(LoadStep, GoesThroughALimitPointWhenAskedTo) {
  Dome dome;
  dome.weight = 2 * dome.force(dome.limit_height());
  BodyScene scene = dome.scene();
  scene.stepper->options().accept_unconverged = true;
  StepControl control(*scene.stepper, limits);
  int unconverged = 0;
  while (scene.state.time < 1) {
    const StepRecord record = control.step(scene.state);
    ASSERT_TRUE(record.accepted) << record.reason;
    unconverged += !record.converged;
  }
  EXPECT_LE(unconverged, 1);  // the step that ends at the limit point: rounding decides
  EXPECT_LT(scene.state.x(1, 3), -dome.height);
  EXPECT_NEAR(dome.force(scene.state.x(1, 3)), dome.weight, 1e-9 * dome.weight);
}

// A stiff bar on a hinge, its upper end held sideways by springs k, tips over where the load P on it is k times its
// length, which is L - P/axial then: a branching point, at which the tangent alone shows that something happens.
TEST(LoadStep, StopsAtABranchingPoint) {
  const double length = 0.5, axial = 1e5, side = 10, critical = side * length / (1 + side / axial);
  Matrix3Xd X(3, 4);
  X << 0, 0, 1, 0, 0, length, length, length, 0, 0, 0, 1;
  const Vector3d weight(0, -2 * critical, 0);
  BodyScene scene(X, Eigen::Vector4d::Ones(), weight, {1, 0, 1, 1}, false);
  scene.add_springs({0, 1}, axial, X);
  scene.add_springs({1, 2, 1, 3}, side, X);
  scene.start({.dt = 0.1, .integrator = "quasi_static", .tolerance = 1e-9, .project_on_demand = true});
  scene.stepper->grow_loads({{0, "g", {weight[0], weight[1], weight[2]}}}, 1);
  StepControl control(*scene.stepper, limits);
  StepRecord record;
  do {
    record = control.step(scene.state);
  } while (record.accepted);
  EXPECT_NEAR(record.load_factor, 0.5, 1e-3);
  EXPECT_THAT(record.reason, HasSubstr("the tangent is not positive definite there"));
}

TEST(StepControl, HalvesADtThatFailsAndLetsItGrowAgain) {
  BodyScene scene = point_scene(Vector3d(0, 0.5, 0), Vector3d(0, -30, 0), Vector3d(0, -9.81, 0));
  scene.add_ground({Ground{}});
  scene.start({.dt = 0.02, .max_iterations = 6});
  ASSERT_FALSE(scene.step().accepted);
  StepControl control(*scene.stepper, {.largest = 0.02, .smallest = 1e-7, .interval = 0.02});
  int refused = 0;
  std::vector<double> ends;
  while (scene.state.time < 0.2) {
    const StepRecord record = control.step(scene.state);
    ASSERT_TRUE(record.accepted) << record.reason;
    refused += record.refused;
    ends.push_back(record.time);
    ASSERT_LT(ends.size(), 1000u);
  }
  EXPECT_GT(refused, 0);
  for (int i = 1; i <= 10; ++i) EXPECT_THAT(ends, testing::Contains(i * 0.02));
  EXPECT_NEAR(scene.stepper->options().dt, 0.02, 1e-12);
}

TEST(StepControl, RefusesLimitsThatMakeNoSense) {
  BodyScene scene = point_scene(Vector3d(0, 1, 0), Vector3d::Zero(), Vector3d::Zero());
  scene.start({.dt = 0.01});
  const auto message = [&](const StepLimits& bad) -> std::string {
    try {
      StepControl control(*scene.stepper, bad);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({.largest = 0.1, .smallest = 0.2, .interval = 1}),
            "the smallest dt is 0.2 s and the largest 0.1 s; the smallest must be above 0, and not above the largest");
  EXPECT_EQ(message({.largest = 0.1, .smallest = 0.1, .interval = 0}), "the interval is 0 s; it must be above 0");
}

}  // namespace
}  // namespace ergon
