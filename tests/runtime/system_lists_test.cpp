// Lists of stencils that change from call to call, as those of contact do.

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <random>

#include "runtime/lanes/lanes.h"
#include "runtime/mesh/mesh_build.h"
#include "runtime/system.h"
#include "tests/runtime/count_allocations.h"
#include "tests/runtime/dense_oracle.h"

namespace ergon {
namespace {

using namespace testing;  // NOLINT

const Parameters kHingeParams{{"k", {2.5}}};

struct List {
  std::vector<int> stencils;
  StencilData rest;
};

// A solid, inertia and hinges among any of its vertices.
struct Changing {
  Mesh mesh;
  Eigen::Matrix3Xd x;
  System system;
  std::mt19937 random{9};
  Eigen::Matrix3Xd gradient;
  BlockMatrix matrix;

  explicit Changing(int cells, int width = lanes::best_lanes())
      : mesh(box_tets({1, 1, 1}, {cells, cells, cells})), x(mesh.X), system(mesh.vertices()) {
    std::vector<int> points(static_cast<size_t>(mesh.vertices()));
    std::iota(points.begin(), points.end(), 0);
    for (const int v : points) x.col(v) += 0.1 * Eigen::Vector3d(std::sin(13.0 * v), std::sin(17.0 * v), std::sin(v));
    system.add(Potential::on_mesh("solid", kernel_of<NeoHookeanLaw>(width), mesh, 0, {{"mu", {3}}, {"lambda", {7}}}));
    system.add(Potential::on_stencils("hinges", kernel_of<HingeLaw>(width), {}, mesh.X, kHingeParams, {{"area", {}}}));
    system.add(Potential::on_stencils("inertia", kernel_of<InertiaLaw>(width), points, mesh.X, {},
                                      {{"mass", std::vector<double>(points.size(), 2.0)}}));
    system.potential(2).set_lag("dt", {0.5});
    system.potential(2).set_lag("xhat", {0, 0, 0});
  }
  // Hinges of vertices that are no further apart than `reach` by number.
  List hinges(int count, int reach) {
    List list;
    const int n = mesh.vertices();
    for (int i = 0; i < count; ++i) {
      std::vector<int> near(static_cast<size_t>(reach));
      std::iota(near.begin(), near.end(), static_cast<int>(random() % static_cast<unsigned>(n - reach)));
      std::shuffle(near.begin(), near.end(), random);
      list.stencils.insert(list.stencils.end(), near.begin(), near.begin() + 4);
      list.rest["area"].push_back(1 + 0.1 * (i % 7));
    }
    list.rest["area"].resize(static_cast<size_t>(count));
    return list;
  }
  void set(const List& list) { system.potential(1).set_stencils(list.stencils, mesh.X, list.rest); }
  void expect_dense(const List& list) {
    system.hessian(x, Projection::clamp, gradient, matrix);
    Dense dense(mesh.vertices());
    dense.add_solid<NeoHookeanLaw>(x, mesh, 0, {3, 7}, Projection::clamp);
    dense.add_stencils<HingeLaw>(x, list.stencils, list.rest.at("area"), {2.5}, Projection::clamp);
    dense.hessian.diagonal().array() += 2 / 0.25;
    EXPECT_LT(difference(to_dense(matrix), dense.hessian), 1e-12);
  }
};

TEST(SystemLists, MatrixEqualsTheDenseSumAfterEveryChange) {
  for (const int width : {1, lanes::best_lanes()}) {
    Changing scene(2, width);
    for (const int count : {0, 5, 40, 3, 60, 0, 60}) {
      const List list = scene.hinges(count, 8);
      scene.set(list);
      scene.expect_dense(list);
    }
    const List last = scene.hinges(20, 8);
    scene.set(last);
    scene.system.set_fixed(std::vector<char>(static_cast<size_t>(scene.mesh.vertices()), 0));
    scene.expect_dense(last);
  }
}

TEST(SystemLists, CouplingsStayForAWhile) {
  Changing scene(2);
  const auto couples = [&](int i, int j) {
    scene.system.hessian(scene.x, Projection::clamp, scene.gradient, scene.matrix);
    return scene.matrix.index_of(i, j) >= 0;
  };
  const List first{{0, 26, 1, 2}, {{"area", {1}}}}, second{{0, 25, 1, 2}, {{"area", {1}}}};
  scene.set(first);
  EXPECT_TRUE(couples(26, 0));
  const unsigned long pattern = scene.matrix.pattern_id();
  // Another coupling makes a new pattern, in which those of the last list stay; the next one drops them.
  scene.set(second);
  EXPECT_TRUE(couples(26, 0));
  EXPECT_TRUE(couples(25, 0));
  EXPECT_GT(scene.matrix.pattern_id(), pattern);
  scene.set({{0, 24, 1, 2}, {{"area", {1}}}});
  EXPECT_FALSE(couples(26, 0));
  EXPECT_TRUE(couples(25, 0));
  // One that nothing replaces goes in the end.
  const unsigned long last = scene.matrix.pattern_id();
  const List none{{}, {{"area", {}}}};
  int changes = 0;
  for (; couples(24, 0) && changes < 100; ++changes) {
    EXPECT_EQ(scene.matrix.pattern_id(), last);
    scene.set(none);
  }
  EXPECT_EQ(changes, 33);
  const unsigned long clean = scene.matrix.pattern_id();
  for (int i = 0; i < 100; ++i) scene.set(none), couples(0, 0);
  EXPECT_EQ(scene.matrix.pattern_id(), clean);
  scene.expect_dense(none);
}

TEST(SystemLists, ResultsDoNotDependOnTheNumberOfThreads) {
  const int before = omp_get_max_threads();
  std::vector<std::vector<double>> first;
  for (const int threads : {1, 2, 3}) {
    omp_set_num_threads(threads);
    Changing scene(9);
    for (size_t round = 0; round < 4; ++round) {
      scene.set(scene.hinges(round == 2 ? 5000 : 9000, 30));
      scene.system.hessian(scene.x, Projection::clamp, scene.gradient, scene.matrix);
      std::vector<double> all = scene.matrix.values();
      all.insert(all.end(), scene.gradient.data(), scene.gradient.data() + scene.gradient.size());
      if (threads == 1) {
        first.push_back(all);
      } else {
        ASSERT_EQ(all.size(), first[round].size());
        EXPECT_EQ(std::memcmp(all.data(), first[round].data(), all.size() * sizeof(double)), 0);
      }
    }
  }
  omp_set_num_threads(before);
}

TEST(SystemLists, AskForNoMemoryOnceTheyWereThisLong) {
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  Changing scene(6);
  const auto iterate = [&](const List& list) {
    scene.set(list);
    scene.system.value(scene.x);
    scene.system.hessian(scene.x, Projection::clamp, scene.gradient, scene.matrix);
  };
  for (int i = 0; i < 9; ++i) iterate(scene.hinges(300, 300));
  for (int i = 0; i < 5; ++i) {
    const List list = scene.hinges(i < 3 ? 300 : 290, 300);
    const unsigned long pattern = scene.matrix.pattern_id();
    const long asked = allocations();
    iterate(list);
    EXPECT_EQ(allocations() - asked, 0);
    EXPECT_GT(scene.matrix.pattern_id(), pattern);
  }
  omp_set_num_threads(before);
}

TEST(PotentialValues, AreInOrderHoweverMany) {
  PotentialValues values;
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(values.size(), static_cast<size_t>(i));
    values.push_back(i);
    const PotentialValues copy = values;
    std::vector<double> expected(static_cast<size_t>(i) + 1);
    std::iota(expected.begin(), expected.end(), 0);
    EXPECT_EQ(std::vector<double>(copy.begin(), copy.end()), expected);
    EXPECT_EQ(copy[static_cast<size_t>(i)], i);
  }
}

}  // namespace
}  // namespace ergon
