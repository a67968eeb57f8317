// Principal stretches in the language and in the reference.

#include "symbolic/stretches.h"

#include <gtest/gtest.h>

#include <cmath>

#include "symbolic/reference.h"
#include "symbolic/singular_values.h"

namespace ergon {
namespace {

Energy density(const std::string& geometry, const std::string& lines) {
  const char* unit = geometry == "solid" ? "Pa" : geometry == "membrane" ? "N/m" : "N";
  return parse_energy("density law " + geometry + "\nparam k " + unit + " (0, inf) stiffness\n" + lines + "\n",
                      "law.energy");
}

// The same function in stretches and in F itself: value, gradient and Hessian, also where stretches are equal, zero or
// of opposite sign.
void expect_same(const std::string& geometry, const std::string& stretches, const std::string& direct,
                 const std::vector<std::vector<double>>& states) {
  const Energy a = density(geometry, stretches), b = density(geometry, direct);
  for (const std::vector<double>& F : states) {
    const Inputs inputs = {{"F", F}, {"k", {3}}};
    const ReferenceValue x = evaluate_reference(a, "", inputs), y = evaluate_reference(b, "", inputs);
    EXPECT_NEAR(x.value, y.value, 1e-14 * (1 + std::abs(y.value)));
    for (size_t i = 0; i < y.gradient.size(); ++i) EXPECT_NEAR(x.gradient[i], y.gradient[i], 1e-13);
    for (size_t i = 0; i < y.hessian.size(); ++i) EXPECT_NEAR(x.hessian[i], y.hessian[i], 1e-12);
  }
}

const std::vector<std::vector<double>> solids = {{1, 0, 0, 0, 1, 0, 0, 0, 1},
                                                 {0, 2, 0, -2, 0, 0, 0, 0, 2},
                                                 {1.2, 0.1, -0.3, 0.2, 0.9, 0.4, 0.1, -0.2, 1.1},
                                                 {-1.2, 0.1, -0.3, 0.2, 0.9, 0.4, 0.1, -0.2, 1.1},
                                                 {1, 0, 0, 0, 1, 0, 0, 0, -1},
                                                 {0, 0, 0, 0, 0, 0, 0, 0, 0},
                                                 {2, 0, 0, 4, 0, 0, 0, 0, 0}};

TEST(Stretches, PolynomialsAgreeWithInvariantsOfF) {
  expect_same("solid", "let s = stretches(F)\nvalue k*norm2(s)", "value k*norm2(F)", solids);
  expect_same("solid", "let s = stretches(F)\nvalue k*s[0]*s[1]*s[2]", "value k*det(F)", solids);
  expect_same("solid", "let s = stretches(F)\nvalue k*(s[0]^4 + s[1]^4 + s[2]^4)", "value k*norm2(F'*F)", solids);
  const std::vector<std::vector<double>> membranes = {
      {1, 0, 0, 0, 1, 0}, {0, 0, 3, 0, 3, 0}, {1.2, 0.1, -0.3, 0.2, 0.9, 0.4}, {1, 1, 0, 2, 2, 0}, {0, 0, 0, 0, 0, 0}};
  expect_same("membrane", "let s = stretches(F)\nvalue k*norm2(s)^2", "value k*norm2(F)^2", membranes);
  expect_same("membrane", "let s = stretches(F)\nvalue k*(s[0]*s[1])^2", "value k*det(F'*F)", membranes);
  expect_same("line", "value k*(stretches(F) - 1)^2", "value k*(norm(F) - 1)^2", {{1, 0, 0}, {0.5, -2, 1}});
}

TEST(Stretches, TheSmallestHasTheSignOfTheDeterminant) {
  const auto last = [](const std::vector<double>& F) { return decompose(F, 1.0, 0x1p-50).s[2]; };
  EXPECT_NEAR(last({1, 0, 0, 0, 2, 0, 0, 0, 3}), 1, 1e-15);
  EXPECT_NEAR(last({1, 0, 0, 0, -2, 0, 0, 0, 3}), -1, 1e-15);
  EXPECT_NEAR(last({-1, 0, 0, 0, -2, 0, 0, 0, 3}), 1, 1e-15);
  EXPECT_EQ(last({0, 0, 0, 0, 0, 0, 0, 0, 0}), 0);
}

std::string fault(const std::string& lines) {
  const auto finding = check_stretches(density("solid", lines), "");
  return finding && finding->severity == Severity::error ? finding->message : "";
}

TEST(Stretches, ALawMustBeSymmetricInThem) {
  EXPECT_EQ(fault("let s = stretches(F)\nvalue k*(s[0] - 1)^2 + k*(s[1] - 1)^2 + 2*k*(s[2] - 1)^2"),
            "the value is not symmetric in the stretches: with 1.42759, 1.08944, 0.366694 it is 0.744742, with "
            "0.366694, 1.08944, 1.42759 it is 0.581062 Pa; each must enter as "
            "the others do");
  EXPECT_EQ(fault("let s = stretches(F)\nvalue k*(s[0] + s[1] + s[2])*F[0, 0]^2"),
            "a density that calls `stretches` is a function of them alone, but this one sees more of F: the value "
            "changes when F is turned on either side; beside `stretches` use det(F), norm2(F) and the like, and put "
            "what has a direction into an energy of its own");
  EXPECT_EQ(fault("let s = stretches(F)\nvalue k*(s[0] + s[1] + s[2])^2 + k*det(F)^2"), "");
  EXPECT_FALSE(check_stretches(density("solid", "value k*F[0, 0]"), "").has_value());
}

}  // namespace
}  // namespace ergon
