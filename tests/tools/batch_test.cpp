// Sweeps: every job has its own folder with its exact inputs, none is lost, what is done is not done again.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/tools/command.h"

namespace ergon {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

class Batch : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write(
        "block.toml",
        "[time]\ndt = 0.01\nsteps = 2\n[[object]]\nname = \"b\"\nbox = { size = [0.1, 0.1, 0.1], cells = [1, 1, 1] }\n"
        "density = 1000\n[[object.energy]]\nlaw = \"soft.energy\"\nk = 1e5\n[[probe]]\nname = \"top\"\nobject = \"b\"\n"
        "near = [0, 0, 0.1]\n");
    write("soft.energy",
          "# Soft.\ndensity soft solid\ncite none\nparam k Pa (0, inf)\nvalue k*norm2(F'*F - identity(3))\n");
  }
  void sweep(const std::string& text) const { write("sweep.toml", "scene = \"block.toml\"\n" + text); }
  std::vector<std::string> table() const {
    std::vector<std::string> lines;
    std::istringstream in(read("out/sweep/table.csv"));
    for (std::string line; std::getline(in, line);) lines.push_back(line.substr(0, line.find('\r')));
    return lines;
  }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder / name); }
};

const char* const two_by_two =
    "measures = [\"steps\", \"probes.top.z\"]\n[grid]\n\"time.dt\" = [\"10 ms\", 0.02]\n\"object.b.energy.0.k\" = "
    "[1e5, "
    "\"2 MPa\"]\n";

TEST_F(Batch, RunsEveryCombinationAndGathersATable) {
  sweep(two_by_two);
  const Answer answer = ergon("batch sweep.toml");
  EXPECT_EQ(answer.code, 0) << answer.err << answer.out;
  EXPECT_THAT(answer.out, HasSubstr("4/4 done\n"));
  EXPECT_THAT(answer.out, testing::EndsWith("table: out/sweep/table.csv\n"));
  // A body that falls freely falls by g*t^2/2 exactly: by default it goes by methods of second order.
  const std::vector<std::string> lines = table();
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_EQ(lines[0], "job,state,reason,time.dt,object.b.energy.0.k,steps,probes.top.z");
  EXPECT_THAT(lines[1], StartsWith("0000,done,,10 ms,100000.0,2,0.09803"));
  EXPECT_THAT(lines[2], StartsWith("0001,done,,10 ms,2 MPa,2,0.09803"));
  EXPECT_THAT(lines[3], StartsWith("0002,done,,0.02,100000.0,2,0.09215"));
  EXPECT_THAT(lines[4], StartsWith("0003,done,,0.02,2 MPa,2,0.09215"));
  // A job's folder holds what it takes to run it again.
  std::filesystem::remove(folder / "block.toml");
  std::filesystem::remove(folder / "soft.energy");
  EXPECT_EQ(ergon("run out/sweep/0002/scene.toml --out again --quiet").code, 0);
  EXPECT_EQ(nlohmann::json::parse(read("again/summary.json"))["probes"],
            nlohmann::json::parse(read("out/sweep/0002/summary.json"))["probes"]);
  EXPECT_EQ(nlohmann::json::parse(read("again/report.jsonl").substr(0, read("again/report.jsonl").find('\n')))["probes"]
                .size(),
            1u);
}

TEST_F(Batch, SkipsWhatIsDoneUntilItsInputsChange) {
  sweep(two_by_two);
  ASSERT_EQ(
      ergon("batch sweep.toml --list").out,
      "0000  time.dt = 10 ms  object.b.energy.0.k = 100000.0\n0001  time.dt = 10 ms  object.b.energy.0.k = 2 MPa\n"
      "0002  time.dt = 0.02  object.b.energy.0.k = 100000.0\n0003  time.dt = 0.02  object.b.energy.0.k = 2 MPa\n");
  EXPECT_FALSE(exists("out/sweep"));
  ASSERT_EQ(ergon("batch sweep.toml").code, 0);
  const auto written = [&] { return std::filesystem::last_write_time(folder / "out/sweep/0001/summary.json"); };
  const auto before = written();
  std::filesystem::remove(folder / "out/sweep/0003/summary.json");  // as if it had been stopped
  const Answer again = ergon("batch sweep.toml");
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("4/4 done (3 before)"));
  EXPECT_EQ(written(), before);
  EXPECT_TRUE(exists("out/sweep/0003/summary.json"));
  write("soft.energy",
        "# Soft.\ndensity soft solid\ncite none\nparam k Pa (0, inf)\nvalue k/2*norm2(F'*F - identity(3))\n");
  EXPECT_THAT(ergon("batch sweep.toml").out, testing::Not(HasSubstr("before")));
  EXPECT_NE(written(), before);
}

TEST_F(Batch, ListsWhatFailedWithItsReasonAndGoesOn) {
  sweep(
      "[[list]]\n\"time.dt\" = 0.01\n[[list]]\n\"object.b.velocity\" = [0, 0, -1]\n\"ground\" = [{ height = 0.05 }]\n"
      "[[list]]\n\"time.steps\" = 3\n");
  const Answer answer = ergon("batch sweep.toml");
  EXPECT_EQ(answer.code, 1);
  EXPECT_THAT(answer.out, HasSubstr("2/3 done, 1 failed\n"));
  EXPECT_THAT(answer.out, HasSubstr("\nfailed  0001  out/sweep/0001/scene.toml:"));
  EXPECT_EQ(answer.err, "ergon: error: 1 of 3 jobs are not done; the same command again does them\n");
  const std::vector<std::string> lines = table();
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_THAT(lines[2], StartsWith("0001,failed,\"out/sweep/0001/scene.toml:"));
  EXPECT_THAT(lines[2], HasSubstr("below the ground"));
  EXPECT_THAT(lines[3], StartsWith("0002,done,,"));
}

TEST_F(Batch, RunsAllScenesThatMatch) {
  write("block_of_steel.toml", read("block.toml"));
  write("sweep.toml", "scene = \"b*.toml\"\nmeasures = [\"steps\"]\n[grid]\n\"start.seed\" = [1, 2]\n");
  const Answer answer = ergon("batch sweep.toml");
  EXPECT_EQ(answer.code, 0) << answer.err << answer.out;
  const std::vector<std::string> lines = table();
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_EQ(lines[0], "job,state,reason,scene,start.seed,steps");
  EXPECT_EQ(lines[1], "0000,done,,block,1,2");
  EXPECT_EQ(lines[4], "0003,done,,block_of_steel,2,2");
  // What was done without a test of its steps is not done with it.
  write("sweep.toml", "scene = \"b*.toml\"\nmeasures = [\"steps\"]\nverify = true\n[grid]\n\"start.seed\" = [1, 2]\n");
  EXPECT_THAT(ergon("batch sweep.toml").out, testing::Not(HasSubstr("before")));
  EXPECT_THAT(ergon("batch sweep.toml").out, HasSubstr("4/4 done (4 before)"));
  write("sweep.toml", "scene = \"c*.tml\"\n");
  EXPECT_EQ(ergon("batch sweep.toml").err, "ergon: error: sweep.toml:1:9: no file is named like c*.tml\n");
}

TEST_F(Batch, NamesWhatIsWrongBeforeAnythingRuns) {
  const auto error = [&](const std::string& text) {
    sweep(text);
    const Answer answer = ergon("batch sweep.toml");
    EXPECT_EQ(answer.code, 2) << answer.out;
    EXPECT_FALSE(exists("out"));
    return answer.err;
  };
  EXPECT_EQ(error("[grid]\n\"object.c.density\" = [1]\n"),
            "ergon: error: sweep.toml:3:23: 'object.c.density': there is no 'c' here; give a number from 0 to 0 or a "
            "name: b\n");
  EXPECT_EQ(error("[grid]\n\"time.dt\" = []\n"),
            "ergon: error: sweep.toml:3:13: 'time.dt' must be an array of values to run, found an empty one\n");
  EXPECT_EQ(error("mesures = []\n"),
            "ergon: error: sweep.toml:2:1: unknown key 'mesures' in the sweep; did you mean 'measures'?\n");
  EXPECT_THAT(error("measures = [\"step\"]\n"),
              StartsWith("ergon: error: sweep.toml:2:13: there is no measure 'step'; did you mean 'steps'?; a job's "
                         "summary.json has: "));
  EXPECT_THAT(error("[[list]]\n\"time.dt\" = 0.1\n[[list]]\n\"time.dt\" = -1\n"),
              HasSubstr("job 0001 (time.dt = -1): out/sweep/0001/scene.toml:"));
  EXPECT_THAT(error("threads = 0\n"), HasSubstr("sweep.toml:2:11: "));
}

TEST_F(Batch, ValuesCanBeSetForOneRunToo) {
  const Answer answer = ergon("run block.toml --set time.steps=3 --set 'object.b.energy.0.k=2 MPa' --quiet");
  EXPECT_EQ(answer.code, 0) << answer.err;
  EXPECT_EQ(nlohmann::json::parse(read("out/block/summary.json"))["steps"], 3);
  EXPECT_EQ(ergon("run block.toml --set time.stps=3").err,
            "ergon: error: block.toml: unknown key 'stps' in [time]; did you mean 'steps'?\n");
}

}  // namespace
}  // namespace ergon
