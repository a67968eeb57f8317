// Small scenes in which surfaces collide, from their text to their end, every step tested exactly for intersections.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/run.h"
#include "scenes/surface_check.h"
#include "tests/scenes/finish_scene.h"

namespace ergon {
namespace {

using testing::HasSubstr;

std::string block(const std::string& name, const std::string& keys) {
  return "[[object]]\nname = \"" + name +
         "\"\nbox = { size = [0.1, 0.1, 0.1], cells = [2, 2, 2] }\nelement = \"tet4\"\ndensity = 1000\n" + keys +
         "[[object.energy]]\nlaw = \"stable_neo_hookean\"\nE = 1e5\nnu = 0.3\n";
}

std::string settings(const std::string& gravity, double dt, int steps, const std::string& contact = "") {
  return "gravity = " + gravity + "\n[time]\ndt = " + std::to_string(dt) + "\nsteps = " + std::to_string(steps) +
         "\nintegrator = \"implicit_euler\"\n[contact]\n" + contact;
}

Eigen::Vector3d mean(const Eigen::Matrix3Xd& x, int first, int count) {
  return x.middleCols(first, count).rowwise().mean();
}

TEST(Contact, BlocksThatMeetKeepTheirMomentumAndDoNotPassThrough) {
  const FinishedScene run = finish_text(settings("[0, 0, 0]", 0.01, 30) + block("left", "velocity = [1, 0, 0]\n") +
                                        block("right", "translate = [0.15, 0.03, 0.02]\nrotate = [0.1, 0.2, 0.3]\n"));
  EXPECT_EQ(run.summary.failure, "");
  EXPECT_EQ(run.summary.unconverged_steps, 0);
  EXPECT_GT(run.summary.smallest_gap, 0);
  EXPECT_LT(run.summary.smallest_gap, 1e-3);  // they met
  EXPECT_LE(run.summary.max_energy_rise, 1e-6 * run.summary.start_energy);
  // 1 kg at 1 m/s; each step is solved to 1e-4 m/s.
  const Eigen::Vector3d momentum = run.end.v * run.built.mass;
  EXPECT_LT((momentum - Eigen::Vector3d(1, 0, 0)).norm(), 1e-3);
  const int half = run.built.bodies[1].first_vertex;
  EXPECT_LT(mean(run.end.v, 0, half)[0], 0.6);
  EXPECT_GT(mean(run.end.v, half, half)[0], 0.4);
}

TEST(Contact, IgnoredPairsPassThrough) {
  const FinishedScene run = finish_text(
      settings("[0, 0, 0]", 0.01, 30, "[[contact.pair]]\nfirst = \"left\"\nsecond = \"right\"\nignore = true\n") +
      block("left", "velocity = [1, 0, 0]\n") + block("right", "translate = [0.15, 0, 0]\n"));
  EXPECT_EQ(run.summary.failure, "");
  EXPECT_NEAR(mean(run.end.x, 0, 27)[0], 0.05 + 0.3, 1e-9);
  EXPECT_NEAR(mean(run.end.x, 27, 27)[0], 0.2, 1e-9);
}

// Down an inclined plane with friction a block moves by g (sin - mu cos)/2 t^2, and by implicit Euler a factor of
// 1 + dt/t more.
TEST(Contact, BlockOnASlopeStaysOrSlidesAsCoulombSays) {
  const double g = 9.81, t = 0.5, dt = 0.01;
  const std::string slope =
      "[[obstacle]]\nname = \"slope\"\nbox = { size = [2, 1, 0.1], cells = [4, 2, 1] }\ntranslate = [-0.5, -0.4, "
      "-0.1]\n";
  for (const double mu : {0.6, 0.3}) {
    const std::string block =
        "[[object]]\nname = \"block\"\nbox = { size = [0.1, 0.1, 0.05], cells = [2, 2, 1] }\nelement = "
        "\"tet4\"\nrotate = [0, 0, 0.2]\n"
        "translate = [0, 0, 0.000774]\ndensity = 1000\n[[object.energy]]\nlaw = \"stable_neo_hookean\"\nE = 1e7\n"
        "nu = 0.3\n[solver]\nfriction_iterations = 10\nfriction_tolerance = 1e-3\n";
    const FinishedScene run =
        finish_text(settings("[4.38717, 0, -8.77433]", dt, 50, "mu = " + std::to_string(mu) + "\n") + block + slope);
    ASSERT_EQ(run.summary.failure, "");
    const double way = (mean(run.end.x, 0, 18) - mean(run.built.start.x, 0, 18))[0];
    const double expected = std::max(0.0, g * (0.4472136 - mu * 0.8944272) / 2 * t * (t + dt));
    EXPECT_NEAR(way, expected, 6e-4 + 0.01 * expected) << mu;  // epsv is 1 mm/s
  }
}

// What accelerates the block is its weight and the forces that the report tells; the slope bears the opposite.
TEST(Contact, ForcesOfTheReportAccelerateTheBlock) {
  const double dt = 0.01;
  const std::string text = settings("[4.38717, 0, -8.77433]", dt, 30, "mu = 0.3\n") +
                           block("block", "translate = [0, 0, 0.0006]\n") +
                           "[[obstacle]]\nname = \"slope\"\nbox = { size = [2, 1, 0.1], cells = [4, 2, 1] }\ntranslate "
                           "= [-0.5, -0.4, -0.1]\n"
                           "[output]\nforces = true\n";
  BuiltScene built = build_scene(read_scene_text(text, "a.toml"), shipped_energies(), real_kernels);
  TimeStepper stepper(*built.system, built.mass, built.contacts.get(), built.step, built.script);
  State state = built.start;
  for (int step = 0; step < 30; ++step) {
    const Eigen::Vector3d before = state.v * built.mass;
    const StepRecord record = stepper.step(state);
    ASSERT_TRUE(record.accepted) << record.reason;
    ASSERT_TRUE(record.forces);
    const Eigen::Vector3d normal = record.forces->normal.leftCols(27).rowwise().sum();
    const Eigen::Vector3d friction = record.forces->friction.leftCols(27).rowwise().sum();
    const Eigen::Vector3d weight = Eigen::Vector3d(4.38717, 0, -8.77433);  // N; 1 kg
    const Eigen::Vector3d pushed = (state.v * built.mass - before) / dt;
    EXPECT_LT((normal + friction + weight - pushed).norm(), 2e-2) << step;  // 1 kg solved to 5e-5 m/s
    EXPECT_LT((record.forces->normal.rowwise().sum() + record.forces->friction.rowwise().sum()).norm(), 1e-9);
    if (step < 20) continue;  // it slides steadily
    EXPECT_NEAR(normal[2], 8.77433, 0.02 * 8.77433);
    EXPECT_NEAR(friction[0], -0.3 * normal[2], 0.02 * normal[2]);
  }
}

TEST(Contact, ObstacleOnAScriptCarriesWhatLiesOnIt) {
  const FinishedScene run =
      finish_text(settings("[0, 0, -9.81]", 0.01, 50, "mu = 0.8\n") + block("block", "translate = [0, 0, 0.0006]\n") +
                  "[[obstacle]]\nname = \"plate\"\nbox = { size = [0.3, 0.3, 0.02], cells = [2, 2, 1] }\n"
                  "translate = [-0.1, -0.1, -0.02]\n[[obstacle.key]]\ntime = 0.5\ntranslate = [0.2, 0, 0.3]\n");
  ASSERT_EQ(run.summary.failure, "");
  const Eigen::Vector3d moved = mean(run.end.x, 0, 27) - mean(run.built.start.x, 0, 27);
  EXPECT_NEAR(moved[0], 0.2, 5e-3);
  EXPECT_NEAR(moved[2], 0.3, 5e-3);
  // The plate is exactly where its script says.
  const Body& plate = run.built.bodies[1];
  const int count = plate.ordered.vertices();
  const Eigen::Matrix3Xd way =
      run.end.x.middleCols(plate.first_vertex, count) - run.built.start.x.middleCols(plate.first_vertex, count);
  EXPECT_LT((way.colwise() - Eigen::Vector3d(0.2, 0, 0.3)).cwiseAbs().maxCoeff(), 1e-15);
}

// Between shapes vertices go straight, and keys move the whole about its centre.
TEST(Contact, ObstacleTakesItsShapesInTurn) {
  const FinishedScene run = finish(read_scene_text(
      settings("[0, 0, 0]", 0.05, 3) + block("block", "translate = [0, 0, 1]\n") +
          "[[obstacle]]\nname = \"cup\"\nmesh = \"cup_open.obj\"\nscale = 2\ntranslate = [1, 0, 0]\n"
          "[[obstacle.shape]]\ntime = 0.1\nmesh = \"cup_closed.obj\"\n[[obstacle.shape]]\ntime = 0.2\nmesh = "
          "\"cup_open.obj\"\n[[obstacle.key]]\ntime = 0.2\ntranslate = [0, 0.4, 0]\n",
      test::source("/scenes/meshes/a.toml")));
  ASSERT_EQ(run.summary.failure, "");
  const Body& cup = run.built.bodies[1];
  for (int v = 0; v < cup.ordered.vertices(); ++v) {
    const Eigen::Vector3d open = cup.ordered.X.col(v);
    const int ring = (cup.vertex_from[static_cast<size_t>(v)] + 11) / 12;  // 0: the middle of the bottom
    const double part = ring < 2 ? 1
                                 : (1 + std::array{0.045, 0.04, 0.042}[static_cast<size_t>(ring - 2)] /
                                            std::array{0.06, 0.062, 0.064}[static_cast<size_t>(ring - 2)]) /
                                       2;
    const Eigen::Vector3d expected(1 + part * (open[0] - 1), part * open[1] + 0.3, open[2]);
    EXPECT_LT((run.end.x.col(cup.first_vertex + v) - expected).norm(), 2e-5) << v;
  }
}

TEST(Contact, OffsetsKeepSurfacesApart) {
  const FinishedScene run =
      finish_text(settings("[0, 0, -9.81]", 0.01, 40) + block("block", "translate = [0, 0, 0.02]\noffset = 0.004\n") +
                  "[[obstacle]]\nname = \"plate\"\nbox = { size = [0.3, 0.3, 0.02], cells = [2, 2, 1] }\n"
                  "translate = [-0.1, -0.1, -0.02]\noffset = 0.001\n");
  ASSERT_EQ(run.summary.failure, "");
  const double lowest = run.end.x.row(2).head(27).minCoeff();
  EXPECT_GT(lowest, 0.005);
  EXPECT_LT(lowest, 0.006);
}

TEST(Contact, MatTwistedByItsEndsReachesItsScript) {
  const FinishedScene run = finish_text(settings("[0, 0, 0]", 0.02, 25) +
                                        "[[object]]\nname = \"mat\"\nbox = { size = [0.4, 0.1, 0.02], cells = [8, 2, "
                                        "1] }\nelement = \"tet4\"\ndensity = 1000\n"
                                        "[[object.energy]]\nlaw = \"stable_neo_hookean\"\nE = 1e5\nnu = 0.3\n"
                                        "[[object.fixed]]\nmax = [0.001, inf, inf]\n"
                                        "[[object.scripted]]\nmin = [0.399, -inf, -inf]\ncenter = [0.4, 0.05, "
                                        "0.01]\n[[object.scripted.key]]\ntime = 0.5\n"
                                        "rotate = [\"180 deg\", 0, 0]\n");
  ASSERT_EQ(run.summary.failure, "");
  for (int v = 0; v < run.end.x.cols(); ++v) {
    const Eigen::Vector3d X = run.built.start.x.col(v);
    if (X[0] < 0.399) continue;
    const Eigen::Vector3d turned(X[0], 0.1 - X[1], 0.02 - X[2]);
    EXPECT_LT((run.end.x.col(v) - turned).norm(), 1e-12);
  }
}

TEST(Contact, MotionThatCrushesIsToldWithItsVertexAndKeepsTheState) {
  const FinishedScene run =
      finish_text(settings("[0, 0, 0]", 0.01, 10) + "[solver]\nmax_iterations = 40\n" +
                  block("block", "translate = [0, 0, 0.001]\n[[object.fixed]]\nmax = [inf, inf, 0.01]\n") +
                  "[[obstacle]]\nname = \"press\"\nbox = { size = [0.3, 0.3, 0.02], cells = [2, 2, 1] }\n"
                  "translate = [-0.1, -0.1, 0.11]\n[[obstacle.key]]\ntime = 0.1\ntranslate = [0, 0, -0.2]\n");
  EXPECT_THAT(run.summary.failure, HasSubstr("failed"));
  EXPECT_GT(run.summary.smallest_gap, 0);
  EXPECT_TRUE(find_surface_faults(run.built, run.end.x).none());
}

std::string start_error(const std::string& text) {
  try {
    build_text(text);
  } catch (const SourceError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Contact, StartWithIntersectionsNamesThemAndCanBeLookedAt) {
  const std::string text = settings("[0, 0, 0]", 0.01, 1) + block("one", "") +
                           block("two", "translate = [0.08, 0.013, 0.017]\nrotate = [0.1, 0, 0]\n");
  EXPECT_THAT(start_error(text), HasSubstr("surfaces collide at the start: edge "));
  EXPECT_THAT(start_error(text), HasSubstr(" crosses triangle "));
  EXPECT_THAT(start_error(text), HasSubstr("; move them apart with 'translate', or look at them: "));
  Frame faults;
  EXPECT_THROW(build_scene(read_scene_text(text, "a.toml"), shipped_energies(), real_kernels,
                           [&](const Frame& frame) { faults = frame; }),
               SourceError);
  EXPECT_EQ(faults.cells.size(), 2u);  // edges and triangles
  EXPECT_GT(faults.x.cols(), 4);
}

TEST(Contact, FixedStiffnessOfABarrierThatIsFiniteAtContactIsRefused) {
  EXPECT_EQ(
      start_error(settings("[0, 0, 0]", 0.01, 1, "barrier = \"cubic_barrier\"\nstiffness = 1e6\n") + block("one", "")),
      "a.toml:7:11: contact: the barrier's force at a gap of 1e-09 dhat is 0.002 N per unit of its stiffness and "
      "does not grow towards contact, so that a fixed stiffness keeps nothing apart; leave 'stiffness' out, or "
      "use a barrier that is infinite there, as log_barrier");
}

class ContactBarrier : public testing::TestWithParam<const char*> {
 protected:
  static std::string barrier() {
    const std::string param = GetParam();
    const std::string law = param.substr(0, param.find(' '));
    return "barrier = \"" + law + "\"\n" + (law == param ? "" : "area_weights = true\n");
  }
};
INSTANTIATE_TEST_SUITE_P(laws, ContactBarrier,
                         testing::Values("log_barrier", "squared_log_barrier", "cubic_barrier", "log_barrier by area"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

TEST_P(ContactBarrier, KeepsBlocksThatMeetApart) {
  const FinishedScene run =
      finish_text(settings("[0, 0, 0]", 0.01, 30, barrier()) + block("left", "velocity = [3, 0, 0]\n") +
                  block("right", "translate = [0.15, 0.03, 0.02]\nrotate = [0.1, 0.2, 0.3]\n"));
  EXPECT_EQ(run.summary.failure, "");
  EXPECT_EQ(run.summary.unconverged_steps, 0);
  EXPECT_LT(run.summary.smallest_gap, 1e-3);  // they met
  const Eigen::Vector3d momentum = run.end.v * run.built.mass;
  EXPECT_LT((momentum - Eigen::Vector3d(3, 0, 0)).norm(), 3e-3);
  EXPECT_GT(mean(run.end.v, 27, 27)[0], 1.2);
}

TEST_P(ContactBarrier, HoldsABlockUnderAWeight) {
  const FinishedScene run = finish_text(
      settings("[0, 0, -9.81]", 0.02, 30, barrier() + "mu = 0.5\n") + block("lower", "translate = [0, 0, 0.0008]\n") +
      block("upper", "translate = [0.01, 0.02, 0.1016]\nrotate = [0, 0, 0.1]\n") +
      "[[obstacle]]\nname = \"plate\"\nbox = { size = [0.3, 0.3, 0.02], cells = [2, 2, 1] }\n"
      "translate = [-0.1, -0.1, -0.02]\n");
  EXPECT_EQ(run.summary.failure, "");
  EXPECT_EQ(run.summary.unconverged_steps, 0);
  EXPECT_GT(run.summary.smallest_gap, 0);
  EXPECT_LT(run.summary.smallest_gap, 1e-3);
  const double height = mean(run.end.x, 27, 27)[2];  // of the upper block's middle, less what both are squeezed by
  EXPECT_LT(height, 0.1516);
  EXPECT_GT(height, 0.135);
}

TEST(Contact, StartCloserThanOffsetsNamesTheVertices) {
  const std::string text = settings("[0, 0, 0]", 0.01, 1) + block("one", "offset = 0.01\n") +
                           block("two", "translate = [0.115, 0, 0]\noffset = 0.01\n");
  EXPECT_THAT(start_error(text), HasSubstr(" are closer than their offsets near ["));
}

}  // namespace
}  // namespace ergon
