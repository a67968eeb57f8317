// Every file in tests/errors/checks is well formed and unsound: the findings that are not ok are exactly the lines of
// the .expected file beside it.
#include <gtest/gtest.h>

#include "symbolic/checks.h"
#include "tests/symbolic/energy_files.h"

namespace ergon {
namespace {

class UnsoundEnergy : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(UnsoundEnergy, IsToldWithTheExpectedMessages) {
  std::filesystem::path expected = GetParam();
  expected.replace_extension(".expected");
  std::string told;
  for (const Finding& f : check_energy(parse_energy(test::contents(GetParam()), GetParam().filename().string())))
    if (f.severity != Severity::ok)
      told += std::string(to_string(f.severity)) + " " + f.check + ": " + to_string(f) + "\n";
  EXPECT_EQ(told, test::contents(expected));
}

INSTANTIATE_TEST_SUITE_P(Files, UnsoundEnergy, testing::ValuesIn(test::energy_files("tests/errors/checks")),
                         [](const auto& info) { return info.param.stem().string(); });

TEST(UnsoundEnergies, CoverManyMistakes) { EXPECT_GE(test::energy_files("tests/errors/checks").size(), 30u); }

}  // namespace
}  // namespace ergon
