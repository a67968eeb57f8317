#include "tests/codegen/states.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/symbolic/energy_files.h"

namespace ergon::testing {
namespace {

double length2(const std::vector<double>& from, const std::vector<double>& to) {
  return std::pow(to[0] - from[0], 2) + std::pow(to[1] - from[1], 2) + std::pow(to[2] - from[2], 2);
}

double cross2(const Inputs& in) {
  double a[3], b[3];
  for (size_t i = 0; i < 3; ++i) a[i] = in.at("a1")[i] - in.at("a0")[i], b[i] = in.at("b1")[i] - in.at("b0")[i];
  return std::pow(a[1] * b[2] - a[2] * b[1], 2) + std::pow(a[2] * b[0] - a[0] * b[2], 2) +
         std::pow(a[0] * b[1] - a[1] * b[0], 2);
}

// The tests of every energy would say nothing of the mollifier of parallel edges if no state reached it.
TEST(States, SomeEdgesAreNearlyParallelAndOthersAreNot) {
  const Energy& energy = test::shipped("squared_log_barrier:edge_edge");
  for (const std::string& case_name : energy.cases) {
    int faded = 0, whole = 0;
    for (const State& state : draw_states(energy, case_name, 7)) {
      const Inputs& in = state.inputs;
      const double lengths = length2(in.at("A0"), in.at("A1")) * length2(in.at("B0"), in.at("B1"));
      ++(1000 * cross2(in) < lengths ? faded : whole);
    }
    EXPECT_GE(faded, 1) << case_name;
    EXPECT_GE(whole, 4) << case_name;
  }
}

}  // namespace
}  // namespace ergon::testing
