// Vertices carried by affine bodies, against the dense sum over all vertices and J^T H J of dense matrices.

#include "runtime/carriers.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <numeric>
#include <random>

#include "runtime/lanes/lanes.h"
#include "runtime/system.h"
#include "tests/runtime/count_allocations.h"
#include "tests/runtime/dense_oracle.h"
#include "tests/runtime/mesh_helpers.h"

namespace ergon {
namespace {

using namespace testing;  // NOLINT

constexpr int kVertices = 40;

// Bodies with control points 20 to 23 and 36 to 39 carry vertices 0 to 9 and 10 to 16; three others are fixed.
struct Carried {
  std::mt19937 random{5};
  std::normal_distribution<double> normal;
  Eigen::Matrix3Xd x{3, kVertices};
  Carriers carriers;
  std::vector<char> fixed = std::vector<char>(kVertices, 0);
  std::vector<int> free;
  Eigen::MatrixXd J;  // from free to all vertices, components

  Carried() {
    for (double& v : x.reshaped()) v = normal(random);
    carriers.add_body(20);
    carriers.add_body(36);
    for (int v = 0; v < 17; ++v) {
      std::array<double, 4> w{1, normal(random), normal(random), normal(random)};
      for (size_t k = 1; k < 4; ++k) w[0] -= w[k];
      carriers.carry(v, v < 10 ? 0 : 1, w);
    }
    for (const size_t v : {17, 18, 24}) fixed[v] = 1;
    carriers.place(x);
    for (int v = 17; v < kVertices; ++v) {
      if (fixed[static_cast<size_t>(v)] == 0) free.push_back(v);
    }
    J.setZero(3 * kVertices, 3 * static_cast<Eigen::Index>(free.size()));
    for (size_t i = 0; i < free.size(); ++i) {
      Eigen::Matrix3Xd unit = Eigen::Matrix3Xd::Zero(3, kVertices);
      for (int c = 0; c < 3; ++c) {
        unit.setZero();
        unit(c, free[i]) = 1;
        carriers.place(unit);
        J.col(3 * static_cast<Eigen::Index>(i) + c) = unit.reshaped();
      }
    }
  }
  std::vector<int> stencils(int count, int points) {
    std::vector<int> all, order(kVertices);
    std::iota(order.begin(), order.end(), 0);
    for (int i = 0; i < count; ++i) {
      std::shuffle(order.begin(), order.end(), random);
      all.insert(all.end(), order.begin(), order.begin() + points);
    }
    return all;
  }
  std::vector<double> numbers(size_t count) {
    std::vector<double> all(count);
    for (double& v : all) v = normal(random);
    return all;
  }
};

TEST(Carriers, PlaceAndCollectAreTransposes) {
  Carried c;
  Eigen::Matrix3Xd field(3, kVertices), gradient(3, kVertices);
  for (double& v : field.reshaped()) v = c.normal(c.random);
  for (double& v : gradient.reshaped()) v = c.normal(c.random);
  c.carriers.place(field);
  const double work = (field.reshaped().array() * gradient.reshaped().array()).sum();
  c.carriers.collect(gradient);
  double collected = 0;
  for (int v = 17; v < kVertices; ++v) collected += field.col(v).dot(gradient.col(v));
  EXPECT_NEAR(work, collected, 1e-12 * std::abs(work) + 1e-12);
}

TEST(SystemCarried, AgreesWithTheDenseSum) {
  for (const int width : {1, 4, 8}) {
    if (width > lanes::best_lanes()) continue;
    Carried c;
    System system(kVertices);
    system.set_fixed(c.fixed);
    system.set_carriers(c.carriers);
    EXPECT_EQ(system.free_vertices(), static_cast<int>(c.free.size()));
    const std::vector<int> hinges = c.stencils(300, 4), bends = c.stencils(70, 3);
    const std::vector<double> area = c.numbers(300);
    std::vector<int> points(kVertices);
    std::iota(points.begin(), points.end(), 0);
    system.add(
        Potential::on_stencils("hinge", kernel_of<HingeLaw>(width), hinges, c.x, {{"k", {0.5}}}, {{"area", area}}));
    system.add(Potential::on_stencils("bend", kernel_of<BendLaw>(width), bends, c.x, {}, {}));
    system.add(Potential::on_stencils("inertia", kernel_of<InertiaLaw>(width), points, c.x, {},
                                      {{"mass", std::vector<double>(kVertices, 3.0)}}));
    system.potential(2).set_lag("dt", {0.5});
    system.potential(2).set_lag("xhat", {1, 2, 3});
    system.add(Potential::on_combinations("combined", kernel_of<BendLaw>(width), 5, {}));
    for (const int combined : {0, 40, 9}) {
      const std::vector<int> fives = c.stencils(combined, 5);
      const std::vector<double> weights = c.numbers(fives.size() * 2);
      system.potential(3).set_combinations(fives, weights, {});
      for (const Projection projection : {Projection::clamp, Projection::none}) {
        Dense dense(kVertices);
        dense.add_stencils<HingeLaw>(c.x, hinges, area, {0.5}, projection);
        dense.add_stencils<BendLaw>(c.x, bends, {}, {}, projection);
        std::vector<double> raw;
        for (int v = 0; v < kVertices; ++v) raw.insert(raw.end(), {3, 0.5, 1, 2, 3});
        dense.add_stencils<InertiaLaw>(c.x, points, raw, {}, projection);
        for (int s = 0; s < combined; ++s) {
          const Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>> w(weights.data() + s * 10, 2, 5);
          dense.add<BendLaw>(c.x, fives.data() + s * 5, w, 1, nullptr, nullptr, projection);
        }
        Eigen::Matrix3Xd gradient;
        BlockMatrix matrix;
        const Evaluation at = system.hessian(c.x, projection, gradient, matrix);
        EXPECT_NEAR(at.value, dense.value, 1e-12 * std::abs(dense.value));
        EXPECT_LT(difference(to_dense(matrix), c.J.transpose() * dense.hessian * c.J), 1e-12);
        const Eigen::VectorXd expected = c.J.transpose() * dense.gradient;
        const auto check_gradient = [&] {
          for (size_t i = 0; i < c.free.size(); ++i) {
            EXPECT_LT((gradient.col(c.free[i]) - expected.segment<3>(3 * static_cast<Eigen::Index>(i))).norm(),
                      1e-12 * expected.norm());
          }
          // That of a carried vertex is its own.
          EXPECT_LT((gradient.col(3) - dense.gradient.segment<3>(9)).norm(), 1e-12 * expected.norm());
        };
        check_gradient();
        system.gradient(c.x, gradient);
        check_gradient();
      }
    }
  }
}

// The energy as a function of the control points: central differences of the value and of the gradient.
TEST(SystemCarried, DerivativesAreThoseOfTheComposedEnergy) {
  Carried c;
  System system(kVertices);
  system.set_fixed(c.fixed);
  system.set_carriers(c.carriers);
  system.add(Potential::on_stencils("hinge", kernel_of<HingeLaw>(1), c.stencils(50, 4), c.x, {{"k", {0.01}}},
                                    {{"area", c.numbers(50)}}));
  Eigen::Matrix3Xd gradient, above, below;
  BlockMatrix matrix;
  system.hessian(c.x, Projection::none, gradient, matrix);
  const Eigen::MatrixXd H = to_dense(matrix);
  const double step = 1e-5;
  for (const int v : {20, 22, 25, 39}) {
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Matrix3Xd high = c.x, low = c.x;
      high(axis, v) += step;
      low(axis, v) -= step;
      c.carriers.place(high);
      c.carriers.place(low);
      EXPECT_NEAR((system.value(high).value - system.value(low).value) / (2 * step), gradient(axis, v),
                  1e-6 * gradient.norm());
      system.gradient(high, above);
      system.gradient(low, below);
      for (const int u : c.free) {
        const Eigen::Vector3d column = (above.col(u) - below.col(u)) / (2 * step);
        EXPECT_LT((column - H.block<3, 1>(3 * system.block_of(u), 3 * system.block_of(v) + axis)).norm(),
                  1e-6 * H.norm());
      }
    }
  }
}

TEST(SystemCarried, ResultsDoNotDependOnTheNumberOfThreads) {
  const int before = omp_get_max_threads();
  std::vector<double> first;
  for (const int threads : {1, 3}) {
    omp_set_num_threads(threads);
    Carried c;
    System system(kVertices);
    system.set_fixed(c.fixed);
    system.set_carriers(c.carriers);
    system.add(Potential::on_stencils("hinge", kernel_of<HingeLaw>(lanes::best_lanes()), c.stencils(6000, 4), c.x,
                                      {{"k", {0.5}}}, {{"area", c.numbers(6000)}}));
    Eigen::Matrix3Xd gradient;
    BlockMatrix matrix;
    system.hessian(c.x, Projection::clamp, gradient, matrix);
    if (first.empty()) first = matrix.values();
    EXPECT_EQ(first, matrix.values());
  }
  omp_set_num_threads(before);
}

TEST(SystemCarried, AsksForNoMemoryOnceListsWereThisLong) {
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  Carried c;
  System system(kVertices);
  system.set_fixed(c.fixed);
  system.set_carriers(c.carriers);
  const int hinge = system.add(Potential::on_stencils("hinge", kernel_of<HingeLaw>(lanes::best_lanes()), {}, c.x,
                                                      {{"k", {0.5}}}, {{"area", {}}}));
  std::vector<std::vector<int>> lists;
  for (int i = 0; i < 9; ++i) lists.push_back(c.stencils(300 - i, 4));
  Eigen::Matrix3Xd gradient;
  BlockMatrix matrix;
  const auto iterate = [&](size_t i) {
    system.potential(hinge).set_stencils(lists[i], c.x, {{"area", std::vector<double>(lists[i].size() / 4, 1.0)}});
    const long asked = allocations();
    system.hessian(c.x, Projection::clamp, gradient, matrix);
    return allocations() - asked;
  };
  for (int round = 0; round < 4; ++round) {
    for (size_t i = 0; i < lists.size(); ++i) iterate(i);
  }
  for (size_t i = 0; i < lists.size(); ++i) EXPECT_EQ(iterate(i), 0) << i;
  omp_set_num_threads(before);
}

// What one must push a vertex with, the others and the other bodies held.
TEST(SystemCarried, StiffnessIsThatOfTheBodyAtTheVertex) {
  Carried c;
  System system(kVertices);
  system.set_fixed(c.fixed);
  system.set_carriers(c.carriers);
  const std::vector<int> points = {20, 21, 22, 23, 25, 36, 37, 38, 39};
  std::vector<int> controls_and_free(points);
  for (const int v : {19, 26, 27, 28, 29, 30, 31, 32, 33, 34, 35}) controls_and_free.push_back(v);
  system.add(Potential::on_stencils("inertia", kernel_of<InertiaLaw>(1), controls_and_free, c.x, {},
                                    {{"mass", std::vector<double>(controls_and_free.size(), 3.0)}}));
  system.potential(0).set_lag("dt", {0.5});
  system.potential(0).set_lag("xhat", {0, 0, 0});
  Eigen::Matrix3Xd gradient;
  BlockMatrix matrix;
  system.hessian(c.x, Projection::clamp, gradient, matrix);
  EXPECT_NEAR(system.stiffness_at(25, matrix), 12, 1e-12);
  EXPECT_EQ(system.stiffness_at(17, matrix), 0);
  double squares = 0;
  for (const double w : c.carriers.carried()[4].weights) squares += w * w;
  EXPECT_NEAR(system.stiffness_at(4, matrix), 12 / squares, 1e-12);
}

TEST(SystemCarried, RefusesWhatCannotBe) {
  Carried c;
  System system(kVertices);
  std::vector<char> fixed = c.fixed;
  fixed[3] = 1;
  system.set_fixed(fixed);
  EXPECT_EQ(message_of([&] { system.set_carriers(c.carriers); }),
            "vertex 3 cannot be carried: it is fixed, carried or not there");
  fixed[3] = 0;
  fixed[22] = 1;
  system.set_fixed(fixed);
  EXPECT_EQ(message_of([&] { system.set_carriers(c.carriers); }),
            "vertex 22 cannot be a control point: it is fixed, carried or not there");
  system.set_fixed(c.fixed);
  c.carriers.carry(4, 0, {1, 0, 0, 0});
  EXPECT_EQ(message_of([&] { system.set_carriers(c.carriers); }),
            "vertex 4 cannot be carried: it is fixed, carried or not there");
}

}  // namespace
}  // namespace ergon
