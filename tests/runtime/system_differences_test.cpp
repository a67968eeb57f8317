// Stencils whose q is differences from one point take a short way to their element matrix.

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "runtime/lanes/lanes.h"
#include "runtime/system.h"
#include "tests/runtime/dense_oracle.h"

namespace ergon {
namespace {

using namespace testing;  // NOLINT

// Differences from the second point, of either sign.
struct CornerLaw : HingeLaw {
  static constexpr std::array<double, 12> kWeights{0, 1, -1, 0, 0, 1, 0, -1, 1, -1, 0, 0};
};

// Nearly the same: two vectors lead to one point.
struct TwiceLaw : HingeLaw {
  static constexpr std::array<double, 12> kWeights{0, 1, -1, 0, 0, 1, -1, 0, 1, -1, 0, 0};
};

// Nearly the same: one vector is twice as long.
struct LongLaw : HingeLaw {
  static constexpr std::array<double, 12> kWeights{0, 1, -1, 0, 0, 2, 0, -2, 1, -1, 0, 0};
};

template <class Law>
void agrees_with_the_dense_sum() {
  constexpr int vertices = 30, count = 61;
  std::mt19937 random(17);
  std::normal_distribution<double> normal;
  Eigen::Matrix3Xd x(3, vertices);
  for (double& v : x.reshaped()) v = normal(random);
  std::vector<int> stencils, order(vertices);
  std::iota(order.begin(), order.end(), 0);
  std::vector<double> area;
  for (int i = 0; i < count; ++i) {
    std::shuffle(order.begin(), order.end(), random);
    stencils.insert(stencils.end(), order.begin(), order.begin() + 4);
    area.push_back(1 + 0.1 * i);
  }
  for (const int width : lanes::kWidths) {
    if (width > lanes::best_lanes()) continue;
    for (const Projection projection : {Projection::clamp, Projection::none}) {
      SCOPED_TRACE(width);
      Dense dense(vertices);
      dense.add_stencils<Law>(x, stencils, area, {2.5}, projection);
      System system(vertices);
      system.add(
          Potential::on_stencils("corner", kernel_of<Law>(width), stencils, x, {{"k", {2.5}}}, {{"area", area}}));
      Eigen::Matrix3Xd gradient;
      BlockMatrix matrix;
      system.hessian(x, projection, gradient, matrix);
      EXPECT_LT(difference(to_dense(matrix), dense.hessian), 1e-12);
      EXPECT_LT(difference(gradient.reshaped(), dense.gradient), 1e-12);
    }
  }
}

TEST(SystemDifferences, AgreeWithTheDenseSum) { agrees_with_the_dense_sum<CornerLaw>(); }
TEST(SystemDifferences, OnePointReachedTwiceIsNotOne) { agrees_with_the_dense_sum<TwiceLaw>(); }
TEST(SystemDifferences, AScaledDifferenceIsNotOne) { agrees_with_the_dense_sum<LongLaw>(); }

}  // namespace
}  // namespace ergon
