// An energy that a scene holds as text is the same as that of a file.
#include <gmock/gmock.h>
#include <fstream>

#include "scenes/scene_text.h"
#include "tests/scenes/real_kernels.h"

namespace ergon {
namespace {

const std::string before = R"([time]
dt = 0.01
steps = 2
[[object]]
name = "block"
box = { size = [0.1, 0.2, 0.3], cells = [1, 1, 1] }
element = "tet4"
density = 1000
[[object.energy]]
)";

double largest_move(const std::string& scene) {
  BuiltScene built = build_text(scene);
  EXPECT_TRUE(built.warnings.empty()) << built.warnings.front();
  TimeStepper stepper(*built.system, built.mass, nullptr, built.step);
  State state = built.start;
  state.x.row(0) *= 1.1;
  EXPECT_TRUE(stepper.step(state).converged);
  return (state.x - built.start.x).cwiseAbs().maxCoeff();
}

TEST(energy_text, acts_like_the_same_energy_in_a_file) {
  const std::string text =
      "text = \"\"\"\n# A solid.\ndensity  of_the_scene  solid\nparam    E   Pa  (0, inf)   stiffness\n"
      "param    nu  1   [0, 1/2)\nlet      mu = E/(2*(1 + nu))\n"
      "let      la = E*nu/((1 + nu)*(1 - 2*nu))\nlet      J = det(F)\nrequire  J > 0\n"
      "value    mu/2*(tr(F'*F) - 3) - mu*log(J)\n         + la/2*log(J)^2\n\"\"\"\n";
  const std::string params = "E = \"0.5 MPa\"\nnu = 0.4\n";
  const double moved = largest_move(before + text + params);
  EXPECT_GT(moved, 1e-4);
  EXPECT_EQ(moved, largest_move(before + "law = \"neo_hookean\"\n" + params));
}

TEST(energy_text, what_is_unsound_in_it_is_told_with_the_line_of_the_scene) {
  const std::string text =
      "text = '''\ndensity  prestressed  solid\nparam    k  Pa  (0, inf)\nvalue    k*norm2(F)\n'''\n";
  const BuiltScene built = build_text(before + text + "k = 1\n", "b.toml");
  ASSERT_EQ(built.warnings.size(), 1u);
  EXPECT_THAT(built.warnings[0], testing::StartsWith("b.toml:13:10: not stress-free at F = I"));
}

TEST(energy_text, survives_a_sweep) {
  const std::string file = testing::TempDir() + "/energy_text_sweep.toml";
  std::ofstream(file) << before +
                             "text = \"\"\"\ndensity  soft  solid\nparam    k  Pa  (0, inf)\n"
                             "value    k*norm2(F'*F - identity(3))\n\"\"\"\nk = 1\n";
  SceneText text(file);
  const auto [path, change] = read_change("object.block.energy.0.k=7", Place{"--set"});
  text.set(path, *change.get("value"), Place{"--set"});
  const Scene scene = read_scene_text(text.text(), "job.toml");
  EXPECT_EQ(scene.objects[0].energies[0].params.at("k").components[0].value, 7);
  EXPECT_EQ(build_text(text.text(), "job.toml").bodies.size(), 1u);
}

}  // namespace
}  // namespace ergon
