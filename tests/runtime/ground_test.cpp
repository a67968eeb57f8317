#include "runtime/contact/ground.h"

#include <gtest/gtest.h>

#include "runtime/error.h"
#include "tests/runtime/body_scene.h"

namespace ergon {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

const Vector3d down(0, -9.81, 0);

Matrix3Xd column(const Vector3d& x) { return x; }

TEST(Barrier, SlopeIsTheDerivativeOfTheValue) {
  const double dhat = 2e-3;
  for (double gap : {1e-9, 1e-6, 5e-4, 1.9e-3}) {
    const double h = 1e-5 * std::min(gap, dhat - gap);
    const double difference = (barrier_value(gap + h, dhat) - barrier_value(gap - h, dhat)) / (2 * h);
    EXPECT_NEAR(barrier_slope(gap, dhat), difference, 1e-7 * std::abs(difference)) << gap;
    EXPECT_LT(barrier_slope(gap, dhat), 0);
  }
  EXPECT_EQ(barrier_value(dhat, dhat), 0);
  EXPECT_EQ(barrier_slope(1.0, dhat), 0);
}

// The potential in the system is the law that friction's normal forces are computed from.
TEST(Ground, ForcesAreTheGradientOfTheBarrier) {
  BodyScene scene = point_scene(Vector3d(0.1, 3e-4, 0), Vector3d::Zero(), Vector3d::Zero());
  scene.add_ground({{.normal = Vector3d(0, 2, 0), .stiffness = 70}});
  scene.start({.dt = 0.01});
  scene.stepper->energies(scene.state);
  Matrix3Xd gradient(3, 1);
  const Evaluation at_rest = scene.system.gradient(scene.state.x, gradient);
  const auto forces = scene.ground->forces(scene.state.x);
  ASSERT_EQ(forces.size(), 1u);
  EXPECT_EQ(forces[0].vertex, 0);
  EXPECT_EQ(forces[0].ground, 0);
  EXPECT_NEAR(gradient(1, 0), -forces[0].newton, 1e-13);
  EXPECT_GT(forces[0].newton, 0.01);
  EXPECT_NEAR(at_rest.value, 70 * barrier_value(3e-4, 1e-3), 1e-17);
}

TEST(Ground, StepKeepsATenthOfEachGap) {
  Matrix3Xd x(3, 3), p(3, 3);
  x << 0, 0, 0, 1, 2, 3, 0, 0, 0;
  BodyScene scene(x, Eigen::Vector3d(1, 1, 1), down);
  scene.add_ground({Ground{}});
  p << 5, 0, 0, 1, 2, -2.6, 0, 7, 0;
  EXPECT_EQ(scene.ground->largest_step(x, p), 1);  // 0.4 of 3 is left
  p << 5, 0, 0, -10, 2, -9, 0, 7, 0;
  EXPECT_DOUBLE_EQ(scene.ground->largest_step(x, p), 0.09);
  const Matrix3Xd next = x + 0.09 * p;
  EXPECT_NEAR(next(1, 0), 0.1, 1e-15);
}

// Gaps of a few roundings of the coordinates, on planes that no coordinate is exact on.
TEST(Ground, StepNeverReachesThePlaneHoweverSmallTheGap) {
  const Vector3d n = Vector3d(0.3, 0.9, -0.2).normalized();
  for (double height : {0.0, 0.1, 1000.0}) {
    for (double gap = 1e-3; gap > 1e-17; gap /= 3) {
      const Vector3d start = (height + gap) * n + Vector3d(0.9, -0.3, 0).normalized() * 7;
      if (n.dot(start) - height <= 0) continue;
      BodyScene scene = point_scene(start, Vector3d::Zero(), down);
      scene.add_ground({{.normal = n, .height = height}});
      const Matrix3Xd x = column(start), p = column(-n * 1e3);
      const double fraction = scene.ground->largest_step(x, p);
      const Matrix3Xd next = x + fraction * p;
      EXPECT_GT(scene.ground->smallest_gap(next), 0) << height << " " << gap;
    }
  }
}

TEST(Ground, ActiveSetIsWhatIsWithinDhat) {
  Matrix3Xd x(3, 4);
  x << 0, 0, 0, 0, 1e-3, 0.99e-3, 2, 1e-5, 0, 0, 0, 0;
  BodyScene scene(x, Eigen::Vector4d::Ones(), down, {0, 0, 0, 1});
  scene.add_ground({Ground{}, {.normal = Vector3d(0, -1, 0), .height = -2.0005}});
  scene.ground->begin_step(x, scene.state.v, 0.01);
  scene.ground->set_active(x);
  EXPECT_EQ(scene.ground->active_count(), 2);
  const auto forces = scene.ground->forces(x);
  ASSERT_EQ(forces.size(), 2u);
  EXPECT_EQ(forces[0].vertex, 1);
  EXPECT_EQ(forces[1].vertex, 2);
  EXPECT_EQ(forces[1].ground, 1);
  EXPECT_EQ(scene.system.potential(2).name(), "ground_barrier_1");
  EXPECT_EQ(scene.system.potential(3).name(), "ground_barrier_2");
  x.row(1).setConstant(1);
  scene.ground->set_active(x);
  EXPECT_EQ(scene.ground->active_count(), 0);
}

TEST(Ground, OnePointRestsAtATenthOfDhat) {
  for (double mass : {1e-3, 1.0, 500.0}) {
    BodyScene scene = point_scene(Vector3d(0, 0.01, 0), Vector3d::Zero(), down, mass);
    scene.add_ground({{.dhat = 2e-3}});
    scene.start({.dt = 0.01, .tolerance = 1e-8});
    for (int i = 0; i < 200; ++i) ASSERT_TRUE(scene.step().accepted);
    EXPECT_NEAR(scene.ground->smallest_gap(scene.state.x), 2e-4, 1e-9) << mass;
  }
}

TEST(Ground, StiffnessGivenByTheUserStays) {
  BodyScene scene = point_scene(Vector3d(0, 0.01, 0), Vector3d(0, -300, 0), down);
  scene.add_ground({{.stiffness = 123}});
  scene.start({.dt = 0.01});
  for (int i = 0; i < 10; ++i) EXPECT_EQ(scene.step().barrier_stiffness, 123);
}

TEST(Ground, StiffnessIsDoubledWhenGapsShrinkTowardsRounding) {
  const Matrix3Xd start = column(Vector3d(0, 5e-4, 0)), tiny = column(Vector3d(0, 1e-10, 0)),
                  tinier = column(Vector3d(0, 0.9e-10, 0));
  BodyScene scene = point_scene(start, Vector3d::Zero(), down);
  scene.add_ground({Ground{}});
  scene.ground->begin_step(start, scene.state.v, 0.01);
  const double before = scene.ground->stiffness(0);
  scene.ground->set_active(tiny);
  EXPECT_FALSE(scene.ground->adapt(tiny));
  EXPECT_TRUE(scene.ground->adapt(tinier));
  EXPECT_EQ(scene.ground->stiffness(0), 2 * before);
  // What the change adds to the energy at the start of the step is accounted for,
  EXPECT_DOUBLE_EQ(scene.ground->energy_added(), before * barrier_value(5e-4, 1e-3));
  EXPECT_FALSE(scene.ground->adapt(tinier));  // and a gap that no longer shrinks is left alone.
  EXPECT_EQ(scene.ground->stiffness(0), 2 * before);
  // In contact it stays; out of contact, where its energy is zero, it is chosen again.
  scene.ground->begin_step(tinier, scene.state.v, 0.01);
  EXPECT_EQ(scene.ground->stiffness(0), 2 * before);
  EXPECT_EQ(scene.ground->energy_added(), 0);
  scene.ground->begin_step(column(Vector3d(0, 1, 0)), scene.state.v, 0.01);
  EXPECT_EQ(scene.ground->stiffness(0), before);
}

TEST(Ground, WithoutGravityTheStiffnessFollowsFromTheSpeed) {
  BodyScene scene = point_scene(Vector3d(0, 1, 0), Vector3d(0, -5, 0), Vector3d::Zero());
  scene.add_ground({Ground{}});
  scene.start({.dt = 0.01});
  double lowest = 1;
  for (int i = 0; i < 60; ++i) {
    const StepRecord record = scene.step();
    ASSERT_TRUE(record.accepted) << record.reason;
    lowest = std::min(lowest, record.smallest_gap);
  }
  EXPECT_GT(lowest, 0);
  EXPECT_LT(lowest, 1e-3);
  EXPECT_LE(scene.state.v.norm(), 5);
}

TEST(Ground, PointComesToRestInAValley) {
  BodyScene scene = point_scene(Vector3d(0.1, 0.5, 0), Vector3d(2, -3, 0), down);
  const Vector3d left = Vector3d(1, 1, 0).normalized(), right = Vector3d(-1, 1, 0).normalized();
  scene.add_ground({{.normal = left, .friction = 0.2}, {.normal = right}});
  scene.start({.dt = 0.01, .tolerance = 1e-6});
  for (int i = 0; i < 300; ++i) {
    const StepRecord record = scene.step();
    ASSERT_TRUE(record.accepted) << record.reason;
    ASSERT_GT(record.smallest_gap, 0);
  }
  EXPECT_LT(scene.state.v.norm(), 1e-3);
  EXPECT_LT(std::abs(scene.state.x(0, 0)), 2e-3);
  EXPECT_EQ(scene.ground->active_count(), 2);
}

TEST(Ground, FrictionLagTellsHowMuchForcesChanged) {
  BodyScene scene = point_scene(Vector3d(0, 4e-4, 0), Vector3d::Zero(), down);
  scene.add_ground({{.friction = 0.3}});
  const Matrix3Xd x = scene.state.x, away = column(Vector3d(0, 1, 0));
  scene.ground->begin_step(x, scene.state.v, 0.01);
  EXPECT_EQ(scene.ground->lag_friction(away, away, 0.01).fraction(), 0);
  EXPECT_EQ(scene.ground->lag_friction(x, x, 0.01).fraction(), 1);
  EXPECT_EQ(scene.ground->friction_count(), 1);
  EXPECT_EQ(scene.ground->lag_friction(x, x, 0.01).fraction(), 0);
  EXPECT_EQ(scene.ground->lag_friction(away, x, 0.01).fraction(), 1);
  EXPECT_EQ(scene.ground->friction_count(), 0);
}

std::string start_error(BodyScene& scene) {
  try {
    scene.ground->check_start(scene.state.x);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Ground, StartBelowTheGroundIsRefused) {
  Matrix3Xd x(3, 3);
  x << 0, 0, 0, 0.01, -0.0032, -0.001, 0, 0, 0;
  BodyScene scene(x, Eigen::Vector3d(1, 1, 1), down);
  scene.add_ground({Ground{}});
  EXPECT_EQ(start_error(scene),
            "vertex 1 is 3.2 mm below the ground and 1 other vertex is not above it; raise the object by more than "
            "3.2 mm along (0, 1, 0)");
  scene.state.x(1, 2) = 1;
  EXPECT_EQ(start_error(scene),
            "vertex 1 is 3.2 mm below the ground; raise the object by more than 3.2 mm along (0, 1, 0)");
  scene.state.x(1, 1) = -1.5;
  EXPECT_EQ(start_error(scene),
            "vertex 1 is 1.5 m below the ground; raise the object by more than 1.5 m along (0, 1, 0)");
  scene.state.x(1, 1) = 0;
  EXPECT_EQ(start_error(scene), "vertex 1 lies on the ground; raise the object by 1 mm along (0, 1, 0)");
  scene.state.x(1, 1) = 1e-9;
  EXPECT_EQ(start_error(scene), "");
  scene.system.set_fixed({0, 0, 1});
  scene.state.x(1, 2) = -1;  // a fixed vertex may stand in the ground
  EXPECT_EQ(start_error(scene), "");
  scene.state.x(1, 0) = std::nan("");
  EXPECT_EQ(start_error(scene), "vertex 0 has no finite position");
}

std::string ground_error(const Ground& ground) {
  BodyScene scene = point_scene(Vector3d(0, 1, 0), Vector3d::Zero(), down);
  try {
    scene.add_ground({ground});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Ground, ParametersOutOfRangeAreRefused) {
  EXPECT_EQ(ground_error({.normal = Vector3d::Zero()}),
            "the ground: normal has no direction; give the direction that points out of the ground");
  EXPECT_EQ(ground_error({.dhat = -0.001}), "the ground: dhat is -0.001 m; it must be above 0");
  EXPECT_EQ(ground_error({.friction = -0.5}), "the ground: friction is -0.5; it must be at least 0");
  EXPECT_EQ(ground_error({.epsv = 0}), "the ground: epsv is 0 m/s; it must be above 0");
  EXPECT_EQ(ground_error({.stiffness = -1}),
            "the ground: stiffness is -1 N/m; it must be above 0, or 0 to have it chosen");
  EXPECT_EQ(ground_error({.height = std::numeric_limits<double>::infinity()}),
            "the ground: height is inf m; it must be finite");
}

}  // namespace
}  // namespace ergon
