#include "symbolic/sliced.h"

#include <gtest/gtest.h>

#include "symbolic/reference.h"

namespace ergon {
namespace {

TEST(Sliced, HoldsWhatAPartIsMadeOfAndNoMore) {
  const Energy whole = parse_energy(R"(energy spring edge
dof      x0 x1  m
param    k      N/m
param    l      m
let      d = x1 - x0
let      length = norm(d)
let      pull = k*(length - l)
require  length > 0
value    pull*(length - l)/2
)",
                                    "spring.energy");
  const ExpressionPtr& length = whole.lets[1].expression;
  EXPECT_EQ(find_expression(whole, length->arguments[0].get()), length->arguments[0]);
  EXPECT_EQ(find_expression(whole, whole.require[0].left.get()), whole.require[0].left);
  const Energy part = sliced(whole, length);
  ASSERT_EQ(part.lets.size(), 1u);
  EXPECT_EQ(part.lets[0].name, "d");
  ASSERT_EQ(part.symbols.size(), 2u);
  EXPECT_EQ(part.symbols[1].name, "x1");
  EXPECT_TRUE(part.require.empty());
  EXPECT_EQ(evaluate_reference(part, "", {{"x0", {0, 0, 0}}, {"x1", {3, 0, 4}}}).value, 5);
}

}  // namespace
}  // namespace ergon
