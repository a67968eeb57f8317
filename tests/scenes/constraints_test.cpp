// Laws of a scene that keep their constraint within a tolerance.

#include <gtest/gtest.h>

#include <Eigen/LU>
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

// Every tetrahedron of a block that hangs from its top keeps its volume, by a law that is far too soft for it.
TEST(SceneConstraints, KeepTheVolumesOfCellsTogetherWithASolid) {
  const auto finished = [](const std::string& integrator) {
    return finish_text("[time]\nintegrator = \"" + integrator + R"("
dt = 0.01
steps = 6
[[object]]
name = "block"
element = "tet4"
box = { size = [0.1, 0.2, 0.1], cells = [2, 4, 2] }
density = 1000
fixed = [{ min = [-inf, 0.099, -inf] }]
energy = [{ law = "neo_hookean", E = 1e4, nu = 0.2 },
          { law = "volume_constraint", k = 1e6, constraint_tolerance = "0.1 mm^3" }]
)");
  };
  for (const char* integrator : {"implicit_euler", "sdirk2", "quasi_static"}) {
    SCOPED_TRACE(integrator);
    const FinishedScene block = finished(integrator);
    ASSERT_EQ(block.summary.failure, "");
    const Mesh& mesh = block.built.bodies[0].ordered;
    const auto volume = [&](const Eigen::Matrix3Xd& x, int cell) {
      const int* v = &mesh.cells[static_cast<size_t>(4 * cell)];
      Eigen::Matrix3d edges;
      for (int i = 0; i < 3; ++i) edges.col(i) = x.col(v[i + 1]) - x.col(v[0]);
      return edges.determinant() / 6;
    };
    for (int i = 0; i < mesh.cell_count(); ++i)
      EXPECT_LE(std::fabs(volume(block.end.x, i) - volume(block.built.start.x, i)), 1.0001e-10);
    EXPECT_GT((block.end.x - block.built.start.x).cwiseAbs().maxCoeff(), 1e-3);
  }
}

}  // namespace
}  // namespace ergon
