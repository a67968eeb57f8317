// Steps that would create energy are made anew by implicit Euler.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "tests/runtime/body_scene.h"

namespace ergon {
namespace {

using Eigen::Vector3d;

struct Bounced {
  double least_dissipated = std::numeric_limits<double>::infinity();  // J, since the start
  double most_gained = -std::numeric_limits<double>::infinity();      // J, kinetic and stored, since the start
  double most_made = 0;                                               // in a step, of the kinetic energy
  int refused = 0;
  std::map<std::string, int> steps;  // by integrator
};

// A braced cube that falls askew on the ground, with a dt that does not resolve the impact.
Bounced bounce(bool creates_no_energy) {
  BodyScene scene = cube_scene(0.1, 0.3, 1, 1e4, Vector3d(0, -9.81, 0));
  scene.add_ground({{.friction = 0.3}});
  scene.state.v.colwise() = Vector3d(2, -20, 1);
  scene.start({.dt = 5e-3, .integrator = "bdf2", .tolerance = 1e-6, .creates_no_energy = creates_no_energy});
  const double before = scene.stepper->energies(scene.state).total;
  Bounced out;
  double dissipated = 0, barrier = 0;
  for (int i = 0; i < 100; ++i) {
    const StepRecord record = scene.step();
    EXPECT_TRUE(record.accepted) << record.reason;
    dissipated += record.budget.integrator;
    barrier += record.budget.barrier;
    const double kinetic = std::max(scene.state.last_v.squaredNorm(), scene.state.v.squaredNorm()) / 16;
    out.most_made = std::max(out.most_made, -record.budget.integrator / kinetic);
    EXPECT_NEAR(scene.state.dissipated, dissipated, 1e-9);
    out.least_dissipated = std::min(out.least_dissipated, dissipated);
    out.most_gained = std::max(out.most_gained, record.energy.total - barrier - before);
    out.refused += record.refused;
    ++out.steps[record.integrator];
  }
  return out;
}

TEST(CreatedEnergy, IsNoneInImpactsThatAreNotResolved) {
  const Bounced free = bounce(false), watched = bounce(true);
  EXPECT_GT(free.most_made, 0.1);
  EXPECT_EQ(free.refused, 0);
  const double slack = 0.5 * 1 * 1e-6 * 1e-6;  // of a motion at the tolerance
  EXPECT_GE(watched.least_dissipated, -slack);
  EXPECT_LE(watched.most_made, 0.01 + 1e-9);
  EXPECT_LE(watched.most_gained, 1e-6);
  EXPECT_GT(watched.refused, 0);
  EXPECT_LT(watched.refused, 20);
  EXPECT_EQ(watched.steps.at("bdf2"), 99 - watched.refused);  // the first is by a method of one step
  EXPECT_GE(watched.steps.at("implicit_euler"), watched.refused);
}

// A motion that dt resolves is left alone, to the last bit.
TEST(CreatedEnergy, LeavesSmoothMotionsAlone) {
  const auto swing = [](bool creates_no_energy) {
    BodyScene scene = cube_scene(0.1, 1, 1, 1e3, Vector3d(0, -9.81, 0));
    scene.state.v = 3 * Vector3d(0, 0, 1).replicate(1, 8).cwiseProduct(scene.state.x);
    scene.start({.dt = 2e-3, .integrator = "bdf2", .tolerance = 1e-8, .creates_no_energy = creates_no_energy});
    for (int i = 0; i < 200; ++i) EXPECT_EQ(scene.step().refused, 0);
    return scene.state;
  };
  EXPECT_EQ(swing(true).x, swing(false).x);
}

// Nor is one whose force swells and ebbs: that it takes back what it gave is not the integrator's.
TEST(CreatedEnergy, LeavesForcesThatFollowTimeAlone) {
  BodyScene scene = cube_scene(0.1, 1, 1, 1e3, Vector3d::Zero());
  scene.system.potential(1).follow("g", [](double time) {
    return std::vector<double>{0, 50 * std::sin(10 * time) * std::sin(10 * time), 0};
  });
  scene.system.set_fixed({1, 1, 1, 1, 0, 0, 0, 0});
  scene.start({.dt = 2e-3, .integrator = "bdf2", .tolerance = 1e-8, .creates_no_energy = true});
  for (int i = 0; i < 300; ++i) EXPECT_EQ(scene.step().refused, 0) << i;
}

// Of a step that is made anew, nothing remains but what it cost.
TEST(CreatedEnergy, AStepMadeAnewIsThatOfImplicitEuler) {
  BodyScene scene = cube_scene(0.1, 0.3, 1, 1e4, Vector3d(0, -9.81, 0));
  scene.add_ground({{}});
  scene.state.v.colwise() = Vector3d(0, -20, 0);
  scene.start({.dt = 5e-3, .integrator = "bdf2", .tolerance = 1e-6, .creates_no_energy = true});
  for (int i = 0; i < 20; ++i) {
    State before = scene.state;
    const StepRecord record = scene.step();
    if (record.refused == 0) continue;
    scene.stepper->options().integrator = "implicit_euler";
    const StepRecord again = scene.stepper->step(before);
    EXPECT_LT((before.x - scene.state.x).cwiseAbs().maxCoeff(), 1e-6 * 5e-3);
    EXPECT_GT(record.newton_iterations, again.newton_iterations);
    return;
  }
  FAIL() << "no step was made anew";
}

}  // namespace
}  // namespace ergon
