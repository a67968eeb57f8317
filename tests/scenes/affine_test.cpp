// Affine bodies from a scene's text to their motion, against closed forms.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "scenes/frames.h"
#include "tests/scenes/finish_scene.h"

namespace ergon {
namespace {

std::string box(const std::string& name, const std::string& keys) {
  return "[[object]]\nname = \"" + name + "\"\nkinematics = \"affine\"\n" +
         "box = { size = [0.1, 0.1, 0.05], cells = [1, 1, 1] }\ndensity = 1000\n" + keys;
}

std::string settings(const std::string& gravity, double dt, int steps) {
  return "gravity = " + gravity + "\n[time]\nintegrator = \"implicit_euler\"\ndt = " + std::to_string(dt) +
         "\nsteps = " + std::to_string(steps) + "\n";
}

Eigen::Vector3d mean(const Eigen::Matrix3Xd& x, const Body& body) {
  return x.middleCols(body.first_vertex, body.ordered.vertices()).rowwise().mean();
}

TEST(Affine, ABodyFallsAsImplicitEulerSays) {
  const double g = 9.81, dt = 0.01;
  const int n = 20;
  const FinishedScene fall =
      finish_text(settings("[0, 0, -9.81]", dt, n) +
                  "[[object]]\nname = \"ball\"\nkinematics = \"affine\"\nsphere = { radius = 0.1, cuts = 3 }\n"
                  "density = 500\nvelocity = [1, 0, 2]\n");
  ASSERT_EQ(fall.summary.failure, "");
  const Eigen::Vector3d moved(n * dt, 0, 2 * n * dt - g * dt * dt * n * (n + 1) / 2);
  for (int v = 0; v < fall.built.bodies[0].ordered.vertices(); ++v)
    EXPECT_LT((fall.end.x.col(v) - fall.built.start.x.col(v) - moved).norm(), 1e-9) << v;
  // The mass is that of the faceted ball, all of it at the control points.
  const SolidMoments& moments = *fall.built.bodies[0].moments;
  EXPECT_NEAR(fall.built.mass.sum(), 500 * moments.volume, 1e-12);
  EXPECT_EQ(fall.built.mass.head(fall.built.bodies[0].ordered.vertices()).sum(), 0);
  // Frames hold the surface, not the control points.
  EXPECT_EQ(fall.summary.vertices, fall.built.bodies[0].ordered.vertices());
  EXPECT_EQ(frame_of(fall.built.bodies, fall.end).x.cols(), fall.summary.vertices);
}

// About an axis of symmetry implicit Euler turns a rigid body by angles with tan(next) = sin(angle)/(2 - cos(angle)).
TEST(Affine, AFreeBodyTurnsAsImplicitEulerSays) {
  for (const auto& [dt, rate] : {std::pair(0.01, 20.0), std::pair(1e-3, 5.0)}) {
    const Scene scene = read_scene_text(settings("[0, 0, 0]", dt, 10) + "[solver]\ntolerance = 1e-7\n" +
                                            box("box", "stiffness = 1e10\nrotate = [0.3, 0.4, 0.5]\n"),
                                        "a.toml");
    BuiltScene built = build_scene(scene, shipped_energies(), real_kernels);
    const Body& body = built.bodies[0];
    const Eigen::Vector3d center = body.moments->center;
    const Eigen::Matrix3d R =
        (Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    const Eigen::Vector3d axis = R.col(2);
    // The velocity at the start is that of the step before it, so that the first angle is the first of the recurrence.
    double angle = rate * dt;
    const Eigen::Matrix3d back = Eigen::AngleAxisd(-angle, axis).toRotationMatrix();
    for (int v = 0; v < built.start.x.cols(); ++v) {
      const Eigen::Vector3d arm = built.start.x.col(v) - center;
      built.start.v.col(v) = (arm - back * arm) / dt;
    }
    const Eigen::Vector3d first = built.start.x.col(0) - center;
    const FinishedScene turn = finish(scene, std::move(built));
    ASSERT_EQ(turn.summary.failure, "");
    double turned = 0;
    for (int step = 0; step < 10; ++step) {
      angle = std::atan(std::sin(angle) / (2 - std::cos(angle)));
      turned += angle;
    }
    const Eigen::Vector3d expected = Eigen::AngleAxisd(turned, axis) * first;
    EXPECT_LT((turn.end.x.col(0) - center - expected).norm(), 2e-4 * turned * first.norm()) << dt;
    // A torque-free body keeps its rate up to the integrator's loss, (angle)^2 a step.
    EXPECT_NEAR(angle / (rate * dt), 1, 11 * std::pow(rate * dt, 2));
  }
}

TEST(Affine, BodiesThatMeetKeepTheirMomentumAndDoNotPassThrough) {
  const FinishedScene run =
      finish_text(settings("[0, 0, 0]", 0.01, 30) + "[contact]\n" + box("left", "velocity = [1, 0, 0]\n") +
                  box("right", "translate = [0.15, 0.03, 0.02]\nrotate = [0.1, 0.2, 0.3]\n"));
  ASSERT_EQ(run.summary.failure, "");
  EXPECT_GT(run.summary.smallest_gap, 0);
  EXPECT_LT(run.summary.smallest_gap, 1e-3);  // they met
  EXPECT_LE(run.summary.max_energy_rise, 1e-6 * run.summary.start_energy);
  // 0.5 kg at 1 m/s; each step is solved to 1e-4 m/s.
  const Eigen::Vector3d momentum = run.end.v * run.built.mass;
  EXPECT_LT((momentum - Eigen::Vector3d(0.5, 0, 0)).norm(), 1e-3);
  EXPECT_GT(mean(run.end.v, run.built.bodies[1])[0], 0.2);
}

TEST(Affine, ABoxRestsWithItsWeightOnTheGround) {
  const FinishedScene run = finish_text(settings("[0, 0, -9.81]", 0.01, 60) + "[[ground]]\nmu = 0.3\n" +
                                        box("box", "translate = [0, 0, 0.02]\nrotate = [0.1, 0.05, 0]\n"));
  ASSERT_EQ(run.summary.failure, "");
  EXPECT_LT(run.summary.largest_speed, 1e-2);
  double force = 0;
  for (const GroundContact::Force& f : run.built.ground->forces(run.end.x)) force += f.newton;
  EXPECT_NEAR(force, 0.5 * 9.81, 0.01 * 0.5 * 9.81);
  EXPECT_LT(run.end.x.row(2).head(8).maxCoeff(), 0.0515);
}

// It starts to tip forward, and after that slides with g (sin - mu cos).
TEST(Affine, ABoxOnASlopeStaysOrSlidesAsCoulombSays) {
  const auto slide = [](double mu, int steps) {
    return finish_text(settings("[4.38717, 0, -8.77433]", 0.01, steps) +
                       "[solver]\nfriction_iterations = 10\nfriction_tolerance = 1e-3\n[contact]\nmu = " +
                       std::to_string(mu) + "\n" + box("box", "rotate = [0, 0, 0.2]\ntranslate = [0, 0, 0.000353]\n") +
                       "[[obstacle]]\nname = \"slope\"\nbox = { size = [2, 1, 0.1], cells = [4, 2, 1] }\n"
                       "translate = [-0.5, -0.4, -0.1]\n");
  };
  const auto speed = [](const FinishedScene& run) { return mean(run.end.v, run.built.bodies[0])[0]; };
  const FinishedScene stays = slide(0.6, 50), early = slide(0.3, 20), late = slide(0.3, 50);
  for (const FinishedScene* run : {&stays, &early, &late}) ASSERT_EQ(run->summary.failure, "");
  EXPECT_LT((mean(stays.end.x, stays.built.bodies[0]) - mean(stays.built.start.x, stays.built.bodies[0])).norm(), 1e-3);
  EXPECT_LT(std::abs(speed(stays)), 1e-3);  // epsv
  const double expected = 9.81 * (0.4472136 - 0.3 * 0.8944272);
  EXPECT_NEAR((speed(late) - speed(early)) / 0.3, expected, 0.002 * expected);
}

TEST(Affine, BodiesThatAreHeldHaveNoDegreesOfFreedom) {
  const BuiltScene built = build_text(settings("[0, 0, -9.81]", 0.01, 1) + "[contact]\n" +
                                      box("held", "fixed = [{}]\n") + box("loose", "translate = [0, 0, 1]\n"));
  EXPECT_FALSE(built.bodies[0].affine());
  EXPECT_TRUE(built.bodies[1].affine());
  EXPECT_EQ(built.system->free_vertices(), 4);
  EXPECT_EQ(built.system->vertices(), 8 + 8 + 4);
  for (int v = 0; v < 8; ++v) EXPECT_FALSE(built.system->moves(v));
  for (int v = 8; v < 20; ++v) EXPECT_TRUE(built.system->moves(v));
  EXPECT_EQ(built.system->block_of(8), -1);
}

TEST(Affine, AScriptedBodyPushesAffineAndSoftOnes) {
  const FinishedScene run = finish_text(
      settings("[0, 0, -9.81]", 0.01, 40) + "[contact]\n[[ground]]\n" +
      box("pusher", "translate = [0, 0, 0.01]\nscripted = [{ key = [{ time = 0.4, translate = [0.2, 0, 0] }] }]\n") +
      box("pushed", "translate = [0.11, 0, 0.001]\n") +
      "[[object]]\nname = \"soft\"\nbox = { size = [0.1, 0.1, 0.1], cells = [2, 2, 2] }\n"
      "translate = [0.23, 0, 0.001]\ndensity = 1000\n[[object.energy]]\nlaw = \"stable_neo_hookean\"\nE = 1e5\n"
      "nu = 0.3\n");
  ASSERT_EQ(run.summary.failure, "");
  const std::vector<Body>& bodies = run.built.bodies;
  EXPECT_NEAR(mean(run.end.x, bodies[0])[0], 0.05 + 0.2, 1e-9);
  EXPECT_GT(mean(run.end.x, bodies[1])[0], mean(run.end.x, bodies[0])[0] + 0.1);
  EXPECT_GT(mean(run.end.x, bodies[2])[0], mean(run.end.x, bodies[1])[0] + 0.09);
}

TEST(Affine, BodiesThatAreAlikeAreOnePotential) {
  const BuiltScene built = build_text(settings("[0, 0, -9.81]", 0.01, 1) + box("a", "translate = [0.3, 0, 0]\n") +
                                      box("b", "rotate = [0.1, 0.2, 0.3]\ntranslate = [0, 0, 1]\n") +
                                      box("c", "stiffness = \"1 GPa\"\ntranslate = [0, 0, 2]\n"));
  int orthogonality = 0;
  for (int i = 0; i < built.system->potential_count(); ++i)
    orthogonality += built.system->potential(i).name() == "affine_orthogonality";
  EXPECT_EQ(orthogonality, 2);
}

}  // namespace
}  // namespace ergon
