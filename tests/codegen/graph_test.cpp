#include "codegen/graph.h"

#include <gtest/gtest.h>

#include <cmath>

#include "codegen/differentiate.h"
#include "codegen/factor.h"
#include "codegen/interpret.h"
#include "codegen/share.h"

namespace ergon {
namespace {

class GraphTest : public ::testing::Test {
 protected:
  Graph g;
  NodeId x = g.input(Source::q, 0), y = g.input(Source::q, 1), z = g.input(Source::q, 2);
  double at(NodeId id, std::vector<double> q = {1.25, -0.5, 3}) {
    return interpret(g, {id}, {{}, {}, {}, std::move(q)})[0];
  }
};

TEST_F(GraphTest, EqualExpressionsAreOneNode) {
  EXPECT_EQ(g.add(x, y), g.add(y, x));
  EXPECT_EQ(g.multiply(g.multiply(x, y), z), g.multiply(x, g.multiply(z, y)));
  EXPECT_EQ(g.multiply(x, x), g.power(x, 2));
  EXPECT_EQ(g.subtract(x, x), g.constant(0));
  EXPECT_EQ(g.divide(x, x), g.constant(1));
  EXPECT_EQ(g.power(g.subtract(x, y), 2), g.power(g.subtract(y, x), 2));
  EXPECT_EQ(g.scale(2, g.scale(0.5, x)), x);
}

TEST_F(GraphTest, SquareUnderARootKeepsItsSign) {
  NodeId root = g.power(g.power(y, 2), 1, 2);
  EXPECT_NE(root, y);
  EXPECT_DOUBLE_EQ(at(root), 0.5);
  EXPECT_EQ(g.power(g.power(x, 1, 2), 2), x);
  EXPECT_TRUE(std::isnan(at(g.power(g.scale(-4, x), 1, 2))));
}

TEST_F(GraphTest, NegativeFactorLeavesAnOddPower) {
  NodeId difference = g.subtract(y, x);
  EXPECT_DOUBLE_EQ(at(g.power(difference, 3)), std::pow(-1.75, 3));
  EXPECT_DOUBLE_EQ(at(g.multiply(difference, z)), -5.25);
  EXPECT_DOUBLE_EQ(at(g.sum(2, {{-1, difference}})), 3.75);
}

TEST_F(GraphTest, NormalFormIsVerified) {
  g.multiply(g.sum(1, {{2, x}, {-3, y}}), g.power(z, -1, 2));
  g.call(Call::select, {x, y, z});
  EXPECT_NO_THROW(verify(g));
}

TEST_F(GraphTest, CommonFactorsAreTakenOut) {
  NodeId a = g.call(Call::exp, {x});
  std::vector<Term> terms = {{1, g.multiply(g.multiply(a, y), z)}, {-1, g.multiply(a, x)}, {2, y}};
  NodeId factored = factored_sum(g, 0, terms);
  EXPECT_NEAR(at(factored), at(g.sum(0, terms)), 1e-14);
  // 2y + a*(...): two terms where there were three.
  EXPECT_EQ(g[g.unscaled(factored).node].terms.size(), 2u);
}

TEST_F(GraphTest, DerivativesOfEveryFunction) {
  NodeId small = g.scale(0.3, x);
  std::vector<NodeId> values = {g.call(Call::log, {x}),
                                g.call(Call::exp, {x}),
                                g.call(Call::log1p, {x}),
                                g.call(Call::expm1, {x}),
                                g.call(Call::sin, {x}),
                                g.call(Call::cos, {x}),
                                g.call(Call::tan, {x}),
                                g.call(Call::asin, {small}),
                                g.call(Call::acos, {small}),
                                g.call(Call::atan, {x}),
                                g.call(Call::atan2, {y, x}),
                                g.call(Call::pow, {x, z}),
                                g.call(Call::abs, {y}),
                                g.call(Call::min, {x, y}),
                                g.call(Call::max, {x, y}),
                                g.power(x, -3, 2),
                                g.power(x, 5),
                                g.call(Call::select, {y, x, g.power(z, 2)})};
  for (NodeId value : values) {
    Module m;
    m.graph = g;
    m.value = m.graph.multiply(value, g.is_constant(value) ? value : m.graph.power(value, 1));
    m.q_vectors = 1;
    differentiate(m);
    std::vector<double> q = {1.25, -0.5, 3};
    auto eval = [&](NodeId id, const std::vector<double>& p) { return interpret(m.graph, {id}, {{}, {}, {}, p})[0]; };
    for (size_t j = 0; j < 3; ++j) {
      std::vector<double> up = q, down = q;
      up[j] += 1e-5, down[j] -= 1e-5;
      double size = 1 + std::abs(eval(m.gradient[j], q)) + std::abs(eval(m.hessian[j * (j + 1) / 2 + j], q));
      EXPECT_NEAR(eval(m.gradient[j], q), (eval(m.value, up) - eval(m.value, down)) / 2e-5, 1e-7 * size)
          << to_string(g, {{value}});
      for (size_t i = j; i < 3; ++i)
        EXPECT_NEAR(eval(m.hessian[i * (i + 1) / 2 + j], q),
                    (eval(m.gradient[i], up) - eval(m.gradient[i], down)) / 2e-5, 1e-7 * size)
            << to_string(g, {{value}});
    }
  }
}

TEST(Share, TakesThePairThatMostProductsHold) {
  std::vector<std::vector<int>> lists = {{0, 1, 2}, {0, 1, 3}, {0, 1}, {2, 3}};
  auto taken = share_pairs(lists, 4);
  ASSERT_EQ(taken.size(), 1u);
  EXPECT_EQ(taken[0], std::pair(0, 1));
  EXPECT_EQ(lists[0], (std::vector<int>{4, 2}));
  EXPECT_EQ(lists[2], (std::vector<int>{4}));
  EXPECT_EQ(lists[3], (std::vector<int>{2, 3}));
}

TEST(Share, RepeatedFactorsAreSquares) {
  std::vector<std::vector<int>> lists = {{0, 0, 0, 0}, {0, 0, 1}};
  auto taken = share_pairs(lists, 2);
  ASSERT_GE(taken.size(), 1u);
  EXPECT_EQ(taken[0], std::pair(0, 0));
  EXPECT_EQ(lists[0], (std::vector<int>{2, 2}));
}

}  // namespace
}  // namespace ergon
