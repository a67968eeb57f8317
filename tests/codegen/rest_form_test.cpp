// Which energies are rewritten about rest, and into what.

#include "codegen/rest_form.h"

#include <gmock/gmock.h>

#include <cmath>

#include "codegen/interpret.h"
#include "codegen/lower.h"
#include "tests/codegen/evaluate_kernel.h"
#include "tests/paths.h"

namespace ergon::testing {
namespace {

struct Rewritten {
  Energy energy;
  Module module;
};

std::unique_ptr<Rewritten> rewritten(const std::string& statements, const std::string& geometry = "solid") {
  auto out = std::make_unique<Rewritten>();
  const std::string unit = geometry == "solid" ? "Pa" : geometry == "membrane" ? "N/m" : "N";
  const std::string power = statements.find("k") != std::string::npos ? "param k 1 (0, inf) power\n" : "";
  out->energy = parse_energy(
      "density law " + geometry + "\nparam a " + unit + " (0, inf) stiffness\n" + power + statements + "\n",
      "law.energy");
  out->module = lower(out->energy, "");
  rest_form(out->module);
  return out;
}

double value_at(const Module& m, NodeId node, const std::vector<double>& q) {
  return interpret(m.graph, {node}, {.params = {3, 1.7}, .raw = {}, .points = {}, .q = q, .stretch = {}})[0];
}

// F - I = size*N for a fixed N; the exact value by the reference.
void expect_digits(const std::string& statements, double size, const std::string& geometry = "solid") {
  const auto law = rewritten(statements, geometry);
  const Module& m = law->module;
  ASSERT_TRUE(m.displacement) << statements;
  const std::vector<double> direction = {0.3, -0.2, 0.5, 0.1, -0.4, 0.7, -0.6, 0.2, 0.25};
  std::vector<double> q;
  ExactInputs inputs = {{"a", {3}}};
  if (law->energy.find("k") != nullptr) inputs["k"] = {cln::rational(cln::cl_DF(1.7))};
  for (size_t i = 0; i < static_cast<size_t>(m.q_size()); ++i) {
    q.push_back(std::ldexp(std::round(std::ldexp(direction[i], 10)), -10) * size);
    inputs["F"].push_back((i % 4 == 0 ? 1 : 0) + cln::rational(cln::cl_DF(q[i])));
  }
  const double exact = evaluate_reference_at(law->energy, "", inputs).value;
  const bool near = m.near < 0 || value_at(m, m.near, q) > 0;
  EXPECT_NEAR(value_at(m, near ? m.value : m.far.value, q) / exact, 1, 1e-14) << statements << " at " << size;
}

TEST(RestForm, KeepsAllDigitsOfWhatVanishesAtRest) {
  for (const char* value : {"value a*(tr(F'*F) - 3 - 2*(det(F) - 1))", "value a*(tr(F'*F) - 3 - 2*log(det(F)))",
                            "value a*(tr(F'*F)*det(F)^(-2/3) - 3)",
                            "value a*(tr(F'*F)/sqrt(det(F)) - log(det(F))/2 - 3)", "value a*(exp(det(F) - 1) - det(F))",
                            "value a*(expm1(det(F) - 1) - log1p(det(F) - 1))", "value a*(det(F) + 1/det(F) - 2)",
                            "value a*norm2(F'*F - identity(3))", "value a*norm2(inverse(F'*F) - identity(3))",
                            "value a*(norm(F)/sqrt(3) - 1)^2", "value a*(det(F)^3 - 3*log(det(F)) - 1)"})
    for (const double size : {1e-9, 1e-5, 1e-2, 0.1}) expect_digits(value, size);
}

// sin(J - 1) - (J - 1) and the like lose all digits as written: of these functions too every part has a form that does
// not cancel.
TEST(RestForm, KeepsAllDigitsOfEveryFunctionThatIsSmoothAtRest) {
  for (const char* value :
       {"sin(J)^2 - 2*sin(1)*sin(J) + sin(1)^2", "1 - cos(J - 1)", "J - 1 - sin(J - 1) + (J - 1)^2",
        "cos(J) + sin(1)*(J - 1) - cos(1) + 2*(J - 1)^2", "tan(J) - tan(1) - (1 + tan(1)^2)*(J - 1)",
        "tan(J - 1) - sin(J - 1) + (J - 1)^2", "J - 1 - atan(J - 1) + (J - 1)^2", "abs(J)^2 - 2*J + 1",
        "max(J, 1/2) - log(J) - 1", "min(J - 1, 3)*(J - 1)", "J^k - k*log(J) - 1", "pow(J, 1/k) - log(J)/k - 1"})
    for (const double size : {1e-9, 1e-5, 1e-2, 0.1})
      expect_digits(std::string("let J = det(F)\nvalue a*(") + value + ")", size);
}

// A law of one side is exact on both, and 0 on one.
TEST(RestForm, LawsOfOneSideKeepTheirDigits) {
  for (const char* value : {"max(1 - det(F), 0)^2", "abs(det(F) - 1)^3", "min(det(F), 1)^2 - 2*min(det(F), 1) + 1"})
    for (const double size : {1e-9, 1e-5, 1e-2, 0.1}) expect_digits(std::string("value a*(") + value + ")", -size);
  EXPECT_EQ(rewritten("value a*max(1 - det(F), 0)^2")->module.near, -1);
}

TEST(RestForm, MembranesAndLinesHaveItToo) {
  for (const double size : {1e-9, 1e-5, 1e-2, 0.1}) {
    expect_digits("let C = F'*F\nvalue a*norm2(C - identity(2))", size, "membrane");
    expect_digits("let C = F'*F\nvalue a*(tr(C) - 2 - log(det(C)))", size, "membrane");
    expect_digits("value a*(norm(column(F, 0)) - 1)^2", size, "membrane");
    expect_digits("value a*(norm(F) - 1)^2", size, "line");
    expect_digits("value a*(norm2(F) - 1)^2", size, "line");
  }
}

TEST(RestForm, OneFormServesSumsAndProductsTwoServeTheRest) {
  EXPECT_EQ(rewritten("value a*norm2(F'*F - identity(3))")->module.near, -1);
  const auto two = rewritten("value a*log(det(F))^2");
  EXPECT_GE(two->module.near, 0);
  std::vector<double> q(9, 0);
  q[0] = 0.249;
  EXPECT_GT(value_at(two->module, two->module.near, q), 0);
  q[0] = 0.251;
  EXPECT_LT(value_at(two->module, two->module.near, q), 0);
}

// Rest is found by exact algebra where the graph does not see it: here 1 - (1 + b) + b, and the square of a root.
TEST(RestForm, RestIsAnIdentityInTheParameters) {
  EXPECT_TRUE(rewritten("let b = sqrt(2)\nvalue a*(b^2*(det(F) - 1) - 2*(det(F) - 1) + norm2(F - identity(3)))")
                  ->module.displacement);
  EXPECT_TRUE(rewritten("param c Pa (0, inf) other\nlet b = 1 + c/a\nvalue (b - 1)*a*(det(F) - 1) - c*(det(F) - 1) + "
                        "a*norm2(F - identity(3))")
                  ->module.displacement);
}

// A constant at rest stays; a stress at rest, an operation without an expansion, and a membrane tied to a frame keep F.
TEST(RestForm, LeavesWhatIsNotAtRest) {
  const auto offset = rewritten("value a*(tr(F'*F) - 2*log(det(F)))");
  ASSERT_TRUE(offset->module.displacement);
  EXPECT_DOUBLE_EQ(value_at(offset->module, offset->module.value, std::vector<double>(9, 0)), 9);
  EXPECT_FALSE(rewritten("value a*(tr(F'*F) - 3)")->module.displacement);
  EXPECT_FALSE(rewritten("value a*asin(det(F) - 1)^2")->module.displacement);
  EXPECT_FALSE(rewritten("value a*norm(F - identity(3))^4")->module.displacement);
  EXPECT_FALSE(rewritten("frame fixed\nvalue a*norm2(F - [1, 0; 0, 1; 0, 0])", "membrane")->module.displacement);
}

// What has no rest form is rewritten sum by sum.
TEST(Cancellations, KeepAllDigitsOfSmallArguments) {
  for (const char* value : {"1 - cos(t)", "5 - 5*cos(t)", "3*exp(t) - 3 + t", "log(1 + t)", "log(t^2 + 1)",
                            "sqrt(1 + t) - 1", "2*t - 4*sqrt(1 + t^2) + 4", "exp(t)*(1 - cos(t))"}) {
    const Energy energy =
        parse_energy(std::string("energy law point\nframe fixed\ndof x m\nparam k J stiffness\nparam c 1/m scale\n") +
                         "let t = c*x[0]\nvalue k*(" + value + ")\n",
                     "law.energy");
    const Module m = generate(energy, {}).module;
    for (const double t : {1e-12, 1e-7, 1e-3, 0.5, 3.0}) {
      const Inputs inputs = {{"x", {t, 0, 0}}, {"k", {1}}, {"c", {1}}};
      const ReferenceValue exact = evaluate_reference(energy, "", inputs);
      const std::vector<double> got = interpret(m.graph, {m.value, m.gradient[0]}, {.params = {1, 1}, .q = {t, 0, 0}});
      EXPECT_NEAR(got[0] / exact.value, 1, 4e-15) << value << " at " << t;
      EXPECT_NEAR(got[1] / exact.gradient[0], 1, 4e-15) << value << " at " << t;
    }
  }
}

// Lanes near rest and far from it in one vector each get their own form.
TEST(RestForm, MixedLanesAreEachAccurate) {
  const Energy energy = read_energy(test::source("/energies/solids/neo_hookean.energy"));
  std::vector<Inputs> states;
  for (int i = 0; i < 8; ++i) {
    const double stretch = i % 3 == 0 ? 1 + 1e-3 : 3;
    states.push_back({{"E", {10}}, {"nu", {0.25}}, {"F", {stretch, 0, 0, 0.125, 1, 0, 0, -0.0625, 1}}});
  }
  for (int lanes : test_widths()) {
    const std::vector<KernelValue> got = evaluate_kernel(energy, *test_kernel(energy, "", lanes).table, states);
    for (size_t i = 0; i < states.size(); ++i) {
      const ReferenceValue exact = evaluate_reference(energy, "", states[i]);
      EXPECT_NEAR(got[i].value, exact.value, 1e-13 * exact.value);
      for (size_t c = 0; c < 9; ++c) EXPECT_NEAR(got[i].gradient[c], exact.gradient[c], 1e-13);
      for (size_t c = 0; c < 81; ++c) EXPECT_NEAR(got[i].hessian[c], exact.hessian[c], 1e-12);
    }
  }
}

}  // namespace
}  // namespace ergon::testing
