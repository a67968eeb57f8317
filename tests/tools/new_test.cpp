// Every kind of file that `ergon new` writes is sound, compiles and evaluates as 50 digits say.

#include <gmock/gmock.h>

#include "runtime/lanes/lanes.h"
#include "symbolic/checks.h"
#include "tests/tools/command.h"
#include "tools/accuracy.h"
#include "tools/installation.h"
#include "tools/templates.h"

namespace ergon {
namespace {

using testing::HasSubstr;

std::vector<std::string> template_kinds() {
  std::vector<std::string> kinds;
  for (const EnergyTemplate& one : energy_templates()) kinds.push_back(one.kind);
  return kinds;
}

class NewEnergy : public CommandTest, public testing::WithParamInterface<std::string> {};

TEST_P(NewEnergy, IsSoundAndEvaluatesAsItsTextSays) {
  const Answer made = ergon("new " + GetParam() + " my_law --folder laws");
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.out, HasSubstr("laws/my_law.energy: "));
  const std::string text = read("laws/my_law.energy");
  EXPECT_EQ(text.find("NAME"), std::string::npos) << text;
  const Answer checked = ergon("check laws/my_law.energy");
  EXPECT_EQ(checked.code, 0) << checked.out << checked.err;
  EXPECT_THAT(checked.out, HasSubstr(" 0 warnings, 0 errors\n"));

  const Energy energy = find_energy_or_part((folder / "laws/my_law.energy").string());
  EXPECT_FALSE(energy.summary.empty());
  for (const Energy& whole : complete(energy)) {
    if (energy.kind == Energy::Kind::barrier && whole.name != "my_law:point_triangle") continue;
    for (const std::string& case_name : cases_of(whole)) {
      AccuracyOptions options;
      options.directions = 2;
      options.smallest = 1e-6;
      options.largest = 1;
      options.lanes = lanes::best_lanes();
      const std::vector<Accuracy> all = measure_accuracy(whole, case_name, options);
      ASSERT_GE(all.size(), 3u) << whole.name;
      for (const Accuracy& at : all)
        for (const double excess : at.excess) EXPECT_LE(excess, 16) << whole.name << " strain " << at.strain;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, NewEnergy, testing::ValuesIn(template_kinds()),
                         [](const auto& info) { return info.param; });

TEST(NewEnergies, ThereIsOneOfEveryKindThatTheLanguageKnows) {
  std::vector<std::string> expected = {"solid", "membrane", "line"};
  expected.insert(expected.end(), stencil_names().begin(), stencil_names().end());
  expected.insert(expected.end(), {"barrier", "distance"});
  EXPECT_EQ(template_kinds(), expected);
}

class NewCommand : public CommandTest {
 protected:
  void expect_refused(const std::string& arguments, const std::string& message) {
    const Answer answer = ergon("new " + arguments);
    EXPECT_EQ(answer.code, 2) << arguments;
    EXPECT_EQ(answer.err, "ergon: error: " + message + "\n");
  }
};

TEST_F(NewCommand, RefusesWhatWouldClash) {
  expect_refused("solids my_rubber",
                 "KIND: 'solids' is none of solid, membrane, line, point, edge, corner, triangle, tetrahedron, hinge, "
                 "patch, rod_corner, "
                 "point_point, point_edge, point_triangle, edge_edge, barrier, distance; did you mean 'solid'?");
  expect_refused("solid 2nd", "NAME: expected a letter and then letters, digits and '_', found '2nd'");
  expect_refused("solid rubber.energy",
                 "NAME: expected a letter and then letters, digits and '_', found 'rubber.energy'; the ending .energy "
                 "is added");
  expect_refused("solid sqrt", "NAME: 'sqrt' is the name of a function of the language; choose another");
  const Answer clash = ergon("new solid neo_hookean");
  EXPECT_EQ(clash.code, 2);
  EXPECT_THAT(clash.err, testing::MatchesRegex("ergon: error: NAME: the catalogue has 'neo_hookean' already "
                                               "\\(.*/energies/solids/neo_hookean.energy\\); choose another name, or "
                                               "see it by `ergon show neo_hookean`\n"));
  EXPECT_EQ(ergon("new solid rubber").code, 0);
  const std::string text = read("rubber.energy");
  expect_refused("membrane rubber", "rubber.energy: there is a file of that name already");
  EXPECT_EQ(read("rubber.energy"), text);
  write("file", "");
  expect_refused("solid rubber --folder file", "file/rubber.energy: cannot be written: Not a directory");
}

}  // namespace
}  // namespace ergon
