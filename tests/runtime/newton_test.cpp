#include "runtime/solver/newton.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/runtime/body_scene.h"

namespace ergon {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// Three points on a line, joined by two springs; the first is fixed.
struct Chain {
  Matrix3Xd X{3, 3};
  System system{3};
  explicit Chain(double k = 100) {
    X << 0, 1, 2, 0, 0, 0, 0, 0, 0;
    system.set_fixed({1, 0, 0});
    system.add(Potential::on_stencils("spring", body_kernels::spring(), {0, 1, 1, 2}, X, {{"k", {k}}}, {}));
  }
  void add_weight(double mass, const Vector3d& g) {
    system.add(Potential::on_stencils("gravity", body_kernels::gravity(), {0, 1, 2}, X, {{"g", {g[0], g[1], g[2]}}},
                                      {{"mass", {mass, mass, mass}}}));
  }
};

TEST(Newton, QuadraticEnergyTakesOneStep) {
  Eigen::VectorXd mass(2);
  mass << 1, 3;
  Matrix3Xd x(3, 2);
  x << 0, 1, 0, 2, 0, 3;
  System system(2);
  Potential inertia =
      Potential::on_stencils("inertia", body_kernels::inertia(), {0, 1}, x, {}, {{"mass", {mass[0], mass[1]}}});
  inertia.set_lag("dt", {0.1});
  inertia.set_lag("xhat", {5, 6, 7, -1, -2, -3});
  system.add(inertia);
  Newton newton;
  NewtonOptions options;
  options.dt = 0.1;
  options.curvature = mass / 0.01;
  const NewtonResult result = newton.minimise(system, x, options);
  EXPECT_TRUE(result.converged) << result.reason;
  EXPECT_EQ(result.iterations, 1);
  EXPECT_EQ(result.factorisations, 1);
  EXPECT_LT((x.col(0) - Vector3d(5, 6, 7)).norm(), 1e-14);
  EXPECT_LT((x.col(1) - Vector3d(-1, -2, -3)).norm(), 1e-14);
  EXPECT_LE(result.step_speed, options.tolerance);
}

TEST(Newton, HangingChainReachesItsLength) {
  Chain chain;
  chain.add_weight(2, Vector3d(9.81, 0, 0));
  Matrix3Xd x = chain.X;
  Newton newton;
  NewtonOptions options;
  options.tolerance = 1e-12;
  const NewtonResult result = newton.minimise(chain.system, x, options);
  ASSERT_TRUE(result.converged) << result.reason;
  EXPECT_NEAR(x(0, 1), 1 + 2 * 2 * 9.81 / 100, 1e-13);
  EXPECT_NEAR(x(0, 2), x(0, 1) + 1 + 2 * 9.81 / 100, 1e-13);
  EXPECT_LT(result.residual, 1e-11);
  EXPECT_EQ(x.col(0), chain.X.col(0));
}

// Upright over its support the chain has a Hessian that is not definite: projection has to find the way down.
TEST(Newton, LeavesAnUnstableStateDownhill) {
  Chain chain;
  chain.add_weight(1, Vector3d(0, -9.81, 0));
  Matrix3Xd x(3, 3);
  x << 0, 1e-3, -1e-3, 0, 0.9, 1.7, 0, 1e-4, 3e-4;
  Newton newton;
  NewtonOptions options;
  options.tolerance = 1e-10;
  options.max_iterations = 300;
  const double before = chain.system.value(x).value;
  const NewtonResult result = newton.minimise(chain.system, x, options);
  ASSERT_TRUE(result.converged) << result.reason;
  EXPECT_LT(result.evaluation.value, before);
  EXPECT_NEAR(x(1, 1), -(1 + 2 * 9.81 / 100), 1e-9);
  EXPECT_NEAR(x(1, 2), x(1, 1) - (1 + 9.81 / 100), 1e-9);
}

TEST(Newton, ProjectsOnDemandFromWhereItIsNeeded) {
  Chain chain;
  chain.add_weight(1, Vector3d(0, -9.81, 0));
  NewtonOptions options;
  options.on_demand = true;
  options.tolerance = 1e-10;
  options.max_iterations = 300;
  Matrix3Xd x(3, 3);
  x << 0, 1e-3, -1e-3, 0, 0.9, 1.7, 0, 1e-4, 3e-4;
  Newton newton;
  const NewtonResult upright = newton.minimise(chain.system, x, options);
  ASSERT_TRUE(upright.converged) << upright.reason;
  EXPECT_GT(upright.projected_iterations, 0);
  EXPECT_GT(upright.indefinite, 0);
  EXPECT_NEAR(x(1, 2), -(1 + 2 * 9.81 / 100) - (1 + 9.81 / 100), 1e-9);

  // From a hanging state nothing has to be projected, and what the last minimisation needed is forgotten.
  x.col(2).y() -= 0.05;
  const NewtonResult hanging = newton.minimise(chain.system, x, options);
  ASSERT_TRUE(hanging.converged) << hanging.reason;
  EXPECT_GT(hanging.iterations, 0);
  EXPECT_EQ(hanging.projected_iterations, 0);
  EXPECT_EQ(hanging.indefinite, 0);
  EXPECT_NEAR(x(1, 2), -(1 + 2 * 9.81 / 100) - (1 + 9.81 / 100), 1e-9);
}

// A bound of curvature that is far too large says that any state is the minimum; only projected Hessians are bound by
// it.
TEST(Newton, AsksTheBoundOfCurvatureOnlyOfProjectedHessians) {
  for (const bool on_demand : {false, true}) {
    Chain chain;
    chain.add_weight(1, Vector3d(0, -9.81, 0));
    NewtonOptions options;
    options.on_demand = on_demand;
    options.tolerance = 1e-10;
    options.curvature = Eigen::VectorXd::Constant(3, 1e20);
    Matrix3Xd x(3, 3);
    x << 0, 0, 0, 0, -1.3, -2.4, 0, 0, 0;
    const NewtonResult result = Newton().minimise(chain.system, x, options);
    ASSERT_TRUE(result.converged) << result.reason;
    EXPECT_EQ(result.iterations == 0, !on_demand);
    if (on_demand) {
      EXPECT_NEAR(x(1, 2), -(1 + 2 * 9.81 / 100) - (1 + 9.81 / 100), 1e-9);
    }
  }
}

TEST(Newton, ShiftsTheDiagonalWhereThereIsNoProjection) {
  Chain chain;
  chain.add_weight(1, Vector3d(0, -9.81, 0));
  Matrix3Xd x(3, 3);
  x << 0, 1e-3, -1e-3, 0, 0.9, 1.7, 0, 1e-4, 3e-4;
  Newton newton;
  NewtonOptions options;
  options.projection = Projection::none;
  options.tolerance = 1e-10;
  options.max_iterations = 1000;
  const NewtonResult result = newton.minimise(chain.system, x, options);
  ASSERT_TRUE(result.converged) << result.reason;
  EXPECT_GT(result.shifts, 0);
  EXPECT_NEAR(x(1, 2), -(1 + 2 * 9.81 / 100) - (1 + 9.81 / 100), 1e-9);
}

TEST(Newton, SaysWhyItDidNotConverge) {
  Chain chain;
  chain.add_weight(1, Vector3d(0, -9.81, 0));
  Matrix3Xd x = chain.X;
  x(1, 2) = 0.1;
  Newton newton;
  NewtonOptions options;
  options.max_iterations = 2;
  const NewtonResult result = newton.minimise(chain.system, x, options);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.iterations, 2);
  EXPECT_THAT(result.reason, testing::MatchesRegex("2 Newton iterations did not reach the tolerance of 0.0001 m/s: the "
                                                   "last step is [0-9.]+ m/s at vertex [12]"));
}

// Contact that cannot show any motion to be free of collision.
struct Blocked : Contact {
  void begin_step(const Matrix3Xd&, const Matrix3Xd&, double) override {}
  FrictionChange lag_friction(const Matrix3Xd&, const Matrix3Xd&, double) override { return {}; }
  void set_active(const Matrix3Xd&) override {}
  double largest_step(const Matrix3Xd&, const Matrix3Xd&) override { return 0; }
  double gap_change(const Matrix3Xd&, const Matrix3Xd&) override { return 0; }
  bool adapt(const Matrix3Xd&) override { return false; }
  bool owns(int) const override { return false; }
  bool rubs(int) const override { return false; }
  bool has_friction() const override { return false; }
  ContactStatus status(const Matrix3Xd&) override { return {.reached = true, .active = 1, .smallest_gap = 2e-18}; }
  std::vector<std::string> skipped() const override { return {}; }
};

TEST(Newton, SaysAtOnceThatContactAllowsNoStep) {
  Chain chain;
  chain.add_weight(2, Vector3d(9.81, 0, 0));
  Matrix3Xd x = chain.X;
  Newton newton;
  NewtonOptions options;
  options.dt = 0.1;
  Blocked contact;
  const NewtonResult result = newton.minimise(chain.system, x, options, &contact);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.iterations, 0);
  EXPECT_EQ(result.worst_vertex, 2);
  EXPECT_EQ(result.reason,
            "contact allows no part of a Newton step of 5.89 m/s at vertex 2: the smallest gap is 2e-18 m, which "
            "positions hardly resolve; move the scene nearer to the origin, or raise the stiffness of contact");
  EXPECT_EQ(x, chain.X);
}

TEST(Newton, NamesThePotentialWhoseDomainTheStartIsOutsideOf) {
  Chain chain;
  chain.system.add(Potential::on_stencils("floor", body_kernels::ground_barrier(), {1}, chain.X,
                                          {{"n", {0, 1, 0}}, {"height", {0.5}}, {"dhat", {0.1}}}, {}));
  chain.system.potential(1).set_lag("kappa", {1});
  Matrix3Xd x = chain.X;
  Newton newton;
  const NewtonResult result = newton.minimise(chain.system, x, {});
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.reason, "the state at the start is outside the domain of floor");
  EXPECT_EQ(x, chain.X);
  EXPECT_EQ(result.iterations, 0);
}

// A tolerance far below the rounding of positions ends at rounding and says so.
TEST(Newton, StopsAtRounding) {
  Chain chain(1e9);
  chain.add_weight(1, Vector3d(9.81, 0, 0));
  Matrix3Xd x = chain.X;
  x(1, 1) = 1e-6;
  Newton newton;
  NewtonOptions options;
  options.tolerance = 1e-30;
  options.max_iterations = 500;
  const NewtonResult result = newton.minimise(chain.system, x, options);
  EXPECT_TRUE(result.converged) << result.reason;
  EXPECT_TRUE(result.at_rounding);
  EXPECT_LT(result.residual, 1e-5);
  EXPECT_LT(result.iterations, 100);
}

// Near its limit the last step is solved with the factor of the one before, and is as good as the tolerance asks.
TEST(Newton, LastStepReusesTheFactor) {
  Chain chain;
  chain.add_weight(1, Vector3d(9.81, 0, 0));
  Matrix3Xd x = chain.X;
  x(1, 1) = 1e-4;
  Newton newton;
  NewtonOptions options;
  options.tolerance = 1e-7;
  const NewtonResult result = newton.minimise(chain.system, x, options);
  ASSERT_TRUE(result.converged) << result.reason;
  EXPECT_EQ(result.reused_factors, 1);
  EXPECT_EQ(result.factorisations, result.iterations);
  EXPECT_LE(result.step_speed, options.tolerance / 2);
  EXPECT_NEAR(x(0, 2), 2 + 3 * 9.81 / 100, options.tolerance);
  EXPECT_NEAR(x(1, 1), 0, options.tolerance);
}

TEST(Newton, AnalysesOnceForAllIterations) {
  Chain chain;
  chain.add_weight(1, Vector3d(0, -9.81, 0));
  Matrix3Xd x = chain.X;
  x(1, 2) = 0.1;
  Newton newton;
  NewtonOptions options;
  options.max_iterations = 300;
  const NewtonResult first = newton.minimise(chain.system, x, options);
  ASSERT_TRUE(first.converged) << first.reason;
  x = chain.X;
  x(2, 2) = 0.3;
  const NewtonResult second = newton.minimise(chain.system, x, options);
  ASSERT_TRUE(second.converged) << second.reason;
  EXPECT_GT(first.factorisations + second.factorisations, 4);
  EXPECT_EQ(newton.linear_solver().analyses(), 1);
}

}  // namespace
}  // namespace ergon
