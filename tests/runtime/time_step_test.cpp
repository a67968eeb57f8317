#include "runtime/solver/time_step.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/error.h"
#include "tests/runtime/body_scene.h"

namespace ergon {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using testing::Contains;
using testing::HasSubstr;

const Vector3d down(0, -9.81, 0);

double stored(const Energies& energies, const std::string& name) {
  for (const auto& [potential, value] : energies.stored) {
    if (potential == name) return value;
  }
  ADD_FAILURE() << "no energy of " << name;
  return 0;
}

// Implicit Euler falls g*dt*t/2 too far, whatever the step.
TEST(TimeStep, FreeFallHasTheErrorOfImplicitEuler) {
  for (double dt : {0.1, 0.01, 0.003}) {
    BodyScene scene = point_scene(Vector3d(0.3, 10, -2), Vector3d(1, 2, 3), down, 0.7);
    scene.start({.dt = dt});
    for (int i = 0; i < 50; ++i) {
      const StepRecord record = scene.step();
      ASSERT_TRUE(record.accepted) << record.reason;
      EXPECT_EQ(record.newton_iterations, 1);
      EXPECT_EQ(record.factorisations, 1);
    }
    const double t = scene.state.time;
    EXPECT_NEAR(t, 50 * dt, 1e-12);
    EXPECT_EQ(scene.state.step, 50);
    const Vector3d exact = Vector3d(0.3, 10, -2) + t * Vector3d(1, 2, 3) + t * t / 2 * down;
    EXPECT_LT((scene.state.x.col(0) - exact - dt * t / 2 * down).norm(), 1e-12);
    EXPECT_LT((scene.state.v.col(0) - Vector3d(1, 2, 3) - t * down).norm(), 1e-10);
  }
}

// A linear oscillator keeps 1/(1 + (omega dt)^2) of its energy per step: 0.5352 per period at omega dt = 0.1.
TEST(TimeStep, OscillatorLosesEnergyAsImplicitEulerDoes) {
  Matrix3Xd X(3, 2);
  X << 0, 1, 0, 0, 0, 0;
  const double omega = 20, mass = 0.5;
  BodyScene scene(X, Eigen::Vector2d(1, mass), Vector3d::Zero(), {1, 0});
  scene.add_springs({0, 1}, mass * omega * omega, X);
  scene.state.x(0, 1) = 1.2;
  StepOptions options;
  options.dt = 0.1 / omega;
  options.tolerance = 1e-9;
  scene.start(options);
  const double before = scene.stepper->energies(scene.state).total;
  EXPECT_NEAR(before, mass * omega * omega / 2 * 0.04, 1e-13);
  const int steps = 63;
  StepRecord record;
  for (int i = 0; i < steps; ++i) {
    record = scene.step();
    ASSERT_TRUE(record.converged) << record.reason;
  }
  EXPECT_NEAR(record.energy.total / before, std::pow(1.01, -steps), 1e-10);
  const double per_period = std::pow(record.energy.total / before, 2 * M_PI / 0.1 / steps);
  EXPECT_NEAR(per_period, 0.5352, 5e-5);
  EXPECT_EQ(scene.state.x.col(0), X.col(0));
  EXPECT_NEAR(stored(record.energy, "spring") + record.energy.kinetic, record.energy.total, 1e-15);
}

TEST(TimeStep, SlidingPointStopsWhereCoulombStopsIt) {
  BodyScene scene = point_scene(Vector3d(0, 5e-4, 0), Vector3d::Zero(), down, 2);
  scene.add_ground({{.friction = 0.3}});
  StepOptions options;
  options.dt = 1e-3;
  options.tolerance = 1e-7;
  scene.start(options);
  for (int i = 0; i < 500; ++i) ASSERT_TRUE(scene.step().accepted);
  EXPECT_LT(scene.state.v.norm(), 1e-6);
  const double start = scene.state.x(0, 0);
  scene.state.v.col(0) = Vector3d(1, 0, 0);
  for (int i = 0; i < 600; ++i) {
    const StepRecord record = scene.step();
    ASSERT_TRUE(record.accepted) << record.reason;
    EXPECT_EQ(record.contacts, 1);
  }
  // v^2/(2 mu g), less v*dt/2 for implicit Euler, to the distance crept below epsv.
  const double coulomb = 1 / (2 * 0.3 * 9.81);
  EXPECT_NEAR(coulomb, 0.16989, 5e-6);
  EXPECT_NEAR(scene.state.x(0, 0) - start, coulomb - options.dt / 2, 1e-5);
  EXPECT_LT(scene.state.v.norm(), 1e-6);
}

// The slope is made by turning gravity.
Vector3d tilted(double degrees) {
  const double angle = degrees * M_PI / 180;
  return 9.81 * Vector3d(std::sin(angle), -std::cos(angle), 0);
}

TEST(TimeStep, PointSticksBelowTheAngleOfFriction) {
  BodyScene scene = point_scene(Vector3d(0, 2e-4, 0), Vector3d::Zero(), tilted(15));  // tan 15 = 0.268 < 0.3
  scene.add_ground({{.friction = 0.3, .epsv = 1e-5}});
  scene.start({.dt = 0.01, .tolerance = 1e-8});
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(scene.step().accepted);
  const double start = scene.state.x(0, 0);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(scene.step().accepted);
  EXPECT_GT(scene.state.x(0, 0), start);         // lagged friction creeps,
  EXPECT_LT(scene.state.x(0, 0) - start, 1e-5);  // slower than epsv for one second
}

TEST(TimeStep, PointSlidesAboveTheAngleOfFriction) {
  const double angle = 25 * M_PI / 180;
  BodyScene scene = point_scene(Vector3d(0, 1e-4, 0), Vector3d::Zero(), tilted(25));
  scene.add_ground({{.friction = 0.3}});
  scene.start({.dt = 0.01, .tolerance = 1e-8});
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(scene.step().accepted);
  const double before = scene.state.v(0, 0);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(scene.step().accepted);
  EXPECT_NEAR(scene.state.v(0, 0) - before, 9.81 * (std::sin(angle) - 0.3 * std::cos(angle)), 1e-5);
}

// The energy of a body left to itself never rises, and no vertex is ever on or below the ground.
void run_impact(BodyScene& scene, int steps, double rounding) {
  double before = scene.stepper->energies(scene.state).total;
  const double scale = std::abs(before) + scene.stepper->energies(scene.state).kinetic;
  for (int i = 0; i < steps; ++i) {
    const StepRecord record = scene.step();
    ASSERT_TRUE(record.accepted) << "step " << i << ": " << record.reason;
    ASSERT_GT(record.smallest_gap, 0) << "step " << i;
    ASSERT_GT(scene.state.x.row(1).minCoeff(), 0) << "step " << i;
    ASSERT_LE(record.energy.total, before + record.energy_added + rounding * scale) << "step " << i;
    before = record.energy.total;
  }
}

TEST(TimeStep, PointAtAThousandMetresPerSecondStaysAboveTheGround) {
  for (double height : {1e-4, 0.5, 19.9999, 20.0, 20.0009, 33.0}) {
    BodyScene scene = point_scene(Vector3d(0, height, 0), Vector3d(0, -1000, 0), down);
    scene.add_ground({Ground{}});
    scene.start({.dt = 0.02});
    run_impact(scene, 100, 1e-9);
    EXPECT_LT(scene.state.v.norm(), 3) << height;  // the impact is nearly inelastic
  }
}

TEST(TimeStep, CubeAtAThousandMetresPerSecondStaysAboveTheGround) {
  BodyScene scene = cube_scene(0.2, 10, 1, 1e4, down);
  for (int i = 0; i < 8; ++i) scene.state.v.col(i) = Vector3d(30, -1000, 5 * i);
  scene.add_ground({{.friction = 0.5}});
  scene.start({.dt = 0.02});
  run_impact(scene, 50, 1e-9);
}

TEST(TimeStep, DroppedCubeComesToRestAndLosesEnergyAllTheWay) {
  BodyScene scene = cube_scene(0.1, 0.3, 1, 2000, down);
  for (int i = 0; i < 8; ++i) scene.state.v.col(i) = Vector3d(0.5, 0, 0.2 * (i & 1));
  scene.add_ground({{.friction = 0.4}});
  scene.start({.dt = 0.01, .tolerance = 1e-6});
  run_impact(scene, 400, 1e-10);
  EXPECT_LT(scene.state.v.cwiseAbs().maxCoeff(), 1e-4);
  const StepRecord record = scene.step();
  EXPECT_GE(record.contacts, 3);
  double support = 0;
  for (const GroundContact::Force& force : scene.ground->forces(scene.state.x)) support += force.newton;
  EXPECT_NEAR(support, 9.81, 1e-3);
}

TEST(TimeStep, FailedStepLeavesTheStateAndSaysWhy) {
  BodyScene scene = point_scene(Vector3d(0, 0.5, 0), Vector3d(0, -100, 0), down);
  scene.add_ground({Ground{}});
  scene.start({.dt = 0.02, .max_iterations = 2});
  const State before = scene.state;
  const StepRecord record = scene.step();
  EXPECT_FALSE(record.accepted);
  EXPECT_FALSE(record.converged);
  EXPECT_THAT(record.reason, HasSubstr("2 Newton iterations did not reach the tolerance of 0.0001 m/s"));
  EXPECT_EQ(scene.state.x, before.x);
  EXPECT_EQ(scene.state.v, before.v);
  EXPECT_EQ(scene.state.step, before.step);
  EXPECT_EQ(scene.state.time, before.time);
  EXPECT_EQ(record.smallest_gap, 0.5);
  EXPECT_DOUBLE_EQ(record.energy.total, 9.81 * 0.5 + 100 * 100 / 2);

  scene.stepper->options().max_iterations = 200;
  EXPECT_TRUE(scene.step().accepted);
}

TEST(TimeStep, GoesOnUnconvergedOnlyWhenAsked) {
  BodyScene scene = point_scene(Vector3d(0, 0.5, 0), Vector3d(0, -100, 0), down);
  scene.add_ground({Ground{}});
  scene.start({.dt = 0.02, .max_iterations = 2, .accept_unconverged = true});
  const StepRecord record = scene.step();
  EXPECT_TRUE(record.accepted);
  EXPECT_FALSE(record.converged);
  EXPECT_FALSE(record.reason.empty());
  EXPECT_EQ(scene.state.step, 1);
  EXPECT_GT(scene.state.x(1, 0), 0);
}

TEST(TimeStep, SaysWhatItSkipped) {
  BodyScene scene = point_scene(Vector3d(0, 1, 0), Vector3d::Zero(), down);
  scene.add_ground({{.friction = 0.3}});
  scene.start({.dt = 0.01});
  const StepRecord falling = scene.step();
  EXPECT_THAT(falling.skipped, Contains("contact: no vertex came within dhat of the ground"));
  EXPECT_THAT(falling.skipped, Contains("friction: no vertex within dhat of the ground"));
  EXPECT_EQ(falling.friction_iterations, 1);
  EXPECT_EQ(falling.contacts, 0);
  for (int i = 0; i < 100; ++i) scene.step();
  const StepRecord resting = scene.step();
  EXPECT_EQ(resting.contacts, 1);
  EXPECT_THAT(resting.skipped, testing::Not(Contains(HasSubstr("vertex"))));

  BodyScene bare = point_scene(Vector3d(0, 1, 0), Vector3d::Zero(), down);
  bare.start({.dt = 0.01});
  EXPECT_THAT(bare.step().skipped, Contains("contact: nothing in the scene may touch"));
}

TEST(TimeStep, FixedVerticesStayAndCarryNoEnergyOfMotion) {
  BodyScene scene = cube_scene(0.1, 0.3, 1, 2000, down);
  scene.system.set_fixed({1, 1, 0, 0, 0, 0, 0, 0});
  scene.start({.dt = 0.01});
  const State before = scene.state;
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(scene.step().accepted);
  EXPECT_EQ(scene.state.x.leftCols(2), before.x.leftCols(2));
  EXPECT_EQ(scene.state.v.leftCols(2), before.v.leftCols(2));
  EXPECT_LT(scene.state.x(1, 7), before.x(1, 7));
}

// With the energies of the state at the end as those of the next step's start: nothing is hidden between steps.
TEST(TimeStep, EnergiesOfAStateAreThoseOfTheStepThatReachedIt) {
  BodyScene scene = cube_scene(0.1, 0.02, 1, 2000, down);
  scene.add_ground({{.friction = 0.4}});
  scene.start({.dt = 0.01});
  for (int i = 0; i < 40; ++i) {
    const StepRecord record = scene.step();
    EXPECT_NEAR(scene.stepper->energies(scene.state).total, record.energy.total, 1e-13);
  }
}

TEST(TimeStep, RefusesWhatIsNotAStep) {
  BodyScene scene = point_scene(Vector3d(0, 1, 0), Vector3d::Zero(), down);
  const auto message = [&](const StepOptions& options) -> std::string {
    try {
      scene.start(options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({.dt = 0}), "dt is 0 s; it must be above 0");
  EXPECT_EQ(message({.dt = 0.01, .tolerance = -1}), "tolerance is -1 m/s; it must be above 0");
  EXPECT_EQ(message({.max_iterations = 0}), "max_iterations must be at least 1");
  EXPECT_EQ(message({.friction_lag_iterations = 0}), "friction_lag_iterations must be at least 1");
}

}  // namespace
}  // namespace ergon
