// Closed forms and displacements against what they replace.

#include <gtest/gtest.h>

#include <random>

#include "runtime/lanes/lanes.h"
#include "runtime/mesh/mesh_build.h"
#include "runtime/system.h"
#include "tests/runtime/dense_oracle.h"

namespace ergon {
namespace {

using namespace testing;  // NOLINT

std::vector<int> usable_widths() {
  std::vector<int> usable;
  for (const int w : lanes::kWidths) {
    if (w <= lanes::best_lanes()) usable.push_back(w);
  }
  return usable;
}

// Every vertex moved by up to `amplitude`, or, every third round, all onto a plane or a line.
Eigen::Matrix3Xd moved(const Eigen::Matrix3Xd& X, double amplitude, int round) {
  std::mt19937 random(static_cast<unsigned>(round) + 1);
  std::uniform_real_distribution<double> uniform(-amplitude, amplitude);
  Eigen::Matrix3Xd x = X;
  for (Eigen::Index v = 0; v < X.cols(); ++v) {
    x.col(v) += Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
  }
  if (round % 3 == 1) x.row(round % 2).setZero();
  if (round % 3 == 2) x.topRows(2).setZero();
  return x;
}

Mesh sheet() {
  Mesh mesh;
  mesh.element = Element::tri3;
  constexpr int n = 5;
  mesh.X.resize(3, n * n);
  for (int i = 0; i < n * n; ++i) mesh.X.col(i) << i % n, 0.7 * (i / n), 0.3 * (i % n) + 0.1 * (i / n);
  for (int j = 0; j + 1 < n; ++j) {
    for (int i = 0; i + 1 < n; ++i) {
      const int a = j * n + i;
      mesh.cells.insert(mesh.cells.end(), {a, a + 1, a + n, a + 1, a + n + 1, a + n});
    }
  }
  return mesh;
}

Mesh line() {
  Mesh mesh;
  mesh.element = Element::edge2;
  mesh.X.resize(3, 20);
  for (int i = 0; i < 20; ++i) mesh.X.col(i) << 0.3 * i, 0.1 * i, -0.2 * i;
  for (int i = 0; i + 1 < 20; ++i) mesh.cells.insert(mesh.cells.end(), {i, i + 1});
  return mesh;
}

struct Result {
  Evaluation all;
  Eigen::Matrix3Xd gradient;
  Eigen::MatrixXd hessian;
};

Result evaluate(const Kernel& kernel, const Mesh& mesh, const Parameters& params, const Eigen::Matrix3Xd& x,
                Projection projection) {
  System system(mesh.vertices());
  system.add(Potential::on_mesh("law", kernel, mesh, 0, params));
  Result r;
  BlockMatrix matrix;
  r.all = system.hessian(x, projection, r.gradient, matrix);
  r.hessian = to_dense(matrix);
  return r;
}

template <class Law>
void closed_form_agrees(const Mesh& mesh, const Parameters& params) {
  long indefinite = 0;
  for (const int width : usable_widths()) {
    for (int round = 0; round < 9; ++round) {
      const Eigen::Matrix3Xd x = moved(mesh.X, 0.4, round);
      for (const Projection projection : {Projection::clamp, Projection::absolute, Projection::none}) {
        SCOPED_TRACE(::testing::Message() << Law::kName << " width " << width << " round " << round);
        const Result general = evaluate(kernel_of<Law>(width), mesh, params, x, projection);
        const Result closed = evaluate(kernel_of<Isotropic<Law>>(width), mesh, params, x, projection);
        EXPECT_EQ(closed.all.value, general.all.value);
        EXPECT_LT(difference(closed.hessian, general.hessian), 1e-12);
        // Where a singular value is zero, so are eigenvalues, and rounding decides which are counted.
        if (round % 3 == 0) {
          EXPECT_EQ(closed.all.indefinite, general.all.indefinite);
        }
        indefinite += closed.all.indefinite;
      }
    }
  }
  EXPECT_GT(indefinite, 100);
}

TEST(SystemIsotropic, ClosedFormOfASolid) {
  closed_form_agrees<NeoHookeanLaw>(box_tets({1, 1.2, 0.9}, {2, 2, 2}), {{"mu", {3.0}}, {"lambda", {7.0}}});
}

TEST(SystemIsotropic, ClosedFormOfAMembrane) { closed_form_agrees<MembraneLaw>(sheet(), {{"k", {5.0}}}); }

TEST(SystemIsotropic, ClosedFormOfALine) { closed_form_agrees<LineLaw>(line(), {{"k", {5.0}}}); }

TEST(SystemIsotropic, DisplacementsGiveWhatPositionsGive) {
  const Mesh mesh = box_tets({1, 1.2, 0.9}, {2, 2, 2});
  const Parameters params{{"mu", {3.0}}, {"lambda", {7.0}}};
  for (const int width : usable_widths()) {
    for (const Projection projection : {Projection::clamp, Projection::none}) {
      const Eigen::Matrix3Xd x = moved(mesh.X, 0.2, 0);
      const Result plain = evaluate(kernel_of<NeoHookeanLaw>(width), mesh, params, x, projection);
      const Result displaced = evaluate(kernel_of<Displaced<NeoHookeanLaw>>(width), mesh, params, x, projection);
      const Result closed =
          evaluate(kernel_of<Isotropic<Displaced<NeoHookeanLaw>>>(width), mesh, params, x, projection);
      for (const Result* other : {&displaced, &closed}) {
        EXPECT_NEAR(other->all.value, plain.all.value, 1e-13 * plain.all.value);
        EXPECT_LT(difference(other->gradient, plain.gradient), 1e-13);
        EXPECT_LT(difference(other->hessian, plain.hessian), 1e-12);
      }
    }
  }
}

// Two densities on the same vertices whose rest positions differ, each with its own displacements.
TEST(SystemIsotropic, RestPositionsMayDiffer) {
  const Mesh mesh = box_tets({1, 1, 1}, {1, 1, 1});
  Mesh grown = mesh;
  grown.X *= 1.25;
  const Parameters params{{"mu", {3.0}}, {"lambda", {7.0}}};
  const Eigen::Matrix3Xd x = moved(mesh.X, 0.2, 0);
  System both(mesh.vertices() + 3);
  Eigen::Matrix3Xd all = Eigen::Matrix3Xd::Zero(3, mesh.vertices() + 3);
  all.rightCols(mesh.vertices()) = x;
  both.add(Potential::on_mesh("small", kernel_of<Displaced<NeoHookeanLaw>>(1), mesh, 3, params));
  both.add(Potential::on_mesh("grown", kernel_of<Displaced<NeoHookeanLaw>>(1), grown, 3, params));
  const Evaluation sum = both.value(all);
  for (const auto& [rest, value] : {std::pair(mesh, sum.by_potential[0]), std::pair(grown, sum.by_potential[1])}) {
    System one(mesh.vertices());
    one.add(Potential::on_mesh("one", kernel_of<NeoHookeanLaw>(1), rest, 0, params));
    EXPECT_NEAR(one.value(x).value, value, 1e-13 * value);
  }
  System small(mesh.vertices());
  EXPECT_THROW(small.add(Potential::on_mesh("far", kernel_of<Displaced<NeoHookeanLaw>>(1), mesh, 3, params)),
               std::invalid_argument);
}

struct QuadraticLaw : NeoHookeanLaw {
  static constexpr int kDisplacement = 1;
  template <class T>
  static T psi(const T* q, const double*, const double* u) {
    return u[0] * (dot(q, q) + dot(q + 3, q + 3) + dot(q + 6, q + 6));
  }
};

// Strains of 1e-13 are seen in full: positions lose them.
TEST(SystemIsotropic, DisplacementsKeepSmallStrains) {
  Mesh mesh = box_tets({1, 1, 1}, {1, 1, 1});
  const double strain = 0x1p-43;
  Eigen::Matrix3Xd x = mesh.X;
  for (int v = 0; v < mesh.vertices(); ++v) x(0, v) += strain * mesh.X(1, v);
  System system(mesh.vertices());
  system.add(Potential::on_mesh("law", kernel_of<QuadraticLaw>(1), mesh, 0, {{"mu", {1.0}}, {"lambda", {1.0}}}));
  EXPECT_DOUBLE_EQ(system.value(x).value, strain * strain);
}

}  // namespace
}  // namespace ergon
