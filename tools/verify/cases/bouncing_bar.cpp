// An elastic bar hits the ground along its axis without gravity. A wave of pressure runs up and comes back as one of
// tension, upon which the bar leaves as fast as it came and without vibration: no energy is lost.

#include <fmt/format.h>

#include "tools/verify/scene_case.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

// Waves run at 100 m/s: the bar of 1 m is in contact for 20 ms.
std::string scene(int cells, const std::string& integrator) {
  return fmt::format(R"(
gravity = [0, 0, 0]
[time]
dt = {0}
end = 0.03
integrator = "{1}"
[solver]
tolerance = 1e-7
[[object]]
name = "bar"
element = "edge2"
box = {{ size = [1, 1, 1], cells = [{2}, 1, 1] }}
rotate = [0, "-90 deg", 0]
translate = [0, 0, 0.002]
density = 1000
cross_section = "1 cm^2"
velocity = [0, 0, -1]
energy = [{{ law = "rod_stretching", EA = 1000 }}]
fixed = [{{ axes = "xy" }}]
[[ground]]
dhat = 0.001
)",
                     0.01 / cells / 2, integrator, cells);
}

void run(const VerifyRows& rows) {
  for (const int cells : {50, 200}) {
    if (rows.quick() && cells > 50) break;
    for (const char* integrator : {"newmark", "bdf2"}) {
      const SceneCase bar = run_scene_case("bar", scene(cells, integrator));
      const bool fine = cells > 50;
      const std::string note = fine ? "" : "coarse";
      rows.add({fmt::format("speed after / before, {}", integrator), "Edge2", std::to_string(cells), bar.velocity().z(),
                1, fine ? 0.01 : 0.05, note});
      rows.add({fmt::format("energy after / before, {}", integrator), "Edge2", std::to_string(cells),
                bar.summary.end_energy / bar.summary.start_energy, 1, fine ? 0.01 : 0.05, note});
    }
  }
}

}  // namespace

VerifyCase bouncing_bar_case() {
  return {"bouncing_bar", "an elastic bar bounces off the ground and keeps its energy",
          "Timoshenko, Goodier 1970, Theory of elasticity, longitudinal impact of bars: contact for 2 L/c, "
          "then the velocity is reversed",
          run};
}

}  // namespace ergon
