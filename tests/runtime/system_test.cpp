#include "runtime/system.h"

#include <gtest/gtest.h>

#include <random>

#include "runtime/lanes/lanes.h"
#include "runtime/mesh/mesh_build.h"
#include "tests/runtime/dense_oracle.h"

namespace ergon {
namespace {

using namespace testing;  // NOLINT

constexpr double kTolerance = 2e-13;

std::vector<int> widths() {
  std::vector<int> usable;
  for (const int w : lanes::kWidths) {
    if (w <= lanes::best_lanes()) usable.push_back(w);
  }
  return usable;
}

Eigen::Matrix3Xd noisy(const Eigen::Matrix3Xd& X, double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-noise, noise);
  Eigen::Matrix3Xd x = X;
  for (int v = 0; v < x.cols(); ++v) {
    for (int c = 0; c < 3; ++c) x(c, v) += uniform(random);
  }
  return x;
}

// Random positions and stencils of different vertices.
struct Cloud {
  Eigen::Matrix3Xd X, x;
  std::vector<int> stencils;

  Cloud(int vertices, int points, int count, unsigned seed) : X(3, vertices) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int v = 0; v < vertices; ++v) X.col(v) << uniform(random), uniform(random), uniform(random);
    x = noisy(X, 0.4, seed + 1);
    std::vector<int> all(static_cast<size_t>(vertices));
    for (int v = 0; v < vertices; ++v) all[static_cast<size_t>(v)] = v;
    for (int s = 0; s < count; ++s) {
      std::shuffle(all.begin(), all.end(), random);
      stencils.insert(stencils.end(), all.begin(), all.begin() + points);
    }
  }
};

void expect_equal(System& system, const Eigen::Matrix3Xd& x, Projection projection, const Dense& dense,
                  const std::vector<char>& fixed) {
  Eigen::Matrix3Xd gradient;
  BlockMatrix matrix;
  const Evaluation all = system.hessian(x, projection, gradient, matrix);
  const double scale = std::max(std::abs(dense.value), 1.0);
  EXPECT_NEAR(all.value, dense.value, kTolerance * scale);
  EXPECT_LT(difference(gradient.reshaped(), dense.gradient), kTolerance);
  EXPECT_LT(difference(to_dense(matrix), dense.free_hessian(fixed)), kTolerance);
  EXPECT_EQ(all.indefinite, dense.indefinite);
  gradient.setZero();
  EXPECT_NEAR(system.gradient(x, gradient).value, dense.value, kTolerance * scale);
  EXPECT_LT(difference(gradient.reshaped(), dense.gradient), kTolerance);
  EXPECT_NEAR(system.value(x).value, dense.value, kTolerance * scale);
}

TEST(System, TetrahedraEqualTheDenseSumForEveryCountAndWidth) {
  const Mesh box = box_tets({1, 1.2, 0.8}, {2, 2, 1});
  const Parameters params{{"mu", {3.0}}, {"lambda", {7.0}}};
  for (const int width : widths()) {
    for (int count = 1; count <= 20; ++count) {
      Mesh mesh = box;
      mesh.cells.resize(static_cast<size_t>(4 * count));
      const Eigen::Matrix3Xd x = noisy(mesh.X, 0.3, static_cast<unsigned>(count));
      for (const Projection projection : {Projection::clamp, Projection::absolute, Projection::none}) {
        SCOPED_TRACE(::testing::Message()
                     << "width " << width << ", count " << count << ", projection " << static_cast<int>(projection));
        System system(mesh.vertices());
        system.add(Potential::on_mesh("box", kernel_of<NeoHookeanLaw>(width), mesh, 0, params));
        Dense dense(mesh.vertices());
        dense.add_solid<NeoHookeanLaw>(x, mesh, 0, {3.0, 7.0}, projection);
        EXPECT_TRUE(projection == Projection::none || count < 6 || dense.indefinite > 0);
        expect_equal(system, x, projection, dense, std::vector<char>(static_cast<size_t>(mesh.vertices()), 0));
      }
    }
  }
}

template <class Law>
void stencils_equal_the_dense_sum(const std::vector<double>& params, const Parameters& named) {
  for (const int width : widths()) {
    for (const int count : {1, 3, 4, 5, 8, 9, 17, 150}) {
      SCOPED_TRACE(::testing::Message() << Law::kName << " width " << width << ", count " << count);
      const Cloud cloud(12, Law::kPoints, count, static_cast<unsigned>(count));
      std::map<std::string, std::vector<double>> rest;
      std::vector<double> data;
      for (int s = 0; s < count; ++s) {
        if (Law::kRaw == 1) {
          data.push_back(0.5 + s);
          rest["area"].push_back(0.5 + s);
        }
        for (int a = 0; a < Law::kRaw / 3; ++a) {
          const Eigen::Vector3d X = cloud.X.col(cloud.stencils[static_cast<size_t>(s * Law::kPoints + a)]);
          data.insert(data.end(), X.begin(), X.end());
        }
      }
      std::vector<char> fixed(12, 0);
      fixed[1] = fixed[7] = 1;
      System system(12);
      system.set_fixed(fixed);
      system.add(Potential::on_stencils("law", kernel_of<Law>(width), cloud.stencils, cloud.X, named, rest));
      Dense dense(12);
      dense.add_stencils<Law>(cloud.x, cloud.stencils, data, params, Projection::clamp);
      expect_equal(system, cloud.x, Projection::clamp, dense, fixed);
    }
  }
}

TEST(System, SpringsEqualTheDenseSum) { stencils_equal_the_dense_sum<SpringLaw>({2.0}, {{"k", {2.0}}}); }
TEST(System, HingesEqualTheDenseSum) { stencils_equal_the_dense_sum<HingeLaw>({0.7}, {{"k", {0.7}}}); }
TEST(System, UncommonShapesEqualTheDenseSum) { stencils_equal_the_dense_sum<BendLaw>({}, {}); }

TEST(System, FixedVerticesLeaveTheMatrixAndKeepTheirReaction) {
  const Mesh mesh = box_tets({1, 1, 1}, {2, 2, 2});
  std::vector<char> fixed(static_cast<size_t>(mesh.vertices()), 0);
  for (int v = 0; v < mesh.vertices(); ++v) fixed[static_cast<size_t>(v)] = mesh.X(0, v) == 0;
  const Eigen::Matrix3Xd x = noisy(mesh.X, 0.2, 4);
  Dense dense(mesh.vertices());
  dense.add_solid<NeoHookeanLaw>(x, mesh, 0, {1.0, 5.0}, Projection::clamp);
  for (const int width : widths()) {
    System system(mesh.vertices());
    system.add(Potential::on_mesh("box", kernel_of<NeoHookeanLaw>(width), mesh, 0, {{"mu", {1}}, {"lambda", {5}}}));
    system.set_fixed(fixed);
    EXPECT_EQ(system.free_vertices(), mesh.vertices() - 9);
    EXPECT_EQ(system.block_of(0), -1);
    EXPECT_EQ(system.block_of(1), 0);
    expect_equal(system, x, Projection::clamp, dense, fixed);
    system.set_fixed(std::vector<char>(fixed.size(), 0));
    expect_equal(system, x, Projection::clamp, dense, std::vector<char>(fixed.size(), 0));
  }
}

TEST(System, AddsPotentialsOnTwoMeshesAndPoints) {
  const Mesh mesh = box_tets({1, 1, 1}, {1, 1, 2});
  const int n = mesh.vertices();
  Eigen::Matrix3Xd X(3, 2 * n);
  X << mesh.X, (mesh.X.colwise() + Eigen::Vector3d(3, 0, 0)).eval();
  const Eigen::Matrix3Xd x = noisy(X, 0.3, 9);
  std::vector<int> points;
  std::vector<double> mass, inertia_data, gravity_data, springs_data;
  const std::vector<int> springs{0, n, n + 3, 2, 5, n + 5};
  for (int v = 0; v < 2 * n; ++v) {
    points.push_back(v);
    mass.push_back(1 + v);
    for (const double d : {1.0 + v, 0.1, 0.5, -0.5, 0.25}) inertia_data.push_back(d);
    gravity_data.push_back(1 + v);
  }
  for (const int v : springs) springs_data.insert(springs_data.end(), X.col(v).begin(), X.col(v).end());
  std::vector<char> fixed(static_cast<size_t>(2 * n), 0);
  fixed[3] = 1;

  System system(2 * n);
  system.set_fixed(fixed);
  const Parameters stiff{{"mu", {3}}, {"lambda", {7}}};
  system.add(Potential::on_mesh("left", kernel_of<NeoHookeanLaw>(widths().back()), mesh, 0, stiff));
  system.add(Potential::on_mesh("right", kernel_of<NeoHookeanLaw>(1), mesh, n, stiff));
  system.add(
      Potential::on_stencils("inertia", kernel_of<InertiaLaw>(widths().back()), points, X, {}, {{"mass", mass}}));
  system.add(
      Potential::on_stencils("gravity", kernel_of<GravityLaw>(1), points, X, {{"g", {0, 0, -9.81}}}, {{"mass", mass}}));
  system.add(Potential::on_stencils("springs", kernel_of<SpringLaw>(widths().back()), springs, X, {{"k", {40}}}, {}));
  system.potential(2).set_lag("dt", {0.1});
  system.potential(2).set_lag("xhat", {0.5, -0.5, 0.25});

  Dense dense(2 * n);
  dense.add_solid<NeoHookeanLaw>(x, mesh, 0, {3, 7}, Projection::clamp);
  dense.add_solid<NeoHookeanLaw>(x, mesh, n, {3, 7}, Projection::clamp);
  dense.add_stencils<InertiaLaw>(x, points, inertia_data, {}, Projection::clamp);
  const double before_gravity = dense.value;
  dense.add_stencils<GravityLaw>(x, points, gravity_data, {0, 0, -9.81}, Projection::clamp);
  const double gravity = dense.value - before_gravity;
  dense.add_stencils<SpringLaw>(x, springs, springs_data, {40}, Projection::clamp);
  expect_equal(system, x, Projection::clamp, dense, fixed);

  const Evaluation parts = system.value(x);
  ASSERT_EQ(parts.by_potential.size(), 5u);
  EXPECT_NEAR(parts.by_potential[3], gravity, 1e-10 * std::abs(gravity));
  EXPECT_EQ(system.skipped(), (std::vector<std::string>{"inertia: Hessian is constant, assembled once",
                                                        "gravity: Hessian is zero, not assembled"}));
}

}  // namespace
}  // namespace ergon
