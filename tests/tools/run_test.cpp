#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/paths.h"
#include "tests/tools/command.h"

namespace ergon {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

class RunCommand : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write("block.toml", scene(4));
  }
  static std::string scene(int steps) {
    return "[time]\ndt = 0.01\nsteps = " + std::to_string(steps) +
           "\n[[object]]\nname = \"b\"\nbox = { size = [0.1, 0.1, 0.1], cells = [1, 1, 1] }\ndensity = 1000\n"
           "[[object.energy]]\nlaw = \"stable_neo_hookean\"\nE = 1e5\nnu = 0.3\n";
  }
};

TEST_F(RunCommand, WritesFramesReportAndSummaryAndSaysWhere) {
  const Answer answer = ergon("run block.toml --out results --threads 1");
  EXPECT_EQ(answer.code, 0) << answer.err;
  EXPECT_THAT(answer.out, HasSubstr("step 4/4"));
  EXPECT_THAT(answer.out, HasSubstr("skipped  "));
  EXPECT_THAT(answer.out, EndsWith("output: results\n"));
  EXPECT_EQ(answer.out.find('\r'), std::string::npos);  // plain lines in a pipe
  EXPECT_TRUE(std::filesystem::exists(folder / "results/block.pvd"));
  EXPECT_TRUE(std::filesystem::exists(folder / "results/block_frames/000004.vtu"));
  std::istringstream lines(read("results/report.jsonl"));
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    EXPECT_EQ(nlohmann::json::parse(line)["step"], count + 1);
  }
  EXPECT_EQ(count, 4);
}

TEST_F(RunCommand, QuietSaysOnlyWhereTheOutputIs) {
  const Answer answer = ergon("run block.toml --quiet");
  EXPECT_EQ(answer.code, 0) << answer.err;
  EXPECT_EQ(answer.out, "output: out/block\n");
}

TEST_F(RunCommand, WarnsOfUnsoundEnergiesOfTheScene) {
  write("kinked.energy",
        "# With a kink at twice the volume.\ndensity kinked solid\nparam mu Pa (0, inf)\nvalue mu*norm2(F'*F - "
        "identity(3)) + mu*max(det(F) - 2, 0)\n");
  write("own.toml",
        "[time]\ndt = 0.01\nsteps = 1\n[[object]]\nname = \"b\"\nbox = { size = [0.1, 0.1, 0.1], cells = [1, 1, 1] "
        "}\ndensity = 1000\n[[object.energy]]\nlaw = \"kinked.energy\"\nmu = 1e5\n");
  const Answer answer = ergon("run own.toml --out results --threads 1");
  EXPECT_EQ(answer.code, 0) << answer.err;
  EXPECT_THAT(answer.out, testing::StartsWith("warning  kinked.energy:4:41: the derivative by "));
  const auto summary = nlohmann::json::parse(read("results/summary.json"));
  ASSERT_EQ(summary["warnings"].size(), 1u);
  EXPECT_EQ("warning  " + summary["warnings"][0].get<std::string>(), answer.out.substr(0, answer.out.find('\n')));
  ergon("run block.toml --out sound --threads 1");
  EXPECT_EQ(nlohmann::json::parse(read("sound/summary.json"))["warnings"].size(), 0u);
}

TEST_F(RunCommand, BadScenesLeaveNothingBehind) {
  EXPECT_EQ(ergon("run nothing.toml --out results").code, 2);
  write("bad.toml", "[tim]\ndt = 0.01\n");
  const Answer answer = ergon("run bad.toml --out results");
  EXPECT_EQ(answer.code, 2);
  EXPECT_THAT(answer.err, testing::StartsWith("ergon: error: bad.toml:1:"));
  EXPECT_THAT(answer.err, EndsWith("did you mean 'time'?\n"));
  EXPECT_FALSE(std::filesystem::exists(folder / "results"));
}

TEST_F(RunCommand, AFolderThatCannotBeMadeIsBadInput) {
  write("taken", "a file\n");
  const Answer answer = ergon("run block.toml --out taken");
  EXPECT_EQ(answer.code, 2);
  EXPECT_THAT(answer.err, testing::StartsWith("ergon: error: taken: "));
  EXPECT_EQ(read("taken"), "a file\n");
}

TEST_F(RunCommand, AnInterruptKeepsWhatWasDone) {
  write("long.toml", scene(1000000));
  const Answer answer = shell(test::built() +
                              "/ergon run long.toml --out results --quiet & pid=$!\n"
                              "for i in $(seq 1000); do [ -s results/report.jsonl ] && break; sleep 0.05; done\n"
                              "kill -INT $pid; wait $pid");
  EXPECT_EQ(answer.code, 1);
  EXPECT_THAT(answer.err, testing::MatchesRegex("ergon: error: interrupted after step [0-9]+\n"));
  EXPECT_EQ(nlohmann::json::parse(read("results/summary.json"))["finished"], false);
}

}  // namespace
}  // namespace ergon
