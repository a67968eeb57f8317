// Coulomb friction: a block that slides down a slope, and one that slides to rest on level ground.

#include <fmt/format.h>

#include "tools/verify/scene_case.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

std::string scene(const std::string& gravity, const std::string& time, double mu, const std::string& velocity) {
  return fmt::format(R"(
gravity = {}
[time]
{}
[solver]
tolerance = 1e-6
friction_iterations = 10
friction_tolerance = 1e-3
[[object]]
name = "block"
kinematics = "affine"
box = {{ size = [0.1, 0.1, 0.05], cells = [2, 2, 1] }}
translate = [0, 0, 0.0008]
density = 1000
velocity = {}
[[ground]]
mu = {}
epsv = 1e-4
)",
                     gravity, time, velocity, mu);
}

void run(const VerifyRows& rows) {
  // The plane is level here, and gravity turned by atan(1/2). Put down from 0.8 mm, the block must not bounce: in
  // flight it gains speed, of which the next impact takes less where it sticks.
  const SceneCase slope = run_scene_case(
      "slope",
      scene("[4.38717, 0, -8.77433]", "dt = 0.01\nend = 2.5\nintegrator = \"implicit_euler\"", 0.49, "[0, 0, 0]"));
  rows.add({"slope of atan(1/2), mu 0.49: acceleration (m/s^2)", "affine body", "1 block", slope.velocity().x() / 2.5,
            0.087743});
  for (const double mu : {0.1, 0.3, 0.5}) {
    const double end = 1.1 / (mu * 9.81);
    const SceneCase rest = run_scene_case(
        "slide", scene("[0, 0, -9.81]", fmt::format("dt = {}\nend = {}\nintegrator = \"bdf2\"", end / 200, end), mu,
                       "[1, 0, 0]"));
    rows.add({fmt::format("from 1 m/s to rest, mu {:g}: distance (m)", mu), "affine body", "1 block",
              rest.displacement().x(), 1 / (2 * mu * 9.81)});
  }
}

}  // namespace

VerifyCase sliding_block_case() {
  return {"sliding_block", "a block slides down a slope, and to rest on level ground",
          "Coulomb: g (sin - mu cos) = 0.087743 m/s^2 with g = 9.81 m/s^2, and v^2/(2 mu g): Timoshenko, Young 1956, "
          "Engineering mechanics",
          run};
}

}  // namespace ergon
