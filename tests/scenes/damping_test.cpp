// Rayleigh damping of a scene: by mass, and by the stiffness of a law that is named.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/scenes/finish_scene.h"

namespace ergon {
namespace {

// Two points on a spring along x, of which one follows a script.
std::string pulled(const std::string& laws) {
  return R"(
gravity = [0, 0, 0]
[time]
dt = 0.01
steps = 20
[solver]
tolerance = 1e-9
[[object]]
name = "spring"
element = "edge2"
box = { size = [1, 1, 1], cells = [1, 1, 1] }
density = 2
cross_section = 1
scripted = [{ max = [0, inf, inf], key = [{ time = 0.2, translate = [-0.3, 0, 0] }] }]
energy = [)" +
         laws + "]\n";
}

// On a line, where a spring's stiffness does not change, that is a dashpot beside it.
TEST(damping, by_stiffness_of_a_spring_is_a_dashpot_beside_it) {
  const FinishedScene dashpot = finish_text(pulled("{ law = \"spring\", k = 100 }, { law = \"damper\", c = 5 }"));
  const FinishedScene named = finish_text(pulled("{ law = \"spring\", k = 100, stiffness_damping = \"50 ms\" }"));
  const FinishedScene none = finish_text(pulled("{ law = \"spring\", k = 100 }"));
  ASSERT_EQ(named.summary.failure, "");
  EXPECT_LT((named.end.x - dashpot.end.x).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_GT((named.end.x - none.end.x).cwiseAbs().maxCoeff(), 1e-2);
}

// The fundamental vibration along a bar that is held at one end: a clamped column of linear elements of equal length
// has the exact shape sin(pi x/(2 L)) with lumped masses, and a frequency of 2 c/h sin(pi h/(4 L)), c^2 = E/rho.
TEST(damping, by_mass_and_stiffness_gives_a_bar_the_ratio_of_rayleigh) {
  const double alpha = 3, beta = 2e-4, E = 1e5, rho = 1000, length = 1;
  const int cells = 8, steps = 400;
  BuiltScene built = build_text(R"(
gravity = [0, 0, 0]
[time]
dt = 1e-3
steps = 400
integrator = "newmark"
[solver]
tolerance = 1e-9
[[object]]
name = "bar"
element = "hex8"
box = { size = [1, 0.1, 0.1], cells = [8, 1, 1] }
density = 1000
mass_damping = 3
fixed = [{ max = [1e-9, inf, inf] }]
energy = [{ law = "linear_elasticity", E = 1e5, nu = 0, stiffness_damping = 2e-4 }]
)");
  State state = built.start;
  const Eigen::Matrix3Xd X = state.x;
  for (int v = 0; v < X.cols(); ++v) state.x(0, v) += 1e-3 * std::sin(std::numbers::pi / 2 * X(0, v) / length);
  TimeStepper stepper = stepper_of(built);
  Eigen::Index tip = 0;
  X.row(0).maxCoeff(&tip);
  const double h = length / cells, w = 2 * std::sqrt(E / rho) / h * std::sin(std::numbers::pi * h / (4 * length));
  const double zeta = alpha / (2 * w) + beta * w / 2, wd = w * std::sqrt(1 - zeta * zeta);
  double largest = 0;
  for (int i = 1; i <= steps; ++i) {
    const StepRecord record = stepper.step(state);
    ASSERT_TRUE(record.converged) << record.reason;
    EXPECT_GT(record.budget.damping, 0);
    EXPECT_NEAR(record.budget.residual, 0, 1e-9);
    const double t = state.time,
                 exact = 1e-3 * std::exp(-zeta * w * t) * (std::cos(wd * t) + zeta * w / wd * std::sin(wd * t));
    largest = std::max(largest, std::abs(state.x(0, tip) - X(0, tip) - exact));
  }
  EXPECT_GT(zeta, 0.09);
  EXPECT_LT(largest, 1e-6);
}

// An affine body has mass alone to damp it: x' = -rate*x by implicit Euler.
TEST(damping, by_mass_slows_affine_bodies) {
  const FinishedScene scene = finish_text(R"(
gravity = [0, 0, 0]
[time]
integrator = "implicit_euler"
dt = 0.01
steps = 10
[solver]
tolerance = 1e-9
[[object]]
name = "box"
box = { size = [0.1, 0.1, 0.1], cells = [1, 1, 1] }
density = 1000
kinematics = "affine"
velocity = [1, 2, 3]
mass_damping = "5 Hz"
)");
  EXPECT_NEAR(scene.end.v(1, scene.built.bodies[0].first_control), 2 * std::pow(1.05, -10), 1e-9);
}

TEST(damping, is_left_out_of_equilibria) {
  const FinishedScene scene = finish_text(R"(
[time]
dt = 0.5
steps = 2
integrator = "quasi_static"
[[object]]
name = "box"
box = { size = [0.1, 0.1, 0.1], cells = [1, 1, 1] }
element = "tet4"
density = 1000
mass_damping = 5
fixed = [{ max = [1e-9, inf, inf] }]
energy = [{ law = "neo_hookean", E = 1e6, nu = 0.3, stiffness_damping = 1 }]
)");
  ASSERT_EQ(scene.summary.failure, "");
  EXPECT_EQ(scene.built.skipped.front(), "inertia: a quasi-static scene has none");
  EXPECT_NE(
      std::find(scene.built.skipped.begin(), scene.built.skipped.end(), "mass damping: a quasi-static scene has none"),
      scene.built.skipped.end());
}

}  // namespace
}  // namespace ergon
