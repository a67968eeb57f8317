// The energy budget of shipped scenes, of every kind: it closes to what Newton's tolerance leaves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenes/finish_scene.h"

namespace ergon {
namespace {

struct Sums {
  Budget budget;              // sums over steps
  double scale = 0;           // J, largest energy
  double residual = 0;        // J, largest
  double start = 0, end = 0;  // J
};

Sums budgets_of(const std::string& name, int steps) {
  BuiltScene built = build_scene(shipped_scene(name), shipped_energies(), real_kernels);
  TimeStepper stepper = stepper_of(built);
  State state = built.start;
  Sums out;
  out.start = out.end = stepper.energies(state).total;
  for (int i = 0; i < steps; ++i) {
    const StepRecord record = stepper.step(state);
    EXPECT_TRUE(record.accepted) << name << ": " << record.reason;
    if (!record.accepted) break;
    const Budget& b = record.budget;
    EXPECT_NEAR(b.change, record.energy.total - out.end, 1e-9 * (1 + out.scale)) << name;
    EXPECT_GE(b.friction, -1e-9 * (1 + out.scale)) << name;
    EXPECT_GE(b.damping, -1e-9 * (1 + out.scale)) << name;
    out.end = record.energy.total;
    out.budget.script += b.script;
    out.budget.friction += b.friction;
    out.budget.damping += b.damping;
    out.residual = std::max(out.residual, std::abs(b.residual));
    out.scale = std::max({out.scale, record.energy.kinetic, std::abs(record.energy.total)});
    for (const auto& [potential, value] : record.energy.stored) out.scale = std::max(out.scale, std::abs(value));
  }
  return out;
}

TEST(SlowBudget, ClosesInEveryKindOfScene) {
  for (const char* name : {"cantilever.toml", "hanging_cloth.toml", "slope.toml", "affine_chain.toml",
                           "twisted_mat.toml", "ball_through_tube.toml", "cube_stack.toml", "card_house.toml",
                           "fast_impact.toml", "knot.toml", "masonry_arch.toml", "swing.toml", "box_chain.toml"}) {
    const Sums sums = budgets_of(name, 20);
    EXPECT_GT(sums.scale, 0) << name;
    EXPECT_LT(sums.residual, 1e-5 * sums.scale) << name;
  }
}

TEST(SlowBudget, KnowsTheWorkOfScriptsFrictionAndDamping) {
  const Sums knot = budgets_of("knot.toml", 60);
  EXPECT_GT(knot.budget.script, 0.01);
  EXPECT_GT(knot.budget.damping, 1e-4);
  const Sums slope = budgets_of("slope.toml", 60);
  EXPECT_EQ(slope.budget.script, 0);
  EXPECT_NEAR(slope.budget.friction, slope.start - slope.end, 0.05 * slope.budget.friction);
}

}  // namespace
}  // namespace ergon
