// Rods that twist, from their text to how they move.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/scenes/finish_scene.h"

namespace ergon {
namespace {

// A straight rod of 1 m along x, of 20 edges, with a radius of 1 cm.
std::string rod(const std::string& time, const std::string& more,
                const std::string& law = "law = \"discrete_rod\", EI1 = 2, EI2 = 3, GJ = 0.5") {
  return "[time]\n" + time +
         "\n[[object]]\nname = \"rod\"\nelement = \"edge2\"\nbox = { size = [1, 1, 1], cells = [20, 1, 1] }\n"
         "density = 1000\ncross_section = 3.141592653589793e-4\nenergy = [{ law = \"rod_stretching\", EA = 1e5 }, { " +
         law + " }]\n" + more;
}

const std::string clamped = "[[object.fixed]]\nmax = [0.06, 1, 1]\n";

std::string error_of(const std::string& text) {
  try {
    build_text(text);
  } catch (const SourceError& error) {
    return error.what();
  }
  return "";
}

TEST(RodTwist, EveryEdgeHasATwistThatHasTheMassOfTheEdge) {
  const BuiltScene built = build_text("gravity = [0, 0, -10]\n" + rod("dt = 0.01\nsteps = 1", clamped));
  ASSERT_EQ(built.points, 21);
  ASSERT_EQ(built.system->vertices(), 41);
  EXPECT_NEAR(built.bodies[0].gyration, 0.01 / std::sqrt(2), 1e-15);  // of a disc
  EXPECT_NEAR(built.mass.head(21).sum(), 0.1 * M_PI, 1e-14);
  EXPECT_NEAR(built.mass.tail(20).sum(), 0.1 * M_PI, 1e-14);
  int held = 0;
  for (int v = 21; v < 41; ++v) held += built.system->moves(v) ? 0 : 1;
  EXPECT_EQ(held, 1) << "that of the edge both of whose ends are fixed";
  for (int i = 0; i < built.system->potential_count(); ++i) {
    const Potential& potential = built.system->potential(i);
    const int expected = potential.name() == "gravity"        ? 21
                         : potential.name() == "inertia"      ? 41
                         : potential.name() == "discrete_rod" ? 19
                                                              : 20;
    EXPECT_EQ(potential.stencil_count(), expected) << potential.name();
  }
}

// Of a strip of moduli E and G, stiffnesses are formulas in a scene: no law is written for it.
TEST(RodTwist, StiffnessesFollowFromModuliAndASection) {
  const std::string strip =
      "law = \"discrete_rod\", EI1 = { formula = \"E*w*h^3/12\", E = \"2 GPa\", w = \"12 mm\", h = \"1 mm\" }, "
      "EI2 = { formula = \"E*h*w^3/12\", E = \"2 GPa\", w = \"12 mm\", h = \"1 mm\" }, "
      "GJ = { formula = \"G*w*h^3/3\", G = \"0.8 GPa\", w = \"12 mm\", h = \"1 mm\" }";
  const std::string time = "dt = 0.01\nsteps = 5";
  const FinishedScene formulas = finish_text(rod(time, clamped, strip));
  const FinishedScene numbers =
      finish_text(rod(time, clamped, "law = \"discrete_rod\", EI1 = 2e-3, EI2 = 0.288, GJ = 3.2e-3"));
  ASSERT_EQ(formulas.summary.failure, "");
  EXPECT_GT((numbers.end.x - numbers.built.start.x).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT((formulas.end.x - numbers.end.x).cwiseAbs().maxCoeff(), 1e-12);
}

// Two turns between the middles of the first and the last edge, which a script turns: the twist is even, and so is the
// moment of GJ times it over the length.
TEST(RodTwist, ATurnedEndTwistsARodEvenly) {
  const std::string turned =
      clamped +
      "[[object.scripted]]\nmin = [0.94, -1, -1]\n[[object.scripted.key]]\ntime = 1\nrotate = [\"720 deg\", 0, 0]\n";
  const Scene scene = read_scene_text(
      "gravity = [0, 0, 0]\n" + rod("integrator = \"quasi_static\"\ndt = 0.25\nend = 1", turned), "a.toml");
  FinishedScene run = finish(scene);
  ASSERT_EQ(run.summary.failure, "");
  const Body& body = run.built.bodies[0];
  for (int cell = 0; cell < 20; ++cell) {
    const auto at = 2 * static_cast<size_t>(cell);
    const double s = (body.ordered.X(0, body.ordered.cells[at]) + body.ordered.X(0, body.ordered.cells[at + 1])) / 2;
    EXPECT_NEAR(run.end.x(0, body.first_twist + cell) / body.gyration, 4 * M_PI * (s - 0.025) / 0.95, 1e-9);
  }
  EXPECT_LT((run.end.x.leftCols(21) - run.built.start.x.leftCols(21)).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(run.summary.end_energy, 0.5 / 2 * std::pow(4 * M_PI, 2) / 0.95, 1e-9);
}

// A free rod, bent, that spins: it keeps its energy and its momenta as the integrator does.
TEST(RodTwist, ARodThatTumblesFreelyDoesNotStrain) {
  const std::string text =
      "gravity = [0, 0, 0]\n" + rod("integrator = \"midpoint\"\ndt = 0.002\nsteps = 100", "rotate = [0.3, 0.2, 0.5]\n");
  const Scene scene = read_scene_text(text, "a.toml");
  BuiltScene built = build_scene(scene, shipped_energies(), real_kernels);
  const Eigen::Vector3d spin(3, 10, -4);
  const Eigen::Vector3d centre = built.start.x.leftCols(21).rowwise().mean();
  for (int v = 0; v < 21; ++v) built.start.v.col(v) = spin.cross(built.start.x.col(v) - centre);
  const FinishedScene run = finish(scene, std::move(built));
  ASSERT_EQ(run.summary.failure, "");
  EXPECT_NEAR(run.summary.end_energy, run.summary.start_energy, 1e-3 * run.summary.start_energy);
  const Eigen::Vector3d start = run.built.start.x.col(20) - run.built.start.x.col(0),
                        end = run.end.x.col(20) - run.end.x.col(0);
  EXPECT_LT(start.normalized().dot(end.normalized()), 0.5) << "it has turned";
  const Body& body = run.built.bodies[0];
  const Eigen::RowVectorXd twist = run.end.x.row(0).segment(body.first_twist, 20) / body.gyration;
  EXPECT_LT(twist.maxCoeff() - twist.minCoeff(), 1e-5);
}

TEST(RodTwist, MistakesAreNamed) {
  const std::string time = "dt = 0.01\nsteps = 1";
  EXPECT_THAT(error_of(rod(time, "axis = [1, 0, 0]\n")),
              testing::EndsWith("object 'rod': the axis of the cross-section, [1, 0, 0], runs along the first edge; it "
                                "must point across"));
  EXPECT_THAT(error_of(rod(time, "gyration = 0.01\n", "law = \"rod_bending\", EI = 1")),
              testing::EndsWith("'gyration' has no use here: no law of object 'rod' knows of twist, as those over a "
                                "rod_corner do"));
}

}  // namespace
}  // namespace ergon
