#include "runtime/output/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "runtime/output/progress.h"
#include "tests/runtime/temporary_folder.h"

namespace ergon {
namespace {

ReportRecord example() {
  ReportRecord record;
  record.step = 3;
  record.time = 0.1;
  record.dt = 0.025;
  record.converged = true;
  record.newton_iterations = 4;
  record.linear_iterations = 17;
  record.residual = 1.5e-9;
  record.energies = {{"stable_neo_hookean", 0.25}, {"gravity", -1e-300}};
  record.times = {{"solve", 0.125}, {"assemble", 0.0625}};
  record.skipped = {{"friction", "no friction coefficient"}, {"self contact", "a \"quoted\"\nreason"}};
  record.smallest_gap = 1e-4;
  record.contacts = 12;
  return record;
}

TEST(output_report, a_record_is_one_line_with_keys_in_order) {
  EXPECT_EQ(to_json(example()),
            "{\"step\":3,\"time\":0.1,\"dt\":0.025,\"converged\":true,\"newton_iterations\":4,\"linear_iterations\":17,"
            "\"residual\":1.5e-09,\"energy\":{\"stable_neo_hookean\":0.25,\"gravity\":-1e-300},"
            "\"seconds\":{\"solve\":0.125,\"assemble\":0.0625},"
            "\"skipped\":[{\"part\":\"friction\",\"reason\":\"no friction coefficient\"},"
            "{\"part\":\"self contact\",\"reason\":\"a \\\"quoted\\\"\\nreason\"}],"
            "\"smallest_gap\":0.0001,\"contacts\":12}");
}

TEST(output_report, what_is_not_finite_or_not_there_is_null) {
  ReportRecord record;
  record.residual = NAN;
  record.energies = {{"spring", INFINITY}};
  EXPECT_EQ(to_json(record),
            "{\"step\":0,\"time\":0.0,\"dt\":0.0,\"converged\":false,\"newton_iterations\":0,\"linear_iterations\":0,"
            "\"residual\":null,\"energy\":{\"spring\":null},\"seconds\":{},\"skipped\":[],\"smallest_gap\":null,"
            "\"contacts\":0}");
}

TEST(output_report, lines_can_be_read_while_the_report_is_open) {
  const TemporaryFolder folder;
  folder.file("report.jsonl", "of an older run\n");
  Report report(folder.path("report.jsonl"));
  EXPECT_EQ(folder.content("report.jsonl"), "");
  report.append(example());
  report.append_line("{\"kind\":\"end\"}");
  std::istringstream lines(folder.content("report.jsonl"));
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_EQ(nlohmann::json::parse(line)["energy"]["stable_neo_hookean"], 0.25);
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_EQ(line, "{\"kind\":\"end\"}");
  EXPECT_FALSE(std::getline(lines, line));
}

TEST(output_report, a_report_can_go_on) {
  const TemporaryFolder folder;
  folder.file("report.jsonl", "1\n");
  Report(folder.path("report.jsonl"), true).append_line("2");
  EXPECT_EQ(folder.content("report.jsonl"), "1\n2\n");
}

TEST(output_progress, durations_have_two_parts_at_most) {
  EXPECT_EQ(duration_text(0), "0.0 s");
  EXPECT_EQ(duration_text(9.94), "9.9 s");
  EXPECT_EQ(duration_text(9.96), "10 s");
  EXPECT_EQ(duration_text(59.6), "1 min 0 s");
  EXPECT_EQ(duration_text(250), "4 min 10 s");
  EXPECT_EQ(duration_text(7500), "2 h 5 min");
  EXPECT_EQ(duration_text(3 * 86400 + 4 * 3600), "3 d 4 h");
  EXPECT_EQ(duration_text(NAN), "unknown");
  EXPECT_EQ(duration_text(INFINITY), "unknown");
}

TEST(output_progress, a_pipe_gets_a_plain_line_per_tenth) {
  std::ostringstream out;
  double now = 100;
  Progress progress(out, false, 40, [&] { return now; });
  for (int step = 1; step <= 40; ++step) {
    now += 2;
    progress.update(step, 0.01 * step, step == 4 ? "3 iterations" : "");
  }
  progress.finish();
  EXPECT_EQ(out.str(),
            "step 4/40   10 %  t = 0.04 s  1 min 12 s left  3 iterations\n"
            "step 8/40   20 %  t = 0.08 s  1 min 4 s left\n"
            "step 12/40   30 %  t = 0.12 s  56 s left\n"
            "step 16/40   40 %  t = 0.16 s  48 s left\n"
            "step 20/40   50 %  t = 0.2 s  40 s left\n"
            "step 24/40   60 %  t = 0.24 s  32 s left\n"
            "step 28/40   70 %  t = 0.28 s  24 s left\n"
            "step 32/40   80 %  t = 0.32 s  16 s left\n"
            "step 36/40   90 %  t = 0.36 s  8.0 s left\n"
            "step 40/40  100 %  t = 0.4 s  took 1 min 20 s\n");
}

TEST(output_progress, a_terminal_gets_one_line_that_is_rewritten) {
  std::ostringstream out;
  double now = 0;
  Progress progress(out, true, 100, [&] { return now; });
  for (int step = 1; step <= 3; ++step) {
    now += 0.0625;  // the second update comes too soon
    progress.update(step, step);
  }
  EXPECT_EQ(out.str(),
            "\rstep 1/100    1 %  t = 1 s  6.2 s left\x1b[K"
            "\rstep 3/100    3 %  t = 3 s  6.1 s left\x1b[K");
  progress.update(100, 100, std::string(200, 'x'));
  progress.finish();
  progress.finish();
  const std::string text = out.str();
  EXPECT_EQ(text.substr(text.rfind('\r')),
            "\rstep 100/100  100 %  t = 100 s  took 0.2 s  " + std::string(35, 'x') + "\x1b[K\n");
}

TEST(output_progress, the_time_left_follows_the_pace_of_the_last_steps) {
  std::ostringstream out;
  double now = 0;
  Progress progress(out, false, 1000, [&] { return now; });
  for (int step = 1; step <= 500; ++step) {
    now += step <= 400 ? 1 : 10;
    progress.update(step, step);
  }
  const std::string text = out.str();
  EXPECT_NE(text.find("step 400/1000   40 %  t = 400 s  10 min 0 s left\n"), std::string::npos) << text;
  EXPECT_NE(text.find("step 500/1000   50 %  t = 500 s  1 h 23 min left\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace ergon
