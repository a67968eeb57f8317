// The same program, scene and number of threads give the same bytes; another number of threads the same positions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <omp.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/scenes/finish_scene.h"

namespace ergon {
namespace {

namespace fs = std::filesystem;

const std::string scene = R"(
[time]
dt = 0.01
steps = 30
integrator = "bdf2"
[output]
forces = true
[contact]
mu = 0.4
[[object]]
name = "block"
box = { size = [0.1, 0.1, 0.1], cells = [4, 4, 4] }
element = "tet4"
translate = [0, 0, 0.01]
density = 1000
energy = [{ law = "stable_neo_hookean", E = "0.1 MPa", nu = 0.4 }]
[[object]]
name = "tilted"
box = { size = [0.1, 0.1, 0.1], cells = [3, 3, 3] }
element = "tet4"
rotate = ["20 deg", "10 deg", 0]
translate = [0.02, -0.01, 0.15]
density = 500
energy = [{ law = "hencky", E = "50 kPa", nu = 0.3 }]
[[object]]
name = "sheet"
box = { size = [0.2, 0.2, 1], cells = [8, 8, 1] }
element = "tri3"
thickness = 0.001
translate = [-0.05, -0.05, 0.29]
density = 300
energy = [{ law = "neo_hookean_membrane", E = "0.2 MPa", nu = 0.3 }, { law = "quadratic_bending", k = 1e-5 }]
[[ground]]
mu = 0.5
)";

struct Written {
  std::map<std::string, std::string> frames;  // by file name
  std::vector<nlohmann::json> report;         // without run times
  Eigen::Matrix3Xd x;
  int contacts = 0;
};

Written run_with(int threads) {
  const int before = omp_get_max_threads();
  omp_set_num_threads(threads);
  const fs::path folder = fs::temp_directory_path() / ("ergon_reproducible_" + std::to_string(getpid()));
  const Scene read = read_scene_text(scene, "same.toml");
  BuiltScene built = build_scene(read, shipped_energies(), real_kernels);
  State end;
  RunOptions options;
  options.folder = folder.string();
  options.last_state = &end;
  Written out;
  out.contacts = run_scene(read, built, options).most_contacts;
  out.x = end.x;
  for (const auto& entry : fs::directory_iterator(folder / "same_frames")) {
    std::ifstream in(entry.path(), std::ios::binary);
    out.frames[entry.path().filename()] = {std::istreambuf_iterator<char>(in), {}};
  }
  std::ifstream in(folder / "report.jsonl");
  for (std::string line; std::getline(in, line);) {
    out.report.push_back(nlohmann::json::parse(line));
    out.report.back().erase("seconds");
  }
  fs::remove_all(folder);
  omp_set_num_threads(before);
  return out;
}

TEST(SlowReproducible, SameThreadsGiveTheSameBytesAndOthersTheSamePositions) {
  const Written once = run_with(1), again = run_with(1), two = run_with(2), two_again = run_with(2);
  EXPECT_EQ(once.frames.size(), 31u);
  EXPECT_EQ(once.report.size(), 30u);
  EXPECT_GT(once.contacts, 50);
  EXPECT_TRUE(once.frames == again.frames);
  EXPECT_TRUE(once.report == again.report);
  EXPECT_TRUE(two.frames == two_again.frames);
  EXPECT_TRUE(two.report == two_again.report);
  EXPECT_LE((once.x - two.x).cwiseAbs().maxCoeff(), 0.0);
}

}  // namespace
}  // namespace ergon
