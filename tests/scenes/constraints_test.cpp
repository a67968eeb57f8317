// Laws of a scene that keep their constraint within a tolerance.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/scenes/finish_scene.h"

namespace ergon {
namespace {

// A rope of eight links whose law is a link of fixed length, in line, held at one end; soft as it is it would be many
// times as long.
std::string rope(const std::string& more) {
  return R"(
[time]
dt = 0.01
steps = 40
[[object]]
name = "rope"
element = "edge2"
box = { size = [0.8, 1, 1], cells = [8, 1, 1] }
density = 1000
cross_section = 1e-4
fixed = [{ max = [0.01, inf, inf] }]
[[object.energy]]
text = '''
energy     link  edge
dof        x0 x1   m
rest       L       m     (0, inf)   length
param      k       N/m   (0, inf)   stiffness
constraint c = norm(x1 - x0) - L
value      k/2*c^2
'''
k = 1
)" + more;
}

double worst_length(const FinishedScene& scene) {
  double worst = 0;
  for (int i = 0; i + 1 < scene.end.x.cols(); ++i)
    worst = std::max(worst, std::fabs((scene.end.x.col(i + 1) - scene.end.x.col(i)).norm() - 0.1));
  return worst;
}

TEST(SceneConstraints, AreKeptHoweverSoftTheirLaw) {
  const FinishedScene kept = finish_text(rope("constraint_tolerance = \"0.1 mm\"\n"));
  ASSERT_EQ(kept.summary.failure, "");
  EXPECT_LE(worst_length(kept), 1e-4);
  const FinishedScene loose = finish_text(rope(""));
  ASSERT_EQ(loose.summary.failure, "");
  EXPECT_GT(worst_length(loose), 0.01);
}

}  // namespace
}  // namespace ergon
