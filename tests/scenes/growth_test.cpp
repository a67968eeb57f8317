// Bodies that heat or moisture makes larger, and muscle that contracts: what has no stress is known exactly.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/scenes/finish_scene.h"

namespace ergon {
namespace {

std::string scene(const std::string& object) {
  return R"(
gravity = [0, 0, 0]
[time]
dt = 1
steps = 1
integrator = "quasi_static"
[solver]
tolerance = 1e-12
)" + object;
}

// Free expansion keeps the shape: every length grows by 1 + alpha*dT, and no stress is left.
TEST(growth, a_free_solid_expands_without_stress) {
  const FinishedScene end = finish_text(scene(R"(
[[object]]
name = "block"
element = "tet10"
box = { size = [0.2, 0.1, 0.1], cells = [2, 1, 1] }
density = 1000
fixed = [{ max = [0, inf, inf], axes = "x" }, { max = [inf, 0, inf], axes = "y" }, { max = [inf, inf, 0], axes = "z" }]
energy = [{ law = "thermal_neo_hookean", E = 1e6, nu = 0.3, alpha = 1e-3, dT = { formula = "heat*t/T", heat = "200 K", T = "1 s" } }]
)"));
  ASSERT_EQ(end.summary.failure, "");
  EXPECT_LT((end.end.x - 1.2 * end.built.start.x).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_NEAR(end.summary.end_energy, 0, 1e-12);
}

TEST(growth, a_free_membrane_grows_without_stress) {
  const FinishedScene end = finish_text(scene(R"(
[[object]]
name = "sheet"
element = "tri3"
box = { size = [0.2, 0.1, 0.1], cells = [4, 2, 1] }
density = 1000
thickness = 1e-3
fixed = [{ max = [0, inf, inf], axes = "x" }, { max = [inf, 0, inf], axes = "y" }, { axes = "z" }]
energy = [{ law = "growing_membrane", E = 1e6, nu = 0.3, growth = 1.3 }]
)"));
  ASSERT_EQ(end.summary.failure, "");
  EXPECT_LT((end.end.x - 1.3 * end.built.start.x).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_NEAR(end.summary.end_energy, 0, 1e-12);
}

// A strip of two layers of equal thickness and stiffness, of which one expands: its curvature is 3/2*alpha*dT/h.
// Timoshenko 1925, Analysis of Bi-Metal Thermostats, J. Opt. Soc. Am. 11; the deflection of the end of a cantilever,
// 3 L^2/(4 h)*alpha*dT, is verification E.15 of Hyfeast.
TEST(growth, a_strip_of_two_layers_bends_as_timoshenko_says) {
  const double length = 1, h = 0.1, strain = 1e-4;
  const FinishedScene end = finish_text(scene(R"(
[[object]]
name = "strip"
element = "hex27"
box = { size = [1, 0.1, 0.1], cells = [8, 1, 2] }
density = 1000
fixed = [{ max = [0, inf, inf], axes = "x" }, { max = [inf, 0, inf], axes = "y" }, { max = [0, inf, 0], axes = "z" }]
region = [{ name = "lower", max = [inf, inf, 0.05] }]
energy = [{ law = "thermal_neo_hookean", E = 1e6, nu = 0, alpha = 1e-5, dT = { regions = { lower = "10 K", otherwise = "0 K" } } }]
)"));
  ASSERT_EQ(end.summary.failure, "");
  const Eigen::Matrix3Xd& X = end.built.start.x;
  double deflection = 0;
  for (int v = 0; v < X.cols(); ++v)
    if (X(0, v) > length - 1e-9 && X(2, v) < 1e-9) deflection = end.end.x(2, v);
  EXPECT_NEAR(deflection, 3 * length * length / (4 * h) * strain, 0.01 * deflection);
}

// A free sheet of 0.2 m by 0.1 m, held by as little as is needed, with one law of bending beside its membrane. Where
// its natural curvature is small and alike in all directions it becomes the paraboloid of that curvature, which a flat
// membrane does not resist: the curvature that fits its vertices best, and the largest distance from it over the
// height.
struct Curled {
  double curvature = 0, misfit = 0;
};

Curled curled(const std::string& bending, double growth, const std::string& element_keys) {
  const FinishedScene end = finish_text(scene(R"(
[[object]]
name = "sheet"
element = "tri3"
box = { size = [0.2, 0.1, 0.1], )" + element_keys +
                                              R"( }
density = 1000
thickness = 0.01
fixed = [{ max = [0, 0, inf] }, { min = [0.2, -inf, -inf], max = [inf, 0, inf], axes = "yz" }, { min = [-inf, 0.1, -inf], max = [0, inf, inf], axes = "z" }]
energy = [{ law = "growing_membrane", E = 1e6, nu = 0.3, growth = )" +
                                              fmt::format("{:.17g}", growth) + " },\n          " + bending + "]\n"));
  EXPECT_EQ(end.summary.failure, "");
  const Eigen::Matrix3Xd& X = end.built.start.x;
  double fit = 0, squares = 0, misfit = 0, height = 0;
  const auto bulge = [&](int v) { return (X(0, v) * (0.2 - X(0, v)) + X(1, v) * (0.1 - X(1, v))) / 2; };
  const int vertices = end.built.bodies[0].mesh.vertices();  // behind them are tips of normals
  for (int v = 0; v < vertices; ++v) {
    fit += bulge(v) * end.end.x(2, v);
    squares += bulge(v) * bulge(v);
  }
  const double curvature = fit / squares;
  for (int v = 0; v < vertices; ++v) {
    misfit = std::max(misfit, std::abs(end.end.x(2, v) - curvature * bulge(v)));
    height = std::max(height, std::abs(end.end.x(2, v)));
  }
  return {curvature, misfit / height};
}

// Of two layers, m the ratio of their thicknesses h1/h2 and n that of their moduli, h the sum of the thicknesses:
// 6*(growth1 - growth2)*(1 + m)^2/(h*(3*(1 + m)^2 + (1 + m*n)*(m^2 + 1/(m*n)))). Timoshenko 1925, Analysis of Bi-Metal
// Thermostats, J. Opt. Soc. Am. 11.
TEST(growth, shells_of_two_layers_curl_as_timoshenko_says) {
  for (const auto& [m, n] : {std::pair(1.0, 1.0), std::pair(0.25, 8.0), std::pair(3.0, 0.2)}) {
    const double h = 0.01, h2 = h / (1 + m), h1 = h - h2, growth1 = 1 + 3e-5, growth2 = 1 - 2e-5;
    const double expected = 6 * (growth1 - growth2) * (1 + m) * (1 + m) /
                            (h * (3 * (1 + m) * (1 + m) + (1 + m * n) * (m * m + 1 / (m * n))));
    const double mean = (n * h1 * growth1 + h2 * growth2) / (n * h1 + h2);
    const std::string law = fmt::format(
        "{{ law = \"bilayer_bending\", E1 = {:.17g}, E2 = 1e6, nu = 0.3, h1 = {:.17g}, h2 = {:.17g}, growth1 = "
        "{:.17g}, "
        "growth2 = {:.17g} }}",
        n * 1e6, h1, h2, growth1, growth2);
    const Curled found = curled(law, mean, "cells = [16, 8, 1]");
    EXPECT_NEAR(found.curvature, expected, 2e-5 * expected) << m << " " << n;
    EXPECT_LT(found.misfit, 1e-6);
  }
}

// One cell wide, so that nothing hinders it, a strip rolls up by two radians: an arc of Timoshenko's curvature over the
// mean growth of its length. Cells are straight: the error goes with the square of their length.
double curvature_of_strip(int cells) {
  const FinishedScene end = finish_text(std::string(R"toml(
gravity = [0, 0, 0]
[time]
dt = 0.1
end = 1
integrator = "quasi_static"
[solver]
tolerance = 1e-9
[[object]]
name = "strip"
element = "tri3"
box = { size = [0.2, 0.01, 0.1], )toml") +
                                        fmt::format("cells = [{}, 1, 1]", cells) + R"toml( }
density = 1000
thickness = 1e-3
fixed = [{ max = [0.0101, inf, inf] }]
[[object.energy]]
law = "growing_membrane"
E = 1e6
nu = 0
growth = { formula = "1 + t/(300*T)", T = "1 s" }
[[object.energy]]
law = "bilayer_bending"
E1 = 1e6
E2 = 1e6
nu = 0
h1 = 0.5e-3
h2 = 0.5e-3
growth1 = { formula = "1 + t/(150*T)", T = "1 s" }
growth2 = 1
)toml");
  EXPECT_EQ(end.summary.failure, "");
  const Eigen::Matrix3Xd& X = end.built.start.x;
  const auto at = [&](double x) {
    int nearest = 0;
    for (int v = 1; v < X.cols(); ++v)
      if ((X.col(v) - Eigen::Vector3d(x, 0, 0)).norm() < (X.col(nearest) - Eigen::Vector3d(x, 0, 0)).norm())
        nearest = v;
    return Eigen::Vector3d(end.end.x.col(nearest));
  };
  const Eigen::Vector3d a = at(0.02), b = at(0.1), c = at(0.2);
  const double curvature = 2 * (b - a).cross(c - a).norm() / ((b - a).norm() * (c - b).norm() * (c - a).norm());
  EXPECT_GT((c - a).norm() * curvature, 1.5) << "far from small rotations";
  return curvature;
}

TEST(growth, a_strip_of_two_layers_rolls_up_to_an_arc) {
  const double difference = 1.0 / 150;
  const double expected = 1.5 * difference / 1e-3 / (1 + difference / 2);
  const double coarse = curvature_of_strip(20) / expected - 1, fine = curvature_of_strip(40) / expected - 1;
  EXPECT_NEAR(coarse, 0, 5e-4);
  EXPECT_NEAR(fine, coarse / 4, 0.1 * std::abs(fine));
}

TEST(growth, hinges_curl_as_far_as_their_curvature_says) {
  const Curled found =
      curled("{ law = \"curled_hinge\", k = 1, curvature = { formula = \"c*t/T\", c = \"1e-3 m^-1\", T = \"1 s\" } }",
             1, "cells = [12, 5, 1]");
  EXPECT_NEAR(found.curvature, 1e-3, 1e-10);
  EXPECT_LT(found.misfit, 1e-6);
}

// Fibres along x that are active by a table in time: the block shortens until E/2*stretch*(stretch^2 - 1) + activation*
// tension = 0, the nominal stress of St. Venant-Kirchhoff without lateral contraction and that of muscle.
TEST(growth, muscle_contracts_as_its_activation_in_time_says) {
  BuiltScene built = build_text(scene(R"toml(
[[object]]
name = "muscle"
element = "hex8"
box = { size = [0.2, 0.1, 0.1], cells = [2, 1, 1] }
density = 1000
fixed = [{ max = [0, inf, inf], axes = "x" }, { max = [inf, 0, inf], axes = "y" }, { max = [inf, inf, 0], axes = "z" }]
[[object.energy]]
law = "st_venant_kirchhoff"
E = "100 kPa"
nu = 0
[[object.energy]]
law = "muscle"
tension = "10 kPa"
a = [1, 0, 0]
activation = { formula = "spline(t/T, [0, 1, 2, 3], [0, 1, 0.5, 0])", T = "1 s" }
)toml"));
  TimeStepper stepper = stepper_of(built);
  State state = built.start;
  for (const double activation : {1.0, 0.5, 0.0}) {
    const StepRecord record = stepper.step(state);
    ASSERT_TRUE(record.converged) << record.reason;
    double low = 0.7, high = 1.1;
    for (int i = 0; i < 60; ++i) {
      const double stretch = (low + high) / 2;
      (1e5 / 2 * stretch * (stretch * stretch - 1) + activation * 1e4 < 0 ? low : high) = stretch;
    }
    EXPECT_NEAR(state.x.row(0).maxCoeff(), 0.2 * high, 1e-10) << activation;
    EXPECT_NEAR(state.x.row(1).maxCoeff(), 0.1, 1e-10);
  }
}

}  // namespace
}  // namespace ergon
