// Laws that remember: lags of densities, and what an energy renews itself at the end of a step.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "runtime/mesh/mesh_build.h"
#include "tests/scenes/finish_scene.h"

namespace ergon {
namespace {

Kernel kernel_named(const std::string& name) {
  const Energy energy = shipped_energies().read_complete(name, "", {});
  return real_kernels({{&energy, ""}})[0];
}

std::string wobbling(const std::string& damping, const std::string& element = "tet4") {
  return R"(
gravity = [0, 0, 0]
[time]
integrator = "implicit_euler"
dt = 0.01
steps = 8
[solver]
tolerance = 1e-9
[[object]]
name = "block"
box = { size = [0.2, 0.1, 0.1], cells = [2, 1, 1] }
element = ")" +
         element + R"("
density = 1000
velocity = [1, 0.5, 0]
fixed = [{ max = [1e-9, inf, inf] }]
energy = [{ law = "neo_hookean", E = "50 kPa", nu = 0.3 }, )" +
         damping + " ]\n";
}

// F at the start of the step, as the density sees it, is that of the stencil energy over the tetrahedron's points.
TEST(inelastic, viscosity_as_a_density_is_that_of_tetrahedra) {
  const FinishedScene density = finish_text(wobbling("{ law = \"kelvin_voigt\", eta = 100, zeta = 50 }"));
  const FinishedScene stencils = finish_text(wobbling("{ law = \"strain_rate\", eta = 100, zeta = 50 }"));
  const FinishedScene none = finish_text(wobbling("{ law = \"kelvin_voigt\", eta = 0, zeta = 0 }"));
  ASSERT_EQ(density.summary.failure, "");
  EXPECT_LT((density.end.x - stencils.end.x).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_GT((density.end.x - none.end.x).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(inelastic, viscosity_takes_energy_on_elements_with_several_points) {
  const FinishedScene none = finish_text(wobbling("{ law = \"kelvin_voigt\", eta = 0, zeta = 0 }", "hex8"));
  const FinishedScene some = finish_text(wobbling("{ law = \"kelvin_voigt\", eta = 100, zeta = 50 }", "hex8"));
  EXPECT_LT(some.summary.end_energy, 0.9 * none.summary.end_energy);
}

// A turn without strain is not resisted: Flag'Flag is the same before and after.
TEST(inelastic, viscosity_lets_rotations_be) {
  const Mesh solid = box_mesh(Element::hex8, {0.2, 0.1, 0.1}, {2, 1, 1});
  Potential potential = Potential::on_mesh("v", kernel_named("kelvin_voigt"), solid, 0, {{"eta", {1}}, {"zeta", {1}}});
  potential.set_lag("dt", {0.1});
  potential.set_lag("Flag", potential.deformation(solid.X));
  System system(solid.vertices());
  system.add(potential);
  const Eigen::Matrix3Xd turned =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix() * solid.X;
  EXPECT_LT(system.value(turned).value, 1e-28);
  EXPECT_GT(system.value(1.01 * solid.X).value, 1e-8);
}

// Held at a strain, the dashpot's part of it tends to all of it; with the factor tau/(tau + dt) per step, the limit of
// which is exp(-t/tau): stress relaxation of the standard linear solid. Whatever the integrator is, a law that renews
// itself lives through the whole step.
TEST(inelastic, stress_relaxes_in_a_standard_linear_solid) {
  const double dt = 1e5, tau = 3e5;
  for (const std::string integrator : {"implicit_euler", "bdf2", "sdirk2", "tr_bdf2"}) {
    BuiltScene built = build_text("gravity = [0, 0, 0]\n[time]\nintegrator = \"" + integrator + "\"" + R"(
dt = 1e5
steps = 5
[solver]
tolerance = 1e-13
[[object]]
name = "bar"
box = { size = [1, 0.1, 0.1], cells = [4, 1, 1] }
element = "hex8"
density = 1
fixed = [{ max = [1e-9, inf, inf] }]
scripted = [{ min = [0.999999, -inf, -inf], key = [{ time = 1e5, translate = [0.01, 0, 0] }, { time = 1e9, translate = [0.01, 0, 0] }] }]
energy = [{ law = "st_venant_kirchhoff", E = 1e5, nu = 0 }, { law = "maxwell_branch", mu = 1e5, tau = 3e5 }]
)");
    TimeStepper stepper(*built.system, built.mass, nullptr, built.step, built.script);
    State state = built.start;
    const double strain = (1.01 * 1.01 - 1) / 2;
    for (int step = 1; step <= 5; ++step) {
      const StepRecord record = stepper.step(state);
      ASSERT_TRUE(record.converged) << record.reason;
      const std::vector<double>& flow = state.internal.at(1).at("flow");
      ASSERT_EQ(flow.size(), 4u * 8u * 9u);
      const double expected = strain * (1 - std::pow(tau / (tau + dt), step));
      for (size_t point = 0; point < flow.size(); point += 9)
        EXPECT_NEAR(flow[point], expected, 1e-9) << integrator << step;
    }
  }
}

// One tetrahedron under F: nominal stress from the forces on its corners.
class MaterialPoint {
 public:
  MaterialPoint(const std::string& law, const Parameters& params) : system_(4) {
    mesh_.element = Element::tet4;
    mesh_.cells = {0, 1, 2, 3};
    mesh_.X.resize(3, 4);
    mesh_.X << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
    system_.add(Potential::on_mesh(law, kernel_named(law), mesh_, 0, params));
  }
  Potential& potential() { return system_.potential(0); }
  Eigen::Matrix3d stress(const Eigen::Matrix3d& F) {
    Eigen::Matrix3Xd gradient;
    system_.gradient(F * mesh_.X, gradient);
    return gradient * mesh_.X.transpose() * 6;
  }
  // Sides are free: their stretch is found by bisection.
  Eigen::Matrix3d pulled(double stretch) {
    double low = 0.5, high = 1.5;
    const auto F = [&](double side) { return Eigen::Vector3d(stretch, side, side).asDiagonal().toDenseMatrix(); };
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      (stress(F(middle))(1, 1) < 0 ? low : high) = middle;
    }
    return F((low + high) / 2);
  }
  void end_step(const Eigen::Matrix3d& F) {
    for (const auto& [name, values] : potential().renewed(F * mesh_.X)) potential().set_lag(name, values);
  }

 private:
  Mesh mesh_;
  System system_;
};

// The second Piola-Kirchhoff stress of a bar is that of von Mises: it grows with E up to the yield stress and stays
// there; unloading is elastic; what is left without stress is the plastic strain, which keeps the volume.
TEST(inelastic, a_bar_yields_at_the_stress_of_von_mises) {
  const double E = 2e11, yield = 2.5e8;
  MaterialPoint metal("von_mises", {{"E", {E}}, {"nu", {0.3}}, {"yield", {yield}}});
  metal.potential().set_lag("plastic", std::vector<double>(9, 0.0));
  const auto strain = [](double stretch) { return (stretch * stretch - 1) / 2; };
  const double limit = std::sqrt(1 + 2 * yield / E);
  for (const double part : {0.25, 0.5, 0.999}) {
    const double stretch = 1 + part * (limit - 1);
    const Eigen::Matrix3d F = metal.pulled(stretch);
    EXPECT_NEAR(metal.stress(F)(0, 0) / stretch, E * strain(stretch), 1e-6 * yield);
    metal.end_step(F);
  }
  for (const double stretch : {1.002, 1.003, 1.01}) {
    const Eigen::Matrix3d F = metal.pulled(stretch);
    EXPECT_NEAR(metal.stress(F)(0, 0) / stretch, yield, 1e-6 * yield) << stretch;
    metal.end_step(F);
    EXPECT_NEAR(metal.stress(F)(0, 0) / stretch, yield, 1e-6 * yield) << "after the step";
  }
  const double back = std::sqrt(1 + 2 * (strain(1.01) - 0.4 * yield / E));
  EXPECT_NEAR(metal.stress(metal.pulled(back))(0, 0) / back, 0.6 * yield, 1e-5 * yield);
  const double left = std::sqrt(1 + 2 * (strain(1.01) - yield / E));
  const Eigen::Matrix3d F = metal.pulled(left);
  EXPECT_NEAR(metal.stress(F)(0, 0), 0, 1e-5 * yield);
  const Eigen::Matrix3d plastic = (F.transpose() * F - Eigen::Matrix3d::Identity()) / 2;
  EXPECT_NEAR(plastic.trace(), 0, 1e-9);
  EXPECT_NEAR(plastic(0, 0), strain(1.01) - yield / E, 1e-9);
}

// What flows is no longer stored: the budget of a step counts it as dissipated, and closes.
TEST(inelastic, plastic_flow_is_dissipated) {
  BuiltScene built = build_text(R"(
gravity = [0, 0, 0]
[time]
dt = 100
steps = 4
[solver]
tolerance = 1e-12
[[object]]
name = "bar"
box = { size = [0.4, 0.1, 0.1], cells = [4, 1, 1] }
element = "hex8"
density = 1
fixed = [{ max = [1e-9, inf, inf] }]
scripted = [{ min = [0.399999, -inf, -inf], key = [{ time = 400, translate = [0.008, 0, 0] }] }]
energy = [{ law = "von_mises", E = 1e6, nu = 0.3, yield = 7e3 }]
)");
  TimeStepper stepper(*built.system, built.mass, nullptr, built.step, built.script);
  State state = built.start;
  for (int step = 1; step <= 4; ++step) {
    const StepRecord record = stepper.step(state);
    ASSERT_TRUE(record.converged) << record.reason;
    const Budget& budget = record.budget;
    EXPECT_NEAR(record.energy.total, stepper.energies(state).total, 1e-12);
    EXPECT_LT(std::abs(budget.residual), 1e-9 * budget.script);
    // Beyond the stretch at which it yields, 0.7 %, nearly all work of the script flows: its part beyond the limit.
    if (step == 1)
      EXPECT_NEAR(budget.damping, 0, 1e-15);
    else
      EXPECT_GT(budget.damping, 0.3 * budget.script) << step;
  }
}

// Folded beyond its limit, a hinge keeps what is beyond it; the moment is that at the limit.
TEST(inelastic, a_hinge_keeps_a_crease) {
  Eigen::Matrix3Xd X(3, 4);
  X << 0, 1, 0.5, 0.5, 0, 0, 1, -1, 0, 0, 0, 0;
  const double yield = 0.2;
  Potential hinge = Potential::on_stencils("hinge", kernel_named("plastic_hinge"), {0, 1, 2, 3}, X,
                                           {{"k", {1e-3}}, {"yield", {yield}}}, {});
  hinge.set_lag("crease", {0});
  const auto folded = [&](double angle) {
    Eigen::Matrix3Xd x = X;
    x.col(3) = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()).toRotationMatrix() * X.col(3);
    return x;
  };
  const double sign = hinge.renewed(folded(0.5)).at("crease")[0] > 0 ? 1 : -1;
  EXPECT_NEAR(hinge.renewed(folded(0.1)).at("crease")[0], 0, 1e-15);
  EXPECT_NEAR(hinge.renewed(folded(0.5)).at("crease")[0], sign * 0.3, 1e-14);
  EXPECT_NEAR(hinge.renewed(folded(-0.5)).at("crease")[0], -sign * 0.3, 1e-14);
  System system(4);
  system.add(hinge);
  Eigen::Matrix3Xd at_limit, beyond;
  system.gradient(folded(yield), at_limit);
  system.gradient(folded(0.5), beyond);
  EXPECT_NEAR(at_limit.col(3).norm(), beyond.col(3).norm(), 1e-12 * beyond.col(3).norm());
  system.potential(0).set_lag("crease", hinge.renewed(folded(0.5)).at("crease"));
  EXPECT_NEAR(system.value(folded(0.3)).value, 0, 1e-20);
}

// A step that fails leaves what energies remember as it was, and the next one goes on as if nothing had been.
TEST(inelastic, a_step_that_fails_forgets_nothing) {
  const std::string text = wobbling("{ law = \"maxwell_branch\", mu = \"20 kPa\", tau = \"20 ms\" }");
  const auto run = [&](bool failing) {
    BuiltScene built = build_text(text);
    TimeStepper stepper(*built.system, built.mass, nullptr, built.step, built.script);
    State state = built.start;
    for (int step = 0; step < 6; ++step) {
      if (failing && step == 3) {
        const State before = state;
        stepper.options().max_iterations = 1;
        EXPECT_FALSE(stepper.step(state).accepted);
        EXPECT_EQ(state.internal, before.internal);
        stepper.options().max_iterations = 200;
      }
      EXPECT_TRUE(stepper.step(state).accepted);
    }
    return state;
  };
  const State straight = run(false), retried = run(true);
  EXPECT_EQ(straight.x, retried.x);
  EXPECT_EQ(straight.internal, retried.internal);
  EXPECT_GT(std::abs(straight.internal.at(1).at("flow")[0]), 1e-6);
}

}  // namespace
}  // namespace ergon
