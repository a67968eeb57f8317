// The solver under stress: a few steps of every case, all of some.
#include "tools/stress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenes/real_kernels.h"

namespace ergon {
namespace {

class SlowStress : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(, SlowStress, testing::Values("tet4", "tet10", "hex27"));

TEST_P(SlowStress, EveryCaseHoldsForAFewSteps) {
  const std::vector<StressCase> cases = stress_cases(GetParam());
  EXPECT_GE(cases.size(), 24u);
  for (const StressCase& what : cases) {
    const StressOutcome outcome = run_stress_case(what, GetParam(), real_kernels, 12);
    EXPECT_EQ(outcome.fault, "") << what.name;
    EXPECT_EQ(outcome.steps, 12) << what.name;
    // A block of Tet4 that is collapsed to a point is in equilibrium, by symmetry.
    const bool moves = what.name != "collapsed to a point";
    EXPECT_TRUE(outcome.newton_iterations > 0 || !moves) << what.name;
  }
}

TEST(Stress, UnitsMakeNoDifference) {
  const StressOutcome outcome = run_stress_units("tet4", real_kernels, 60);
  EXPECT_EQ(outcome.fault, "");
  EXPECT_EQ(outcome.steps, 120);
}

// A case that cannot hold is found out.
TEST(Stress, SaysWhatDoesNotHold) {
  StressCase what = stress_cases("tet4").front();
  what.judge = [](const BuiltScene&, const State& end) { return end.time > 0 ? std::string("drifts") : std::string(); };
  EXPECT_EQ(run_stress_case(what, "tet4", real_kernels, 2).fault, "drifts");
  what.judge = {};
  const auto disturb = what.disturb;
  what.disturb = [disturb](BuiltScene& built) {
    disturb(built);
    built.step.max_iterations = 1;
  };
  EXPECT_THAT(run_stress_case(what, "tet4", real_kernels, 2).fault,
              testing::HasSubstr("1 Newton iterations did not reach the tolerance"));
}

}  // namespace
}  // namespace ergon
