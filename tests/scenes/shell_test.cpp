// Shells with normals amid their edges, from their text to how they move.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "runtime/mesh/mesh_stencils.h"
#include "tests/scenes/finish_scene.h"

namespace ergon {
namespace {

constexpr double young = 1e6, thickness = 0.01, length = 1;

// A strip along x, 1 m long and 0.2 m wide.
std::string strip(const std::string& time, const std::string& more) {
  return "[time]\n" + time +
         fmt::format(
             "\n[[object]]\nname = \"strip\"\nelement = \"tri3\"\n"
             "box = {{ size = [{}, 0.2, 1], cells = [20, 4, 1] }}\ndensity = 1000\nthickness = {}\n"
             "energy = [{{ law = \"st_venant_kirchhoff_membrane\", E = {}, nu = 0 }}, "
             "{{ law = \"koiter_bending\", E = {}, nu = 0 }}]\n",
             length, thickness, young, young) +
         more;
}

const std::string clamped = "[[object.fixed]]\nmax = [0.051, 1, 1]\n";  // the first cells

TEST(Shell, EveryEdgeHasANormalThatIsHeldWithAWholeTriangle) {
  const BuiltScene built = build_text("gravity = [0, 0, -10]\n" + strip("dt = 0.01\nsteps = 1", clamped));
  const Body& body = built.bodies[0];
  const std::vector<int> edges = stencils_on_mesh("edge", body.ordered);
  ASSERT_EQ(built.points, 21 * 5);
  ASSERT_EQ(static_cast<size_t>(built.system->vertices()), 21 * 5 + edges.size() / 2);
  // The weight is that of the vertices; a normal has a thousandth of an edge's mass at most.
  EXPECT_NEAR(built.mass.head(built.points).sum(), 1000 * 0.2 * length * thickness, 1e-12);
  EXPECT_LT(built.mass.tail(body.tips).sum(), 1.001e-3 * 1000 * 0.2 * length * thickness);
  EXPECT_GT(built.mass.tail(body.tips).minCoeff(), 0);
  for (int edge = 0; edge < body.tips; ++edge) {
    const auto at = 2 * static_cast<size_t>(edge);
    const double farthest = std::max(body.ordered.X(0, edges[at]), body.ordered.X(0, edges[at + 1]));
    EXPECT_EQ(built.system->moves(body.first_tip() + edge), farthest > 0.051) << edge;
  }
}

// A cantilever under its weight, which bends it by far less than its length: q L^4/(8 E h^3/12).
TEST(Shell, AClampedStripSagsAsABeam) {
  FinishedScene run = finish(read_scene_text("gravity = [0, 0, -1e-3]\n" +
                                                 strip("integrator = \"quasi_static\"\ndt = 1\nend = 1", clamped) +
                                                 "[solver]\ntolerance = 1e-9\n",
                                             "a.toml"));
  ASSERT_EQ(run.summary.failure, "");
  const double free = length - 0.05, weight = 1000 * thickness * 1e-3, stiffness = young * std::pow(thickness, 3) / 12;
  const double expected = weight * std::pow(free, 4) / (8 * stiffness);
  EXPECT_NEAR(-run.end.x.row(2).head(run.built.points).minCoeff(), expected, 0.01 * expected);
}

// Whole triangles that follow a script take their normals along: what turns about them is not bent at rest.
TEST(Shell, AStripThatIsTurnedByItsEndDoesNotBend) {
  const std::string turned =
      "[[object.scripted]]\nmax = [0.051, 1, 1]\n[[object.scripted.key]]\ntime = 1\n"
      "rotate = [0, \"170 deg\", 0]\n";
  FinishedScene run = finish(read_scene_text(
      "gravity = [0, 0, 0]\n" + strip("integrator = \"quasi_static\"\ndt = 0.1\nend = 1", turned), "a.toml"));
  ASSERT_EQ(run.summary.failure, "");
  EXPECT_LT(run.summary.end_energy, 1e-9 * young * std::pow(thickness, 3));
  EXPECT_NEAR(run.end.x.row(0).head(run.built.points).minCoeff(), -length * std::cos(M_PI / 18), 1e-6);
}

// A strip that flies and spins freely keeps its momenta: normals carry little of them.
TEST(Shell, AFreeStripKeepsItsMomentum) {
  FinishedScene run = finish(read_scene_text(
      "gravity = [0, 0, 0]\n" + strip("integrator = \"bdf2\"\ndt = 0.01\nsteps = 20", "velocity = [1, 2, 3]\n"),
      "a.toml"));
  ASSERT_EQ(run.summary.failure, "");
  EXPECT_LT((run.end.v.colwise() - Eigen::Vector3d(1, 2, 3)).cwiseAbs().maxCoeff(), 1e-9);
}

}  // namespace
}  // namespace ergon
