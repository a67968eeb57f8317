// The natural cubic spline of the language against closed forms, at its knots and beyond its ends.

#include <gtest/gtest.h>

#include "symbolic/checks.h"
#include "symbolic/reference.h"

namespace ergon {
namespace {

Energy of_table(const std::string& knots, const std::string& values) {
  return parse_energy("energy e point\ndof x m\nparam k J\nparam L m\nlet y = x/L\nvalue k*(spline(y[0], " + knots +
                          ", " + values + ") + 0*y[1])\n",
                      "e.energy");
}

ReferenceValue spline_at(const Energy& energy, double x) {
  return evaluate_reference(energy, "", {{"x", {x, 0, 0}}, {"k", {1}}, {"L", {1}}});
}

// Through (0, 0), (1, 1), (2, 0) it has the second derivative -3 at 1: (3 x - x^3)/2 on the left, and its mirror image.
TEST(Spline, IsThatOfItsClosedForm) {
  const Energy arch = of_table("[0, 1, 2]", "[0, 1, 0]");
  for (const double x : {0.0, 0.25, 0.5, 1.0, 1.5, 2.0}) {
    const double u = x > 1 ? 2 - x : x, side = x > 1 ? -1 : 1;
    const ReferenceValue at = spline_at(arch, x);
    EXPECT_DOUBLE_EQ(at.value, (3 * u - u * u * u) / 2) << x;
    EXPECT_DOUBLE_EQ(at.gradient[0], side * (3 - 3 * u * u) / 2) << x;
    EXPECT_DOUBLE_EQ(at.hessian[0], -3 * u) << x;
  }
}

TEST(Spline, GoesOnStraightBeyondItsEnds) {
  const Energy arch = of_table("[0, 1, 2]", "[0, 1, 0]");
  for (const double beyond : {1e-3, 1.0, 1e6}) {
    for (const ReferenceValue& at : {spline_at(arch, -beyond), spline_at(arch, 2 + beyond)}) {
      EXPECT_NEAR(at.value, -1.5 * beyond, 1e-12 * beyond);
      EXPECT_DOUBLE_EQ(std::abs(at.gradient[0]), 1.5);
      EXPECT_EQ(at.hessian[0], 0);
    }
  }
}

// A table of a straight line gives it, at knots of any distance and two of them alike.
TEST(Spline, IsExactForStraightLines) {
  for (const auto& [knots, values] : {std::pair("[-1, 0, 0.5, 4]", "[-2, 0, 1, 8]"), std::pair("[-1, 4]", "[-2, 8]")}) {
    const Energy line = of_table(knots, values);
    for (const double x : {-3.0, -1.0, -0.3, 0.0, 0.5, 2.0, 4.0, 9.0}) {
      const ReferenceValue at = spline_at(line, x);
      EXPECT_NEAR(at.value, 2 * x, 1e-30);
      EXPECT_EQ(at.gradient[0], 2);
      EXPECT_EQ(at.hessian[0], 0);
    }
  }
}

// Its `min` and `max` are no kinks: `ergon check` finds value, gradient and Hessian alike on both sides of every knot.
TEST(Spline, IsTwiceDifferentiableForEveryTable) {
  const Energy table = parse_energy(
      "density e solid\nparam mu Pa (0, inf)\nparam W[4] 1\nvalue mu*spline(norm2(F) - 3, [-1, 0.25, 2, 7], W)\n",
      "e.energy");
  int smooth = 0;
  for (const Finding& finding : check_energy(table)) {
    if (finding.check != "smooth") continue;
    EXPECT_EQ(finding.severity, Severity::ok) << finding.message;
    ++smooth;
  }
  EXPECT_EQ(smooth, 1);
}

}  // namespace
}  // namespace ergon
