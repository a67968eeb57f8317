// ergon bench accuracy and stopping: what they write, that errors fall and that the front is one.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/tools/command.h"
#include "tests/tools/json_lines.h"
#include "tests/tools/xml.h"
#include "tools/study/accuracy.h"

namespace ergon {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;

class BenchAccuracyCommand : public CommandTest {
 protected:
  std::vector<Json> rows(const std::string& arguments) {
    const Answer answer = ergon("bench " + arguments + " --json");
    EXPECT_EQ(answer.code, 0) << answer.err;
    return json_lines(answer.out);
  }
};

AccuracyRow row(const std::string& element, const std::string& integrator, double error, double work, double seconds) {
  AccuracyRow out;
  out.setting.element = element;
  out.setting.integrator = integrator;
  out.error = error;
  out.run.factor_flops = work;
  out.run.seconds = seconds;
  return out;
}

TEST(AccuracyStudy, TheFrontHoldsWhatNothingBeatsInBoth) {
  AccuracyStudy study;
  study.rows = {row("tet4", "implicit_euler", 0.4, 10, 1),  row("tet4", "bdf2", 0.3, 10, 2),
                row("tet4", "implicit_euler", 0.2, 40, 30), row("hex20", "bdf2", 0.009, 30, 3),
                row("hex20", "bdf2", 0.02, 50, 2),          row("hex20", "bdf2", 0.05, 5, 9),
                row("hex27", "automatic", 0.008, 45, 9)};
  study.rows[5].run.failure = "step 1 failed";
  const auto all = [](const AccuracySetting&) { return true; };
  const auto work = front(study.rows, work_of, all), time = front(study.rows, seconds_of, all);
  ASSERT_EQ(work.size(), 3u);
  EXPECT_EQ(work[0], &study.rows[1]);
  EXPECT_EQ(work[1], &study.rows[3]);
  ASSERT_EQ(time.size(), 4u);
  EXPECT_EQ(time[0], &study.rows[0]);
  EXPECT_EQ(time[1], &study.rows[4]);
  EXPECT_EQ(time[2], &study.rows[3]);

  const std::vector<AccuracyVerdict> said = verdicts(study);
  ASSERT_EQ(said.size(), 3u);
  EXPECT_EQ(said[1].error, 0.01);
  EXPECT_EQ(said[1].best, &study.rows[3]);
  EXPECT_EQ(said[1].plain, &study.rows[2]);  // the costliest of its kind; that does not reach 1 percent
  EXPECT_FALSE(said[1].reached);
  EXPECT_EQ(said[1].time_ratio, 10);
  EXPECT_EQ(said[1].work_ratio, 40.0 / 30);
  EXPECT_EQ(said[1].by_default, &study.rows[6]);
  EXPECT_EQ(said[1].default_time_ratio, 3);
  EXPECT_EQ(said[1].default_work_ratio, 1.5);
  EXPECT_EQ(said[2].by_default, nullptr);
  EXPECT_EQ(said[2].best, nullptr);
  EXPECT_EQ(said[2].time_ratio, 0);
}

TEST(AccuracyStudy, ErrorsAreRelativeToTheDisplacementOfTheReference) {
  const Eigen::Matrix3Xd start = Eigen::Matrix3Xd::Ones(3, 2);
  StudyRun reference, run;
  reference.x = {start, 3 * start};
  run.x = {start, 3.5 * start};
  EXPECT_DOUBLE_EQ(study_error(run, reference), 0.25);
  run.failure = "step 1 failed";
  EXPECT_TRUE(std::isinf(study_error(run, reference)));
  run.failure.clear();
  run.x[0] *= 2;
  EXPECT_THROW(study_error(run, reference), std::logic_error);
  run.x.pop_back();
  EXPECT_THROW(study_error(run, reference), std::logic_error);
}

// High order in space and time is more accurate on the smooth problems, for less work; runs that are there are taken
// over.
TEST_F(BenchAccuracyCommand, BriefRunsTellErrorsAndWork) {
  const std::string command = "accuracy --brief --problem buckling --problem cloth --out found";
  const std::vector<Json> all = rows(command);
  ASSERT_EQ(all.size(), 2u * (1 + 4 + 3));
  EXPECT_EQ(all[0]["problem"], "buckling");
  EXPECT_GT(all[0]["reference_error"], 0);
  EXPECT_LT(all[0]["reference_error"], 0.02);
  const auto error = [&](int i) { return all[static_cast<size_t>(i)]["error"].get<double>(); };
  EXPECT_EQ(all[1]["element"], "tet4");
  EXPECT_EQ(all[4]["element"], "hex20");
  EXPECT_EQ(all[4]["integrator"], "automatic");
  EXPECT_LT(error(4), 0.05);
  EXPECT_GT(error(1), 5 * error(4));
  EXPECT_LT(all[4]["work"], all[1]["work"]);
  EXPECT_EQ(all[4]["least_work"], true);
  EXPECT_EQ(all[1]["least_work"], false);
  EXPECT_EQ(all[5]["within"], 0.1);
  EXPECT_EQ(all[5]["best"], "hex20 [1, 1, 8] automatic dt 0.05 s");
  EXPECT_EQ(all[5]["plain_reached"], false);
  EXPECT_GT(all[5]["work_ratio"], 2);
  EXPECT_EQ(all[5]["default"], nullptr);  // of hex27 there is none in brief runs
  EXPECT_EQ(test::fault_of_xml(read("found/cloth.svg")), "");
  EXPECT_THAT(read("found/cloth.svg"), HasSubstr("Pareto front"));
  EXPECT_THAT(read("found/accuracy.csv"), HasSubstr("cloth,run,quad9,\"[4, 4, 1]\",automatic,0.05,"));

  EXPECT_EQ(rows(command), all);  // seconds too
  EXPECT_THAT(ergon("bench accuracy --brief --problem cloth --out found").out,
              HasSubstr("reference quad9 [4, 4, 1] tr_bdf2 dt 0.0125 s; quad9 [4, 4, 1] sdirk2 dt 0.025 s differs by"));
}

// What is looser than the default is further from the strict run; all stand beside the error of dt.
TEST_F(BenchAccuracyCommand, StoppingTellsWhatToleranceAndDhatAdd) {
  const std::vector<Json> all = rows("stopping --brief --out found");
  ASSERT_EQ(all.size(), 9u);
  for (const Json& row : all) {
    EXPECT_EQ(row["failure"], "") << row;
    EXPECT_GT(row["dt_error"], 0) << row;
    EXPECT_GT(row["work"], 0) << row;
  }
  EXPECT_EQ(all[0]["study"], "tolerance");
  EXPECT_GT(all[0]["error"], 10 * all[2]["error"].get<double>());
  EXPECT_EQ(all[3]["study"], "friction");
  EXPECT_EQ(all[4]["default"], true);
  EXPECT_LE(all[4]["error"], all[3]["error"]);
  EXPECT_EQ(all[6]["key"], "ground.dhat (m)");
  EXPECT_GT(all[6]["error"], 2 * all[8]["error"].get<double>());
  const Answer answer = ergon("bench stopping --study frictoin");
  EXPECT_EQ(answer.code, 2);
  EXPECT_EQ(answer.err,
            "ergon: error: --study: 'frictoin' is none of tolerance, friction, barrier; did you mean 'friction'?\n");
}

TEST_F(BenchAccuracyCommand, NamesTheNearestProblem) {
  const Answer answer = ergon("bench accuracy --problem buckeling");
  EXPECT_EQ(answer.code, 2);
  EXPECT_EQ(answer.err,
            "ergon: error: --problem: 'buckeling' is none of cantilever, column, cloth, bounce, buckling; did you mean "
            "'buckling'?\n");
}

}  // namespace
}  // namespace ergon
