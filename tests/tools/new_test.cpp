// Every kind of file that `ergon new` writes is sound, compiles, evaluates as 50 digits say, and works in a scene as
// its last line says.

#include <gmock/gmock.h>

#include "runtime/lanes/lanes.h"
#include "symbolic/checks.h"
#include "tests/tools/command.h"
#include "tests/tools/json_lines.h"
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

// What the last line of the file says behind its two spaces.
std::string use_of(const std::string& text) {
  const std::string last = text.substr(text.rfind('\n', text.size() - 2) + 1);
  EXPECT_TRUE(last.starts_with("# ")) << last;
  EXPECT_LE(last.size(), 150u) << last;
  return last.substr(last.find(":  ") + 3);
}

std::string object(const std::string& name, const std::string& place, const std::string& energy) {
  const bool sheet = place == "sheet", line = place == "curve", tets = place == "tets";
  return "[[object]]\nname = \"" + name + "\"\ndensity = 1000\n" +
         (line    ? "curve = { points = [[0, 0, 0], [0.2, 0, 0.05], [0.3, 0.2, 0]], cells = 12 }\ncross_section = \"1 "
                    "cm^2\"\n"
          : sheet ? "box = { size = [0.2, 0.1, 0.1], cells = [6, 3, 1] }\nelement = \"tri3\"\nthickness = \"1 mm\"\n"
          : tets  ? "box = { size = [0.1, 0.1, 0.1], cells = [2, 2, 2] }\nelement = \"tet4\"\n"
                  : "box = { size = [0.1, 0.1, 0.1], cells = [2, 2, 2] }\n") +
         (line || sheet || tets ? "" : "translate = " + place + "\n") + "fixed = [{ max = [0.04, inf, inf] }]\n" +
         energy;
}

class SlowNewEnergy : public CommandTest, public testing::WithParamInterface<std::string> {};

TEST_P(SlowNewEnergy, WorksInASceneAsItsLastLineSays) {
  ASSERT_EQ(ergon("new " + GetParam() + " my_law").code, 0);
  const std::string use = use_of(read("my_law.energy"));
  const std::string rubber = "energy = [{ law = \"stable_neo_hookean\", E = 1e5, nu = 0.3 }]\n";
  std::string scene = "[time]\ndt = \"10 ms\"\nsteps = 5\n";
  if (use.starts_with("energy = ")) {
    const std::string text = read("my_law.energy");
    const bool sheet = text.find("element = \"tri3\"") != std::string::npos;
    const bool line = text.find("an object that is a curve") != std::string::npos;
    const bool tets = text.find("element = \"tet4\"") != std::string::npos;
    scene += object("a", sheet ? "sheet" : line ? "curve" : tets ? "tets" : "[0, 0, 0]", use);
  } else {
    scene = use + scene + object("a", "[0, 0, 0]", rubber) + object("b", "[0, 0, 0.1005]", rubber);
  }
  write("scene.toml", scene);
  const Answer ran = ergon("run scene.toml --verify");
  ASSERT_EQ(ran.code, 0) << scene << ran.out << ran.err;
  const auto lines = json_lines(read("out/scene/report.jsonl"));
  ASSERT_EQ(lines.size(), 5u);
  const auto& energies = lines.back().at("energy");
  const char* name = use.starts_with("contact") ? "contact_point_triangle" : "my_law";
  ASSERT_TRUE(energies.contains(name)) << energies;
  EXPECT_GT(energies.at(name).get<double>(), 0) << energies;
}

std::vector<std::string> kinds_of_scenes() {
  std::vector<std::string> kinds;
  for (const EnergyTemplate& one : energy_templates())
    if (one.text.find("# In a scene") != std::string::npos) kinds.push_back(one.kind);
  return kinds;
}

INSTANTIATE_TEST_SUITE_P(Kinds, SlowNewEnergy, testing::ValuesIn(kinds_of_scenes()),
                         [](const auto& info) { return info.param; });

TEST(NewEnergies, AllSayHowTheyAreUsed) {
  std::vector<std::string> others;
  for (const EnergyTemplate& one : energy_templates()) {
    if (one.text.find("\n# In a scene") != std::string::npos) continue;
    EXPECT_NE(one.text.find("\n# From C++"), std::string::npos) << one.kind;
    others.push_back(one.kind);
  }
  EXPECT_EQ(others, (std::vector<std::string>{"point_edge", "edge_edge", "distance"}));
}

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
                 "patch, shell_triangle, rod_corner, "
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
