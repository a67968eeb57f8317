#include <gtest/gtest.h>
#include <omp.h>

#include <atomic>
#include <cstring>

#include "runtime/lanes/lanes.h"
#include "runtime/mesh/mesh_build.h"
#include "runtime/system.h"
#include "tests/runtime/count_allocations.h"
#include "tests/runtime/dense_oracle.h"

namespace ergon {
namespace {

using namespace testing;  // NOLINT

std::atomic<int> inertia_hessians{0};

// Inertia that counts how often its Hessian is evaluated (in blocks of one stencil).
Kernel counting_inertia() {
  static ErgonKernel table = *JetKernel<InertiaLaw, 1>::kernel().table;
  table.hessian = [](const double* q, const double* e, const double* u, double* value, double* gradient, double* h) {
    ++inertia_hessians;
    JetKernel<InertiaLaw, 1>::hessian(q, e, u, value, gradient, h);
  };
  return {nullptr, &table};
}

struct Body {
  Mesh mesh = box_tets({1, 1, 1}, {6, 6, 5});
  Eigen::Matrix3Xd x = mesh.X;
  std::vector<int> points;
  System system{mesh.vertices()};

  explicit Body(Kernel inertia, int width = 1) {
    for (int v = 0; v < mesh.vertices(); ++v) {
      points.push_back(v);
      x.col(v) += 0.05 * Eigen::Vector3d(std::sin(13.0 * v), std::sin(17.0 * v), std::sin(19.0 * v));
    }
    const std::vector<double> mass(points.size(), 2.0);
    system.add(Potential::on_mesh("solid", kernel_of<NeoHookeanLaw>(width), mesh, 0, {{"mu", {3}}, {"lambda", {7}}}));
    system.add(Potential::on_stencils("inertia", std::move(inertia), points, mesh.X, {}, {{"mass", mass}}));
    system.potential(1).set_lag("dt", {0.5});
    system.potential(1).set_lag("xhat", {0, 0, 0});
  }
};

TEST(SystemConstant, HessiansAreMadeAgainOnlyWhenTheyChange) {
  Body body(counting_inertia());
  const int n = body.mesh.vertices();
  Eigen::Matrix3Xd gradient;
  BlockMatrix matrix;
  const auto evaluations = [&](Projection projection = Projection::clamp) {
    inertia_hessians = 0;
    body.system.hessian(body.x, projection, gradient, matrix);
    return inertia_hessians.load();
  };
  EXPECT_EQ(evaluations(), 2 * n);  // kept to compare with, and assembled
  const std::vector<double> first = matrix.values();
  EXPECT_EQ(evaluations(), 0);
  EXPECT_EQ(matrix.values(), first);

  body.system.potential(1).set_lag("xhat", {1, 2, 3});
  EXPECT_EQ(evaluations(), n);  // compared only
  EXPECT_EQ(matrix.values(), first);
  EXPECT_EQ(evaluations(), 0);

  body.system.potential(1).set_lag("dt", {0.25});
  EXPECT_EQ(evaluations(), 2 * n);
  // 2/0.25^2 - 2/0.5^2 on the diagonal.
  EXPECT_NEAR(matrix.values()[0] - first[0], 24, 1e-12);
  EXPECT_EQ(evaluations(), 0);

  EXPECT_EQ(evaluations(Projection::none), n);
  std::vector<char> fixed(static_cast<size_t>(n), 0);
  fixed[0] = 1;
  body.system.set_fixed(fixed);
  EXPECT_EQ(evaluations(), n);
  EXPECT_EQ(matrix.block_rows(), n - 1);
  EXPECT_EQ(body.system.skipped(), std::vector<std::string>{"inertia: Hessian is constant, assembled once"});
}

TEST(SystemConstant, MatrixEqualsTheDenseSumAfterEveryChange) {
  Body body(kernel_of<InertiaLaw>(lanes::best_lanes()), lanes::best_lanes());
  const int n = body.mesh.vertices();
  Eigen::Matrix3Xd gradient;
  BlockMatrix matrix;
  for (const double dt : {0.5, 0.25, 0.25, 0.125}) {
    body.system.potential(1).set_lag("dt", {dt});
    body.system.hessian(body.x, Projection::clamp, gradient, matrix);
    std::vector<double> data;
    for (int v = 0; v < n; ++v) data.insert(data.end(), {2, dt, 0, 0, 0});
    Dense dense(n);
    dense.add_solid<NeoHookeanLaw>(body.x, body.mesh, 0, {3, 7}, Projection::clamp);
    dense.add_stencils<InertiaLaw>(body.x, body.points, data, {}, Projection::clamp);
    EXPECT_LT(difference(to_dense(matrix), dense.hessian), 1e-12);
    EXPECT_LT(difference(gradient.reshaped(), dense.gradient), 1e-12);
  }
}

TEST(System, ResultsDoNotDependOnTheNumberOfThreads) {
  const int before = omp_get_max_threads();
  std::vector<double> first_values;
  Eigen::Matrix3Xd first_gradient, first_full;
  double first_value = 0, first_energy = 0;
  for (const int threads : {1, 2, 3, 4}) {
    omp_set_num_threads(threads);
    Mesh mesh = box_tets({1, 1, 1}, {12, 11, 10});
    Eigen::Matrix3Xd x = mesh.X;
    for (int v = 0; v < mesh.vertices(); ++v) {
      x.col(v) += 0.02 * Eigen::Vector3d(std::sin(13.0 * v), std::sin(17.0 * v), std::sin(19.0 * v));
    }
    System system(mesh.vertices());
    system.add(Potential::on_mesh("solid", kernel_of<NeoHookeanLaw>(lanes::best_lanes()), mesh, 0,
                                  {{"mu", {3}}, {"lambda", {7}}}));
    std::vector<int> springs;
    for (int v = 1; v < mesh.vertices(); ++v) springs.insert(springs.end(), {0, v});
    system.add(
        Potential::on_stencils("star", kernel_of<SpringLaw>(lanes::best_lanes()), springs, mesh.X, {{"k", {0.1}}}, {}));
    Eigen::Matrix3Xd gradient, full;
    BlockMatrix matrix;
    const double value = system.hessian(x, Projection::clamp, full, matrix).value;
    system.gradient(x, gradient);
    const double energy = system.value(x).value;
    if (threads == 1) {
      first_values = matrix.values();
      first_gradient = gradient;
      first_full = full;
      first_value = value;
      first_energy = energy;
      continue;
    }
    EXPECT_EQ(std::memcmp(first_values.data(), matrix.values().data(), first_values.size() * sizeof(double)), 0);
    EXPECT_EQ(first_gradient, gradient);
    EXPECT_EQ(first_full, full);
    EXPECT_EQ(first_value, value);
    EXPECT_EQ(first_energy, energy);
  }
  omp_set_num_threads(before);
}

TEST(System, AllocatesNothingWhileThePatternStays) {
  Body body(kernel_of<InertiaLaw>(1));
  Eigen::Matrix3Xd gradient;
  BlockMatrix matrix;
  const auto evaluate = [&] {
    body.system.hessian(body.x, Projection::clamp, gradient, matrix);
    body.system.gradient(body.x, gradient);
    body.system.value(body.x);
  };
  evaluate();
  const long before = allocations();
  evaluate();
  EXPECT_EQ(allocations(), before);
}

TEST(System, NewStencilsKeepThePatternUnlessTheyBringACoupling) {
  const Mesh mesh = box_tets({1, 1, 1}, {2, 2, 2});
  System system(mesh.vertices());
  system.add(Potential::on_mesh("solid", kernel_of<NeoHookeanLaw>(1), mesh, 0, {{"mu", {3}}, {"lambda", {7}}}));
  system.add(Potential::on_stencils("contact", kernel_of<BarrierLaw>(1), {}, mesh.X, {}, {}));
  system.add(Potential::on_stencils("ropes", kernel_of<SpringLaw>(1), {0, 1}, mesh.X, {{"k", {1}}}, {}));
  EXPECT_EQ(system.skipped(), std::vector<std::string>{"contact: no stencils, not evaluated"});
  const Eigen::Matrix3Xd x = mesh.X.colwise() + Eigen::Vector3d(0, 0, 0.5);
  Eigen::Matrix3Xd gradient;
  BlockMatrix matrix;
  system.hessian(x, Projection::clamp, gradient, matrix);
  const unsigned long pattern = matrix.pattern_id();
  const auto expect_dense = [&](const std::vector<int>& points, const std::vector<int>& springs) {
    system.hessian(x, Projection::clamp, gradient, matrix);
    Dense dense(mesh.vertices());
    dense.add_solid<NeoHookeanLaw>(x, mesh, 0, {3, 7}, Projection::clamp);
    dense.add_stencils<BarrierLaw>(x, points, std::vector<double>(points.size(), 0.2), {}, Projection::clamp);
    std::vector<double> rest;
    for (const int v : springs) rest.insert(rest.end(), mesh.X.col(v).begin(), mesh.X.col(v).end());
    dense.add_stencils<SpringLaw>(x, springs, rest, {1}, Projection::clamp);
    EXPECT_LT(difference(to_dense(matrix), dense.hessian), 1e-12);
  };
  expect_dense({}, {0, 1});
  for (const std::vector<int>& points : {std::vector<int>{3, 5}, {5, 6, 7, 20, 26}, {}, {1}}) {
    system.potential(1).set_stencils(points, mesh.X, {});
    system.potential(1).set_lag("kappa", {0.2});
    expect_dense(points, {0, 1});
    EXPECT_EQ(matrix.pattern_id(), pattern);
  }
  system.potential(2).set_stencils({0, 1, 4, 13}, mesh.X, {});
  expect_dense({1}, {0, 1, 4, 13});
  EXPECT_EQ(matrix.pattern_id(), pattern);
  system.potential(2).set_stencils({0, 26}, mesh.X, {});
  expect_dense({1}, {0, 26});
  EXPECT_GT(matrix.pattern_id(), pattern);
}

TEST(System, ValueTellsTheSmallestMargin) {
  for (const int width : {1, lanes::best_lanes()}) {
    System system(5);
    Eigen::Matrix3Xd x = Eigen::Matrix3Xd::Ones(3, 5);
    x.row(2) << 0.5, 0.25, 0.75, 2, 3;
    system.add(Potential::on_stencils("floor", kernel_of<BarrierLaw>(width), {0, 1, 2, 3}, x, {}, {}));
    system.add(Potential::on_stencils("ceiling", kernel_of<BarrierLaw>(width), {3, 4}, x, {}, {}));
    system.potential(0).set_lag("kappa", {1});
    system.potential(1).set_lag("kappa", {1});
    EXPECT_EQ(system.value(x).require, 0.25);
    EXPECT_EQ(system.value(x).violated, "");
    x(2, 4) = -0.125;
    EXPECT_EQ(system.value(x).require, -std::numeric_limits<double>::infinity());  // log of a negative number
    EXPECT_EQ(system.value(x).violated, "ceiling");
    x(2, 4) = 3;
    x(2, 1) = std::nan("");
    EXPECT_EQ(system.value(x).violated, "floor");
    x(2, 1) = 0;
    EXPECT_EQ(system.value(x).violated, "floor");
    EXPECT_LE(system.value(x).require, 0);
  }
}

}  // namespace
}  // namespace ergon
