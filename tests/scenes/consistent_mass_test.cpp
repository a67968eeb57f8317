// Scenes whose masses are consistent: what is conserved, where energy goes, and what boundaries pull.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/scenes/finish_scene.h"

namespace ergon {
namespace {

std::string block(const std::string& time, const std::string& object, const std::string& gravity = "[0, 0, 0]") {
  return "gravity = " + gravity + "\n[time]\n" + time +
         "\n[solver]\ntolerance = 1e-9\n[[object]]\nname = \"block\"\nbox = { size = [0.4, 0.1, 0.1], cells = [2, 1, "
         "1] }\ndensity = 1000\nenergy = [{ law = \"neo_hookean\", E = 1e5, nu = 0.3 }]\n" +
         object;
}

TEST(consistent_masses, follow_the_element_unless_the_scene_says) {
  const auto coupled = [](const std::string& object) {
    return !build_text(block("dt = 0.01\nsteps = 1", object)).coupled_mass.empty();
  };
  EXPECT_TRUE(coupled("element = \"tet10\""));
  EXPECT_TRUE(coupled("element = \"hex20\""));
  EXPECT_FALSE(coupled("element = \"hex27\""));
  EXPECT_FALSE(coupled("element = \"tet4\""));
  EXPECT_FALSE(coupled("element = \"tet10\"\nmass = \"lumped\""));
  EXPECT_TRUE(coupled("element = \"hex8\"\nmass = \"consistent\""));
}

// Weight and inertia are in proportion.
TEST(consistent_masses, fall_without_strain) {
  const FinishedScene fallen =
      finish_text(block("dt = 0.01\nsteps = 10\nintegrator = \"newmark\"", "element = \"tet10\"", "[0, 0, -9.81]"));
  EXPECT_NEAR((fallen.end.x - fallen.built.start.x).row(2).minCoeff(), -9.81 * 0.01 / 2, 1e-9);
  EXPECT_NEAR((fallen.end.x - fallen.built.start.x).row(2).maxCoeff(), -9.81 * 0.01 / 2, 1e-9);
}

TEST(consistent_masses, spin_with_the_energy_and_momentum_of_the_solid) {
  for (const char* element : {"tet10", "hex20"}) {
    BuiltScene built = build_text(
        block("dt = 0.002\nsteps = 20\nintegrator = \"midpoint\"", std::string("element = \"") + element + "\""));
    const Eigen::Vector3d w(2, 3, -5), centre(0.2, 0.05, 0.05), size(0.4, 0.1, 0.1);
    for (int v = 0; v < built.start.x.cols(); ++v)
      built.start.v.col(v) = w.cross(Eigen::Vector3d(built.start.x.col(v) - centre));
    const double mass = 4;
    const Eigen::Vector3d inertia =
        mass / 12 * (size.squaredNorm() * Eigen::Vector3d::Ones() - Eigen::Vector3d(size.cwiseAbs2()));
    TimeStepper stepper = stepper_of(built);
    State state = built.start;
    const Energies start = stepper.energies(state);
    EXPECT_NEAR(start.kinetic, w.dot(inertia.cwiseProduct(w)) / 2, 1e-12) << element;
    const Eigen::Vector3d L = inertia.cwiseProduct(w);
    for (int i = 0; i < 20; ++i) {
      const StepRecord record = stepper.step(state);
      ASSERT_TRUE(record.converged) << element << ": " << record.reason;
      EXPECT_LT(record.momentum.linear.norm(), 1e-8) << element;
      EXPECT_LT((record.momentum.angular - L).norm(), 1e-6 * L.norm()) << element;
      EXPECT_NEAR(record.energy.total, start.total, 1e-3 * start.total) << element;
      EXPECT_LT(std::abs(record.budget.residual), 1e-7 * start.total) << element;
    }
  }
}

// Every integrator, with an end that is moved, damping by mass, and accelerations at the start.
TEST(consistent_masses, close_the_budget_under_scripts_and_damping) {
  for (const char* integrator :
       {"implicit_euler", "bdf2", "newmark", "generalised_alpha", "midpoint", "sdirk2", "tr_bdf2"}) {
    BuiltScene built = build_text(block(std::string("dt = 0.01\nsteps = 12\nintegrator = \"") + integrator + "\"",
                                        "element = \"tet10\"\nmass_damping = 4\n[[object.scripted]]\nmax = [0, inf, "
                                        "inf]\n[[object.scripted.key]]\ntime = 0.1\ntranslate = [0, 0.02, 0]\n",
                                        "[0, 0, -9.81]"));
    TimeStepper stepper = stepper_of(built);
    State state = built.start;
    double scale = 0, damped = 0, pulled = 0;
    for (int i = 0; i < 12; ++i) {
      const StepRecord record = stepper.step(state);
      ASSERT_TRUE(record.converged) << integrator << ": " << record.reason;
      scale = std::max(scale, record.energy.kinetic);
      damped += record.budget.damping;
      pulled += record.budget.script;
      EXPECT_LT(std::abs(record.budget.residual), 1e-6 * std::max(scale, 1e-3)) << integrator << " step " << i;
    }
    EXPECT_GT(damped, 1e-4) << integrator;
    EXPECT_GT(pulled, 1e-4) << integrator;
  }
}

// A stiff block whose end is driven moves with it; the force on the end is what all of its mass needs, so that the sum
// of impulses is the momentum.
TEST(consistent_masses, are_carried_along_by_what_is_scripted) {
  for (const char* mass : {"lumped", "consistent"}) {
    const FinishedScene run = finish_text(
        block("dt = 0.01\nsteps = 20", std::string("element = \"tet10\"\nmass = \"") + mass +
                                           "\"\n[[object.scripted]]\nmax = [0.15, inf, inf]\n[[object.scripted."
                                           "key]]\ntime = 0.2\ntranslate = [0.2, 0, 0]\n"));
    ASSERT_EQ(run.summary.failure, "");
    const Eigen::VectorXd shares = run.built.mass_shares();
    EXPECT_NEAR(shares.sum(), 4, 1e-12);
    const Eigen::Vector3d centre = (run.end.x - run.built.start.x) * shares / 4;
    EXPECT_NEAR(centre[0], 0.2, 0.01) << mass;
  }
}

TEST(consistent_masses, have_no_use_where_mass_is_known_otherwise) {
  const auto message = [](const std::string& text) {
    try {
      build_text(text);
    } catch (const SourceError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(message("[time]\ndt = 0.01\nsteps = 1\n[[object]]\nname = \"p\"\npoints = [[0, 0, 0]]\nvolume = "
                      "1\ndensity = 1\nmass = \"lumped\"\nenergy = [{ text = '''\nenergy e point\ndof x m\nparam k "
                      "J/m^2\nvalue k*norm2(x)\n''', k = 1 }]\n"),
              testing::HasSubstr("'mass' has no use here: loose points have each its own"));
  EXPECT_THAT(message("[time]\ndt = 0.01\nsteps = 1\n[[object]]\nname = \"p\"\nkinematics = \"affine\"\nbox = { size = "
                      "[1, 1, 1], cells = [1, 1, 1] }\ndensity = 1\nmass = \"consistent\"\n"),
              testing::HasSubstr("'mass' has no use for an affine body: its mass is that within the surface, exactly"));
}

}  // namespace
}  // namespace ergon
