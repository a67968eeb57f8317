#include "scenes/run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "runtime/error.h"
#include "tests/scenes/real_kernels.h"

namespace ergon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string falling = R"(
[time]
dt = 0.01
steps = 30
[[object]]
name = "block"
box = { size = [0.1, 0.1, 0.1], cells = [2, 2, 2] }
element = "tet4"
translate = [0, 0, 0.02]
velocity = [0.5, 0, 0]
density = 1000
energy = [{ law = "stable_neo_hookean", E = "0.1 MPa", nu = 0.4 }]
[[ground]]
mu = 0.8
)";

class run : public testing::Test {
 protected:
  void TearDown() override { fs::remove_all(folder); }
  RunSummary go(const std::string& text, RunOptions options = {}) {
    const Scene scene = read_scene_text(text, "falling.toml");
    BuiltScene built = build_scene(scene, shipped_energies(), real_kernels);
    options.folder = folder.string();
    return run_scene(scene, built, options);
  }
  std::vector<json> report() const {
    std::vector<json> out;
    std::ifstream in(folder / "report.jsonl");
    for (std::string line; std::getline(in, line);) out.push_back(json::parse(line));
    return out;
  }
  int frame_files() const {
    int count = 0;
    for (const auto& entry : fs::directory_iterator(folder / "falling_frames"))
      count += entry.path().extension() == ".vtu";
    return count;
  }
  fs::path folder = fs::temp_directory_path() / ("ergon_run_" + std::to_string(getpid()));
};

TEST_F(run, takes_all_steps_and_writes_frames_report_and_summary) {
  const RunSummary summary = go(falling);
  EXPECT_EQ(summary.failure, "");
  EXPECT_EQ(summary.steps, 30);
  EXPECT_EQ(summary.unconverged_steps, 0);
  EXPECT_NEAR(summary.time, 0.3, 1e-12);
  EXPECT_EQ(summary.frames, 31);
  EXPECT_EQ(frame_files(), 31);
  EXPECT_GT(summary.most_contacts, 0);
  EXPECT_GT(summary.smallest_gap, 0);
  EXPECT_LT(summary.smallest_gap, 1e-3);
  EXPECT_LE(summary.max_energy_rise, 1e-9 * std::abs(summary.start_energy));
  EXPECT_LT(summary.end_energy, summary.start_energy);
  EXPECT_GT(summary.peak_memory, 1'000'000);

  const std::vector<json> records = report();
  ASSERT_EQ(records.size(), 30u);
  int newton = 0;
  for (size_t i = 0; i < records.size(); ++i) {
    EXPECT_EQ(records[i]["step"], i + 1);
    EXPECT_TRUE(records[i]["converged"]);
    newton += records[i]["newton_iterations"].get<int>();
  }
  EXPECT_EQ(newton, summary.newton_iterations);
  for (const char* term : {"stable_neo_hookean", "gravity", "ground_barrier", "kinetic", "total"})
    EXPECT_TRUE(records.back()["energy"].contains(term)) << term;

  std::ifstream in(folder / "summary.json");
  const json written = json::parse(in);
  EXPECT_TRUE(written["finished"]);
  EXPECT_EQ(written["newton_iterations"], newton);
  EXPECT_GT(written["seconds"]["total"], 0);
  EXPECT_THAT(summary.skipped, testing::Contains(testing::Pair("inertia: Hessian is constant, assembled once", 30)));
}

TEST_F(run, writes_frames_at_the_interval_and_removes_those_of_an_earlier_run) {
  go(falling);
  const RunSummary summary = go(falling + "[output]\nframe_interval = 0.1\n");
  EXPECT_EQ(summary.frames, 4);
  EXPECT_EQ(frame_files(), 4);
  go(falling + "[output]\nframes = false\n");
  EXPECT_EQ(report().size(), 30u);
}

TEST_F(run, writes_forces_of_contact_when_asked) {
  go(falling + "[output]\nforces = true\n");
  const std::vector<json> records = report();
  for (const char* part : {"contact", "friction"}) EXPECT_EQ(records.front()["forces"]["block"][part], json({0, 0, 0}));
  EXPECT_GT(records.back()["forces"]["block"]["contact"][2], 0);
  for (const char* frame : {"000000.vtu", "000030.vtu"}) {
    std::ifstream in(folder / "falling_frames" / frame);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    EXPECT_THAT(text, testing::HasSubstr("Name=\"contact_force\"")) << frame;
    EXPECT_THAT(text, testing::HasSubstr("Name=\"friction_force\"")) << frame;
  }
  go(falling);
  EXPECT_FALSE(report().back().contains("forces"));
}

TEST_F(run, ends_at_a_step_that_fails_with_the_last_good_state_written) {
  const RunSummary summary =
      go(falling + "[solver]\nmax_iterations = 1\ntolerance = 1e-12\n[output]\nframe_interval = 1\n");
  EXPECT_THAT(summary.failure, testing::StartsWith("step "));
  EXPECT_LT(summary.steps, 30);
  EXPECT_EQ(static_cast<long>(report().size()), summary.steps + 1);
  EXPECT_FALSE(report().back()["converged"]);
  EXPECT_EQ(summary.frames, summary.steps == 0 ? 1 : 2);
  std::ifstream in(folder / "summary.json");
  EXPECT_EQ(json::parse(in)["failure"], summary.failure);
}

TEST_F(run, stops_when_asked) {
  int asked = 0;
  RunOptions options;
  options.stop = [&] { return ++asked > 5; };
  const RunSummary summary = go(falling, options);
  EXPECT_TRUE(summary.stopped);
  EXPECT_EQ(summary.steps, 5);
  EXPECT_EQ(report().size(), 5u);
}

TEST_F(run, tells_its_progress) {
  std::vector<long> steps;
  RunOptions options;
  options.progress = [&](const StepRecord& record, long all) {
    EXPECT_EQ(all, 30);
    steps.push_back(record.step);
  };
  go(falling, options);
  ASSERT_EQ(steps.size(), 30u);
  EXPECT_EQ(steps.back(), 30);
}

TEST_F(run, refuses_an_output_folder_that_cannot_be_used) {
  fs::create_directories(folder);
  std::ofstream(folder / "file") << "x";
  for (const std::string& bad :
       {(folder / "file").string(), (folder / "file/below").string(), std::string("/proc/out")}) {
    try {
      prepare_output(bad);
      ADD_FAILURE() << bad << " was accepted";
    } catch (const OutputError& error) {
      EXPECT_THAT(error.what(), testing::StartsWith(bad + ": "));
    }
  }
  prepare_output((folder / "new/deep").string());
  EXPECT_TRUE(fs::is_empty(folder / "new/deep"));
}

TEST_F(run, names_its_folder_after_the_scene) {
  EXPECT_EQ(output_folder(read_scene_text(falling, "x/falling.toml")), "out/falling");
  EXPECT_EQ(output_folder(read_scene_text(falling + "[output]\nfolder = \"there\"\n", "x/falling.toml")), "there");
}

}  // namespace
}  // namespace ergon
