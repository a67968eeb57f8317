// The bound that every energy of the catalogue meets at every strain from 1e-12 to 1e3: a new energy is held to it by
// being there.

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "runtime/lanes/lanes.h"
#include "tests/paths.h"
#include "tests/symbolic/energy_files.h"
#include "tests/tools/command.h"
#include "tools/accuracy.h"
#include "tools/accuracy_states.h"
#include "tools/installation.h"

namespace ergon {
namespace {

class EveryEnergyIsAccurate : public CommandTest, public testing::WithParamInterface<std::string> {};

// Relative errors of value, gradient and Hessian, in units of 2^-53, over 1 + the condition of their state. A backward
// stable evaluation in a few dozen roundings makes errors of this size; measured are 5 at most.
constexpr double kBound = 16;
// What a law with memory stores is the energy of a trial state less that of what flows in the step: where the trial is
// n times beyond the limit, the difference loses a factor of n, which the states drawn here let be 100.
constexpr double kBoundWithMemory = 16 * kBound;

TEST_P(EveryEnergyIsAccurate, WithinItsCondition) {
  const Energy& energy = test::shipped(GetParam());
  for (const std::string& case_name : cases_of(energy)) {
    AccuracyOptions options;
    options.directions = 3;
    options.lanes = lanes::best_lanes();
    const std::vector<Accuracy> all = measure_accuracy(energy, case_name, options);
    EXPECT_GE(all.size(), 12u) << "too few strains with a state";
    for (const Accuracy& at : all) {
      for (int entry = 0; entry < 3; ++entry)
        EXPECT_LE(at.excess[entry], energy.updates.empty() ? kBound : kBoundWithMemory)
            << energy.name << " " << case_name << " strain " << at.strain << " entry " << entry;
      // What is stress-free at rest is well conditioned in its displacements: then few ulps are few in the result. Laws
      // that are part of a sum, or that remember, have stress there.
      if (at.strain <= 0.1 && energy.kind == Energy::Kind::density && energy.part_of.empty() &&
          energy.updates.empty()) {
        EXPECT_LE(at.emitted[0].median, 16) << energy.name << " strain " << at.strain;
        EXPECT_LE(at.emitted[1].median, 16) << energy.name << " strain " << at.strain;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryEnergyIsAccurate, testing::ValuesIn(test::catalogue_names()),
                         [](const auto& info) { return test::name_of_test(info.param); });

// The same of kernels over floats.
TEST(SinglePrecision, IsAccurateWithinTheConditionToo) {
  for (const char* name : {"stable_neo_hookean", "neo_hookean", "st_venant_kirchhoff", "fibre_reinforced", "spring",
                           "discrete_shell_hinge"}) {
    const Energy energy = find_energy(name);
    const bool density = energy.kind == Energy::Kind::density;
    AccuracyOptions options;
    options.directions = 3;
    options.single = true;
    options.lanes = lanes::best_single_lanes();
    options.largest = 1;  // exponentials of more are above all floats
    if (!density) options.smallest = 1e-4;
    const std::vector<Accuracy> all = measure_accuracy(energy, "", options);
    EXPECT_GE(all.size(), density ? 12u : 5u) << "too few strains with a state";
    for (const Accuracy& at : all) {
      for (int entry = 0; entry < 3; ++entry)
        EXPECT_LE(at.excess[entry], kBound) << energy.name << " strain " << at.strain << " entry " << entry;
      if (at.strain <= 0.1 && density) {
        EXPECT_LE(at.emitted[1].median, 16) << energy.name << " strain " << at.strain;
      }
    }
  }
}

class AccuracyCommand : public CommandTest {
 protected:
  static double digits_lost(const std::string& text, double strain, const std::string& entry, const char* field) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      const nlohmann::json row = nlohmann::json::parse(line);
      if (row["strain"] == strain && row["entry"] == entry) return row[field];
    }
    ADD_FAILURE() << "no row of strain " << strain << ", " << entry;
    return 0;
  }
};

TEST_F(AccuracyCommand, ShowsWhatTheNaiveFormLosesAndTheEmittedOneKeeps) {
  for (const std::string name : {"stable_neo_hookean", "neo_hookean", "st_venant_kirchhoff"}) {
    const Answer answer = ergon("accuracy " + name + " --json");
    ASSERT_EQ(answer.code, 0) << answer.err;
    EXPECT_GT(digits_lost(answer.out, 1e-6, "gradient", "naive_median_ulp"), 1e4) << name;
    EXPECT_LT(digits_lost(answer.out, 1e-6, "gradient", "emitted_max_ulp"), 64) << name;
    EXPECT_GT(digits_lost(answer.out, 1e-6, "value", "naive_median_ulp"), 1e4) << name;
    EXPECT_LT(digits_lost(answer.out, 1e-6, "value", "emitted_max_ulp"), 64) << name;
    EXPECT_LT(digits_lost(answer.out, 1e-12, "hessian", "emitted_max_ulp"), 64) << name;
  }
}

TEST_F(AccuracyCommand, MeasuresADensityThatIsNotAtRest) {
  write("pre_stressed.energy",
        "density pre_stressed solid\nparam a Pa (0, inf) stress\nvalue a*(tr(F) - 3) + a*norm2(F - identity(3))\n");
  const Answer answer = ergon("accuracy pre_stressed.energy");
  ASSERT_EQ(answer.code, 0) << answer.err;
  EXPECT_THAT(answer.out, testing::StartsWith("energy "));
  EXPECT_THAT(answer.out, testing::HasSubstr("pre_stressed"));
}

TEST_F(AccuracyCommand, NamesTheNearestEnergy) {
  const Answer answer = ergon("accuracy neo_hokean");
  EXPECT_EQ(answer.code, 2);
  EXPECT_THAT(answer.err, testing::HasSubstr("did you mean 'neo_hookean'?"));
}

// The states are doubles, and what is made of them is exact: F - I differs from the differences of displacements by
// their rounding only.
TEST(AccuracyStates, LieAtTheStrainAskedFor) {
  const Energy energy = read_energy(test::source("/energies/solids/stable_neo_hookean.energy"));
  std::mt19937_64 random(4);
  for (const double strain : {1e-9, 1e-3, 10.0}) {
    const auto state = accuracy_state(energy, "", strain, random);
    ASSERT_TRUE(state.has_value());
    double squares = 0;
    const std::vector<double> u = kernel_points(*state, true);
    for (const double component : u) squares += component * component;
    EXPECT_NEAR(std::sqrt(squares) / strain, 1, 1e-6);
    const ExactInputs inputs = exact_inputs(energy, *state, true, {});
    EXPECT_NEAR(cln::double_approx(inputs.at("F")[0]) - 1, u[3] - u[0], 1e-15);
  }
}

}  // namespace
}  // namespace ergon
