// Divided differences by algebra, against the quotient and the derivative in more digits than a double has.

#include "codegen/divided_difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "codegen/interpret.h"

namespace ergon {
namespace {

using Exact = long double;
using Build = std::function<NodeId(Graph&, NodeId, NodeId)>;

// D of the node that `build` makes of the inputs, at (a, b).
double difference(const Build& build, double a, double b) {
  Graph g;
  const NodeId x = g.input(Source::stretch, 0), y = g.input(Source::stretch, 1);
  const NodeId d = DividedDifference(g, x, y).of(build(g, x, y));
  verify(g);
  return interpret(g, {d}, {.stretch = {a, b}})[0];
}

struct Case {
  const char* name;
  Build build;
  std::function<Exact(Exact, Exact)> value;
  std::function<Exact(Exact)> slope;  // of D at equal inputs
};

// Equal inputs; 1e-13 apart, where the plain quotient keeps three digits; far apart.
void expect_exact(const Case& c) {
  for (const double a : {0.3, 1.0, 2.5}) {
    EXPECT_NEAR(difference(c.build, a, a), static_cast<double>(c.slope(a)), 4e-15 * std::abs(double(c.slope(a))))
        << c.name << " at " << a;
    for (const double b : {a * (1 + 1e-13), a * (1 - 3e-9), 1.1 * a, 7.0}) {
      const Exact middle = (Exact(a) + b) / 2;
      const Exact expected =
          std::abs(a - b) < 1e-6 ? c.slope(middle) : (c.value(a, b) - c.value(b, a)) / (Exact(a) - Exact(b));
      EXPECT_NEAR(difference(c.build, a, b), static_cast<double>(expected), 2e-14 * std::abs(double(expected)))
          << c.name << " at " << a << ", " << b;
    }
  }
}

TEST(DividedDifferenceTest, FunctionsOfOneInput) {
  expect_exact({"cube", [](Graph& g, NodeId x, NodeId) { return g.power(x, 3); },
                [](Exact x, Exact) { return x * x * x; }, [](Exact x) { return 3 * x * x; }});
  expect_exact({"inverse square", [](Graph& g, NodeId x, NodeId) { return g.power(x, -2); },
                [](Exact x, Exact) { return 1 / (x * x); }, [](Exact x) { return -2 / (x * x * x); }});
  expect_exact({"root", [](Graph& g, NodeId x, NodeId) { return g.power(x, 1, 2); },
                [](Exact x, Exact) { return std::sqrt(x); }, [](Exact x) { return 1 / (2 * std::sqrt(x)); }});
  expect_exact({"inverse root cubed", [](Graph& g, NodeId x, NodeId) { return g.power(x, -3, 2); },
                [](Exact x, Exact) { return 1 / (x * std::sqrt(x)); },
                [](Exact x) { return -3 / (2 * x * x * std::sqrt(x)); }});
  expect_exact({"cube root", [](Graph& g, NodeId x, NodeId) { return g.power(x, 1, 3); },
                [](Exact x, Exact) { return std::cbrt(x); }, [](Exact x) { return std::cbrt(x) / (3 * x); }});
  expect_exact({"log", [](Graph& g, NodeId x, NodeId) { return g.call(Call::log, {x}); },
                [](Exact x, Exact) { return std::log(x); }, [](Exact x) { return 1 / x; }});
  expect_exact({"log1p", [](Graph& g, NodeId x, NodeId) { return g.call(Call::log1p, {x}); },
                [](Exact x, Exact) { return std::log1p(x); }, [](Exact x) { return 1 / (1 + x); }});
  expect_exact({"exp", [](Graph& g, NodeId x, NodeId) { return g.call(Call::exp, {x}); },
                [](Exact x, Exact) { return std::exp(x); }, [](Exact x) { return std::exp(x); }});
  expect_exact({"pow",
                [](Graph& g, NodeId x, NodeId) {
                  return g.call(Call::pow, {x, g.constant(1.3)});
                },
                [](Exact x, Exact) { return std::pow(x, Exact(1.3)); },
                [](Exact x) { return Exact(1.3) * std::pow(x, Exact(1.3) - 1); }});
}

TEST(DividedDifferenceTest, ProductsAndSumsOfBothInputs) {
  // x^2 y: what both hold is taken out.
  expect_exact({"x^2 y",
                [](Graph& g, NodeId x, NodeId y) {
                  return g.product(1, {{x, 2}, {y}});
                },
                [](Exact x, Exact y) { return x * x * y; }, [](Exact x) { return x * x; }});
  expect_exact({"log(x)/y", [](Graph& g, NodeId x, NodeId y) { return g.divide(g.call(Call::log, {x}), y); },
                [](Exact x, Exact y) { return std::log(x) / y; }, [](Exact x) { return (1 + std::log(x)) / (x * x); }});
}

// What is symmetric has no difference, and costs nothing.
TEST(DividedDifferenceTest, SymmetricNodesVanish) {
  Graph g;
  const NodeId x = g.input(Source::stretch, 0), y = g.input(Source::stretch, 1);
  DividedDifference d(g, x, y);
  EXPECT_TRUE(g.is_constant(d.of(g.multiply(x, y)), 0));
  EXPECT_TRUE(g.is_constant(d.of(g.add(g.call(Call::log, {x}), g.call(Call::log, {y}))), 0));
  EXPECT_TRUE(g.is_constant(d.of(g.input(Source::param, 0)), 0));
}

// max(x - 1, 0)^2 with its switch at 1: both above, both below, one of each.
TEST(DividedDifferenceTest, Switches) {
  const Build build = [](Graph& g, NodeId x, NodeId) {
    return g.power(g.call(Call::max, {g.sum(-1, {{1, x}}), g.constant(0)}), 2);
  };
  EXPECT_NEAR(difference(build, 1.5, 1.5), 1, 1e-15);
  EXPECT_NEAR(difference(build, 1.5, 1.25), 0.75, 1e-15);
  EXPECT_EQ(difference(build, 0.5, 0.25), 0);
  EXPECT_NEAR(difference(build, 1.5, 0.5), 0.25, 1e-15);
}

TEST(DividedDifferenceTest, AFunctionWithoutAFormIsNamed) {
  Graph g;
  const NodeId x = g.input(Source::stretch, 0), y = g.input(Source::stretch, 1);
  try {
    DividedDifference(g, x, y).of(g.call(Call::atan, {x}));
    FAIL() << "no exception";
  } catch (const DividedDifference::UnknownDifference& unknown) {
    EXPECT_EQ(unknown.function, "atan");
  }
}

}  // namespace
}  // namespace ergon
