// Nothing lost: every shipped scene, with three starts that differ by noise, steps of 40, 10 and 1 ms, each step tested
// exactly for intersections. What is run to the end by `ergon batch tests/sweeps/nothing_lost.toml` is here run until a
// stated amount of work is done; the shorter steps start from where the longer ones have led, amid contact.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "scenes/start_noise.h"
#include "scenes/surface_check.h"
#include "tests/paths.h"
#include "tests/scenes/finish_scene.h"

namespace ergon {
namespace {

std::vector<std::string> scene_names() {
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(test::source("/scenes")))
    if (entry.path().extension() == ".toml") out.push_back(entry.path().stem().string());
  std::sort(out.begin(), out.end());
  return out;
}

// Steps of one length: some at least, and more until vertices times Newton iterations exceed this.
struct Stretch {
  double dt;  // s
  int least, most;
  double work;
};
constexpr Stretch stretches[] = {{0.04, 2, 12, 6e4}, {0.01, 2, 6, 2e4}, {0.001, 2, 6, 2e4}};

class SlowNothingLost : public testing::TestWithParam<std::tuple<std::string, int>> {};

TEST_P(SlowNothingLost, no_step_fails_and_no_surface_intersects) {
  const auto [name, seed] = GetParam();
  Scene scene = shipped_scene(name + ".toml");
  scene.start.noise = 0.1;
  scene.start.seed = seed;
  BuiltScene built = build_scene(scene, shipped_energies(), real_kernels);
  TimeStepper stepper = stepper_of(built);
  State state = built.start;
  for (const Stretch& stretch : stretches) {
    stepper.options().dt = stretch.dt;
    double work = 0;
    for (int step = 0; step < stretch.least || (step < stretch.most && work < stretch.work); ++step) {
      const StepRecord record = stepper.step(state);
      ASSERT_TRUE(record.converged) << "dt " << stretch.dt << " s, step " << step + 1 << ": " << record.reason;
      EXPECT_GT(record.smallest_gap, 0);
      work += static_cast<double>(record.newton_iterations) * static_cast<double>(state.x.cols());
      if (built.surfaces == nullptr) continue;
      const SurfaceFaults faults = find_surface_faults(built, state.x);
      ASSERT_TRUE(faults.none()) << "dt " << stretch.dt << " s, step " << step + 1 << ": "
                                 << to_text(faults, built, state.x);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(shipped, SlowNothingLost,
                         testing::Combine(testing::ValuesIn(scene_names()), testing::Values(1, 2, 3)),
                         [](const auto& info) {
                           return std::get<0>(info.param) + "_" + std::to_string(std::get<1>(info.param));
                         });

// The same numbers on every machine.
TEST(StartNoise, FollowsFromTheSeedAlone) {
  const auto velocities = [](int seed, const std::string& kinematics) {
    const std::string energy = "[[object.energy]]\nlaw = \"stable_neo_hookean\"\nE = 1e5\nnu = 0.3\n";
    const std::string text = "[time]\ndt = 0.01\nsteps = 1\n[start]\nnoise = 0.5\nseed = " + std::to_string(seed) +
                             "\n[[object]]\nname = \"a\"\nbox = { size = [1, 1, 1], cells = [1, 1, 1] }\nelement = "
                             "\"tet4\"\nvelocity = [3, 0, 0]\n"
                             "density = 1000\n" +
                             kinematics;
    return build_scene(
        read_scene_text(text + (kinematics.empty() ? energy + "[[object.fixed]]\nmax = [inf, inf, 0]\n" : ""),
                        "a.toml"),
        shipped_energies(), real_kernels);
  };
  const BuiltScene one = velocities(1, ""), same = velocities(1, ""), other = velocities(2, "");
  EXPECT_EQ(one.start.v, same.start.v);
  int free = 0;
  for (int v = 0; v < 8; ++v) {
    if (one.start.x(2, v) == 0) {
      EXPECT_EQ(one.start.v.col(v).norm(), 0);
      continue;
    }
    ++free;
    const Eigen::Vector3d noise = one.start.v.col(v) - Eigen::Vector3d(3, 0, 0);
    EXPECT_GT(noise.norm(), 0);
    EXPECT_LE(noise.cwiseAbs().maxCoeff(), 0.5);
    EXPECT_NE(one.start.v.col(v), other.start.v.col(v));
  }
  EXPECT_EQ(free, 4);
  // Vertex 7 of the box, by the formula in arithmetic of whole numbers.
  const auto& from = one.bodies[0].vertex_from;
  const auto seven = std::find(from.begin(), from.end(), 7) - from.begin();
  EXPECT_LT(
      (one.start.v.col(seven) - Eigen::Vector3d(2.5776693541857028, -0.16148268187095394, -0.23291692494142713)).norm(),
      1e-15);
}

// Of an affine body: one velocity and one rotation, which keep lengths to first order.
TEST(StartNoise, MovesAffineBodiesAsWholes) {
  const BuiltScene built = build_text(
      "[time]\ndt = 0.01\nsteps = 1\n[start]\nnoise = 0.5\n[[object]]\nname = \"a\"\nkinematics = \"affine\"\n"
      "box = { size = [1, 2, 3], cells = [1, 1, 1] }\ndensity = 1000\n");
  double fastest = 0;
  for (int a = 0; a < built.start.x.cols(); ++a) {
    fastest = std::max(fastest, built.start.v.col(a).norm());
    for (int b = 0; b < a; ++b) {
      const Eigen::Vector3d apart = built.start.x.col(a) - built.start.x.col(b);
      EXPECT_NEAR(apart.dot(built.start.v.col(a) - built.start.v.col(b)), 0, 1e-12);
    }
  }
  EXPECT_GT(fastest, 0.05);
}

}  // namespace
}  // namespace ergon
