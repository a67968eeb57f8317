// Constraints that are kept within a tolerance, however soft or stiff their laws are.

#include "runtime/solver/constraints.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "codegen/compile.h"
#include "runtime/error.h"
#include "symbolic/augmented.h"
#include "symbolic/energy_builder.h"
#include "tests/paths.h"
#include "tests/runtime/body_scene.h"

namespace ergon {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

const Vector3d gravity(0, -9.81, 0);

Kernel augmented_kernel(const Energy& energy) {
  const CompiledKernel compiled = compile(augmented(energy), {});
  return {compiled.library, compiled.table};
}

Energy shipped_constraint(const std::string& name) {
  return read_energy(test::source("/energies/constraints/" + name + ".energy"));
}

// A link of fixed length, of any stiffness.
Energy link_law() {
  EnergyBuilder law("energy", "link", "edge");
  const Expr x0 = law.dof("x0", "m"), x1 = law.dof("x1", "m");
  const Expr L = law.rest("L", "m", "(0, inf)", "length");
  const Expr k = law.param("k", "N/m", "(0, inf)", "stiffness");
  const Expr c = law.constraint("c", norm(x1 - x0) - L);
  law.value(k / 2 * pow(c, 2));
  return law.build();
}

// A weight of 2 kg at the place that it is attached to.
struct Hanging {
  BodyScene scene{Matrix3Xd(Vector3d(0, 1, 0)), Eigen::VectorXd::Constant(1, 2), gravity};
  int attachment;

  Hanging(double k, double tolerance, const Vector3d& target = {0, 1, 0}) {
    static const Kernel kernel = augmented_kernel(shipped_constraint("attachment"));
    attachment =
        scene.system.add(Potential::on_stencils("attachment", kernel, {0}, scene.state.x, {{"k", {k}}}, StencilData{}));
    scene.system.potential(attachment).set_lag("target", {target[0], target[1], target[2]});
    scene.start({.dt = 0.01, .tolerance = 1e-6});
    scene.stepper->keep_constraints({{attachment, tolerance, "m"}});
  }
};

TEST(Constraints, AWeightHangsWithinTheToleranceWhateverTheStiffness) {
  const double tolerance = 1e-5;
  for (const double k : {1e-3, 1.0, 1e3, 1e6, 1e10}) {
    SCOPED_TRACE(k);
    Hanging hanging(k, tolerance);
    int solves = 0;
    StepRecord record;
    for (int i = 0; i < 20; ++i) {
      record = hanging.scene.step();
      ASSERT_TRUE(record.converged) << record.reason;
      EXPECT_LE((hanging.scene.state.x.col(0) - Vector3d(0, 1, 0)).norm(), tolerance);
      EXPECT_LE(record.constraint_excess, 1);
      const Budget& b = record.budget;
      const double sum = b.script + b.loads + b.barrier - b.friction - b.damping - b.integrator + b.residual;
      EXPECT_NEAR(b.change, sum, 1e-12 * (1 + std::fabs(b.barrier)));
      solves += record.constraint_iterations;
    }
    // A stiff law holds by itself; a soft one is hardened in the first steps and then keeps what it learnt.
    if (k == 1e10) {
      EXPECT_EQ(solves, 0);
    } else {
      EXPECT_GT(solves, 0);
      EXPECT_EQ(record.constraint_iterations, 0);
    }
    // What holds the weight is the multiplier: k times what the energy sees.
    Matrix3Xd force;
    hanging.scene.system.gradient_of({hanging.attachment}, hanging.scene.state.x, force);
    EXPECT_NEAR(force(1, 0), -2 * 9.81, 2e-2);
  }
}

// Five links hang down from a fixed point and swing: none is longer or shorter than the tolerance lets it be, and the
// energy of every step is accounted for.
TEST(Constraints, AChainSwingsAtItsLength) {
  constexpr int links = 5;
  constexpr double tolerance = 1e-5, length = 0.2;
  Matrix3Xd x = Matrix3Xd::Zero(3, links + 1);
  for (int i = 0; i <= links; ++i) x(0, i) = length * i;
  std::vector<char> fixed(links + 1, 0);
  fixed[0] = 1;
  BodyScene scene(x, Eigen::VectorXd::Constant(links + 1, 0.1), gravity, fixed);
  std::vector<int> edges;
  for (int i = 0; i < links; ++i) edges.insert(edges.end(), {i, i + 1});
  const int at = scene.system.add(Potential::on_stencils("link", augmented_kernel(link_law()), edges, x, {{"k", {1.0}}},
                                                         {{"L", std::vector<double>(links, length)}}));
  scene.start({.dt = 0.005, .tolerance = 1e-6});
  scene.stepper->keep_constraints({{at, tolerance, "m"}});
  double told = scene.stepper->energies(scene.state).total;
  for (int i = 0; i < 60; ++i) {
    const StepRecord record = scene.step();
    ASSERT_TRUE(record.converged) << "step " << i << ": " << record.reason;
    for (int k = 0; k < links; ++k)
      EXPECT_LE(std::fabs((scene.state.x.col(k + 1) - scene.state.x.col(k)).norm() - length), 1.0001 * tolerance);
    told += record.budget.change;
    EXPECT_NEAR(record.energy.total, told, 1e-12);
    EXPECT_LT(std::fabs(record.budget.residual), 1e-3);
  }
  EXPECT_LT(scene.state.x(1, links), -0.3);  // it has swung down
}

// A weight that stands on the ground and is held beside where it would lie.
TEST(Constraints, AreKeptTogetherWithContact) {
  const double tolerance = 1e-5;
  Hanging hanging(10.0, tolerance, {0.2, 2e-3, 0});
  hanging.scene.state.x.col(0) = Vector3d(0.2, 4e-3, 0);
  Ground ground;
  ground.normal = Vector3d::UnitY();
  hanging.scene.add_ground({ground});
  hanging.scene.start({.dt = 0.01, .tolerance = 1e-6});
  hanging.scene.stepper->keep_constraints({{hanging.attachment, tolerance, "m"}});
  for (int i = 0; i < 5; ++i) {
    const StepRecord record = hanging.scene.step();
    ASSERT_TRUE(record.converged) << record.reason;
    EXPECT_LE((hanging.scene.state.x.col(0) - Vector3d(0.2, 2e-3, 0)).norm(), tolerance);
  }
}

TEST(Constraints, ThatCannotBeKeptFailTheStepAndLeaveTheState) {
  Hanging hanging(10.0, 1e-4, {0, -0.5, 0});  // under the ground
  Ground ground;
  ground.normal = Vector3d::UnitY();
  hanging.scene.add_ground({ground});
  hanging.scene.start({.dt = 0.01, .tolerance = 1e-6, .constraint_iterations = 6});
  hanging.scene.stepper->keep_constraints({{hanging.attachment, 1e-4, "m"}});
  const Matrix3Xd before = hanging.scene.state.x;
  const StepRecord record = hanging.scene.step();
  EXPECT_FALSE(record.accepted);
  EXPECT_EQ(
      record.reason,
      "the constraint of attachment in stencil 0 (vertex 0) is off by 0.5 m, above its tolerance of 0.0001 m, after "
      "6 solves; see whether fixed points, contact or other constraints keep it from being met, or allow a larger "
      "tolerance");
  EXPECT_EQ(hanging.scene.state.x, before);
  EXPECT_EQ(hanging.scene.state.step, 0);
  EXPECT_TRUE(hanging.scene.state.internal.empty());
}

TEST(Constraints, RefuseWhatIsNoConstraint) {
  Hanging hanging(1, 1);
  const auto message = [&](const Constraint& constraint) -> std::string {
    try {
      hanging.scene.stepper->keep_constraints({constraint});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({hanging.attachment, 0, "m"}),
            "the tolerance of the constraint of attachment is 0 m; it must be above 0");
  EXPECT_EQ(message({0, 1, "m"}),
            "inertia has no constraint that could be kept to a tolerance: its energy is not augmented");
}

}  // namespace
}  // namespace ergon
