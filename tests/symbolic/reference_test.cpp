// The reference against closed forms and central differences.
#include "symbolic/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/paths.h"
#include "tests/symbolic/energy_files.h"

namespace ergon {
namespace {

Energy of_point(const std::string& expression) {
  return parse_energy(
      "energy e point\ndof x m\nparam k J\nparam L m\nlet y = x/L\nvalue k*(" + expression + " + 0*y[2])\n",
      "e.energy");
}

Inputs at(double x, double y, double z) { return {{"x", {x, y, z}}, {"k", {1}}, {"L", {1}}}; }

struct OneVariable {
  const char* text;
  double (*f)(double);
  double (*first)(double);
  double (*second)(double);
};

const std::vector<OneVariable> functions = {
    {"sqrt(y[0])", [](double x) { return std::sqrt(x); }, [](double x) { return 0.5 / std::sqrt(x); },
     [](double x) { return -0.25 / (x * std::sqrt(x)); }},
    {"log(y[0])", [](double x) { return std::log(x); }, [](double x) { return 1 / x; },
     [](double x) { return -1 / (x * x); }},
    {"log1p(y[0])", [](double x) { return std::log1p(x); }, [](double x) { return 1 / (1 + x); },
     [](double x) { return -1 / ((1 + x) * (1 + x)); }},
    {"exp(y[0])", [](double x) { return std::exp(x); }, [](double x) { return std::exp(x); },
     [](double x) { return std::exp(x); }},
    {"expm1(y[0])", [](double x) { return std::expm1(x); }, [](double x) { return std::exp(x); },
     [](double x) { return std::exp(x); }},
    {"sin(y[0])", [](double x) { return std::sin(x); }, [](double x) { return std::cos(x); },
     [](double x) { return -std::sin(x); }},
    {"cos(y[0])", [](double x) { return std::cos(x); }, [](double x) { return -std::sin(x); },
     [](double x) { return -std::cos(x); }},
    {"tan(y[0])", [](double x) { return std::tan(x); }, [](double x) { return 1 / (std::cos(x) * std::cos(x)); },
     [](double x) { return 2 * std::tan(x) / (std::cos(x) * std::cos(x)); }},
    {"asin(y[0])", [](double x) { return std::asin(x); }, [](double x) { return 1 / std::sqrt(1 - x * x); },
     [](double x) { return x / std::pow(1 - x * x, 1.5); }},
    {"acos(y[0])", [](double x) { return std::acos(x); }, [](double x) { return -1 / std::sqrt(1 - x * x); },
     [](double x) { return -x / std::pow(1 - x * x, 1.5); }},
    {"atan(y[0])", [](double x) { return std::atan(x); }, [](double x) { return 1 / (1 + x * x); },
     [](double x) { return -2 * x / ((1 + x * x) * (1 + x * x)); }},
    {"1/y[0]", [](double x) { return 1 / x; }, [](double x) { return -1 / (x * x); },
     [](double x) { return 2 / (x * x * x); }},
    {"y[0]^5", [](double x) { return std::pow(x, 5); }, [](double x) { return 5 * std::pow(x, 4); },
     [](double x) { return 20 * std::pow(x, 3); }},
    {"y[0]^-2", [](double x) { return std::pow(x, -2); }, [](double x) { return -2 * std::pow(x, -3); },
     [](double x) { return 6 * std::pow(x, -4); }},
    {"y[0]^(1/3)", [](double x) { return std::cbrt(x); }, [](double x) { return std::pow(x, -2.0 / 3) / 3; },
     [](double x) { return -2 * std::pow(x, -5.0 / 3) / 9; }},
    {"2^y[0]", [](double x) { return std::exp2(x); }, [](double x) { return std::log(2) * std::exp2(x); },
     [](double x) { return std::log(2) * std::log(2) * std::exp2(x); }},
    {"abs(-y[0])", [](double x) { return x; }, [](double) { return 1.0; }, [](double) { return 0.0; }},
    {"min(y[0]^2, 9)", [](double x) { return x * x; }, [](double x) { return 2 * x; }, [](double) { return 2.0; }},
    {"max(y[0]^2, -9)", [](double x) { return x * x; }, [](double x) { return 2 * x; }, [](double) { return 2.0; }}};

TEST(Reference, FunctionsOfOneVariable) {
  for (const OneVariable& f : functions) {
    for (const double x : {0.125, 0.5, 0.9}) {
      const ReferenceValue r = evaluate_reference(of_point(f.text), "", at(x, 3, 4));
      EXPECT_NEAR(r.value, f.f(x), 4e-16 * std::fabs(f.f(x))) << f.text;
      EXPECT_NEAR(r.gradient[0], f.first(x), 1e-14 * std::fabs(f.first(x))) << f.text;
      EXPECT_NEAR(r.hessian[0], f.second(x), 1e-14 * std::fabs(f.second(x))) << f.text;
      EXPECT_EQ(r.gradient[1], 0) << f.text;
      EXPECT_EQ(r.hessian[1], 0) << f.text;
    }
  }
}

TEST(Reference, AngleOfAVector) {
  const double x = -0.75, y = 0.5, r2 = x * x + y * y;
  const ReferenceValue r = evaluate_reference(of_point("atan2(y[1], y[0])"), "", at(x, y, 0));
  EXPECT_DOUBLE_EQ(r.value, std::atan2(y, x));
  EXPECT_DOUBLE_EQ(r.gradient[0], -y / r2);
  EXPECT_DOUBLE_EQ(r.gradient[1], x / r2);
  EXPECT_DOUBLE_EQ(r.hessian[0], 2 * x * y / (r2 * r2));
  EXPECT_DOUBLE_EQ(r.hessian[1], (y * y - x * x) / (r2 * r2));
  EXPECT_DOUBLE_EQ(r.hessian[3], r.hessian[1]);
  EXPECT_DOUBLE_EQ(r.hessian[4], -2 * x * y / (r2 * r2));
}

TEST(Reference, SpringHasItsTextbookStiffness) {
  const Energy spring = read_energy(test::source("/energies/rods/spring.energy"));
  const ReferenceValue r = evaluate_reference(
      spring, "", {{"x0", {0, 0, 0}}, {"x1", {2, 0, 0}}, {"X0", {0, 0, 0}}, {"X1", {1, 0, 0}}, {"k", {3}}});
  EXPECT_DOUBLE_EQ(r.value, 1.5);
  EXPECT_EQ(r.gradient, (std::vector<double>{-3, 0, 0, 3, 0, 0}));
  EXPECT_DOUBLE_EQ(r.hessian[0], 3);           // along the spring: k
  EXPECT_DOUBLE_EQ(r.hessian[6 + 1], 1.5);     // across: k (1 - L/l)
  EXPECT_DOUBLE_EQ(r.hessian[3 * 6 + 0], -3);  // coupling of the ends
  EXPECT_DOUBLE_EQ(r.hessian[4 * 6 + 1], -1.5);
  EXPECT_EQ(r.require, std::vector<double>{1});
}

// Near rest the value of a solid is its quadratic form; doubles would lose it to cancellation.
TEST(Reference, KeepsDigitsThroughCancellation) {
  const double e = 0x1p-30;  // strain
  for (const char* law : {"neo_hookean", "stable_neo_hookean", "st_venant_kirchhoff", "linear_elasticity"}) {
    const Energy energy = read_energy(test::source("/energies/solids/") + law + ".energy");
    const ReferenceValue r =
        evaluate_reference(energy, "", {{"F", {1 + e, 0, 0, 0, 1, 0, 0, 0, 1}}, {"E", {1}}, {"nu", {0.25}}});
    EXPECT_NEAR(r.value, 0.6 * e * e, 1e-8 * e * e) << law;  // (la + 2 mu)/2 e^2 with la = mu = 0.4
    EXPECT_NEAR(r.gradient[0], 1.2 * e, 1e-8 * e) << law;
    EXPECT_NEAR(r.hessian[0], 1.2, 1e-8) << law;
  }
}

TEST(Reference, MoreDigitsChangeNothing) {
  const Energy energy = read_energy(test::source("/energies/solids/neo_hookean.energy"));
  const Inputs inputs = {{"F", {1.1, 0.2, 0, -0.3, 0.9, 0.1, 0.05, 0, 1.2}}, {"E", {1e5}}, {"nu", {0.45}}};
  const ReferenceValue a = evaluate_reference(energy, "", inputs, 40), b = evaluate_reference(energy, "", inputs, 120);
  EXPECT_EQ(a.value, b.value);
  EXPECT_EQ(a.gradient, b.gradient);
  EXPECT_EQ(a.hessian, b.hessian);
}

TEST(Reference, WhatIsNotRealIsNotANumber) {
  const ReferenceValue log = evaluate_reference(of_point("log(y[0])"), "", at(-1, 0, 0));
  EXPECT_TRUE(std::isnan(log.value));
  const ReferenceValue root = evaluate_reference(of_point("norm(y)"), "", at(0, 0, 0));
  EXPECT_EQ(root.value, 0);
  EXPECT_TRUE(std::isnan(root.gradient[0]));
  EXPECT_TRUE(std::isnan(evaluate_reference(of_point("1/y[0]"), "", at(0, 0, 0)).value));
  EXPECT_TRUE(std::isnan(evaluate_reference(of_point("y[0]^(1/2)"), "", at(-1, 0, 0)).value));
  EXPECT_TRUE(std::isnan(evaluate_reference(of_point("acos(y[0])"), "", at(2, 0, 0)).value));
  EXPECT_TRUE(std::isnan(evaluate_reference(of_point("atan2(y[0], y[1])"), "", at(0, 0, 0)).value));
}

TEST(Reference, MissingInputsAreNamed) {
  auto message = [](const Inputs& inputs) -> std::string {
    try {
      evaluate_reference(of_point("y[0]"), "", inputs);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message({{"x", {1, 2, 3}}, {"k", {1}}}), "no value is given for 'L'");
  EXPECT_EQ(message({{"x", {1, 2}}, {"k", {1}}, {"L", {1}}}), "'x' has 3 components, found 2");
  EXPECT_EQ(message({{"x", {1, 2, NAN}}, {"k", {1}}, {"L", {1}}}), "the value of 'x' is not finite");
}

// Central differences of the reference's own values and gradients, for every energy of the catalogue and a hinge.
class Differences : public testing::TestWithParam<std::string> {};

void expect_differences_match(const Energy& energy, const std::string& case_name, const Inputs& inputs) {
  const ReferenceValue r = evaluate_reference(energy, case_name, inputs);
  const double h = 0x1p-17;
  double scale = 0, stiffness = 0;
  for (const double g : r.gradient) scale = std::max(scale, std::fabs(g));
  for (const double k : r.hessian) stiffness = std::max(stiffness, std::fabs(k));
  const size_t n = r.gradient.size();
  size_t column = 0;
  for (const Symbol* dof : energy.with_role(Role::dof)) {
    for (size_t i = 0; i < inputs.at(dof->name).size(); ++i, ++column) {
      Inputs up = inputs, down = inputs;
      up[dof->name][i] += h;
      down[dof->name][i] -= h;
      const double step = up[dof->name][i] - down[dof->name][i];
      const ReferenceValue a = evaluate_reference(energy, case_name, up),
                           b = evaluate_reference(energy, case_name, down);
      EXPECT_NEAR((a.value - b.value) / step, r.gradient[column], 1e-6 * (scale + stiffness));
      for (size_t row = 0; row < n; ++row)
        EXPECT_NEAR((a.gradient[row] - b.gradient[row]) / step, r.hessian[column * n + row],
                    1e-6 * (scale + stiffness));
    }
  }
}

Inputs random_inputs(const Energy& energy, std::mt19937& engine) {
  std::uniform_real_distribution<double> unit(0, 1);
  Inputs inputs;
  for (const Symbol& symbol : energy.symbols) {
    const double low = std::isfinite(symbol.range.lower) ? symbol.range.lower : -1;
    const double high = std::isfinite(symbol.range.upper) ? symbol.range.upper : low + 2;
    for (int i = 0; i < symbol.shape.size(); ++i) inputs[symbol.name].push_back(low + (high - low) * unit(engine));
    if (symbol.name == "F")
      for (int i = 0; i < symbol.shape.size(); i += 4) inputs["F"][static_cast<size_t>(i)] += 2;
  }
  return inputs;
}

TEST_P(Differences, AgreeWithTheDerivatives) {
  const Energy energy = test::shipped(GetParam());
  std::mt19937 engine(7);
  int tried = 0;
  for (int attempt = 0; attempt < 2000 && tried < 4; ++attempt) {
    const Inputs inputs = random_inputs(energy, engine);
    const ReferenceValue r = evaluate_reference(energy, energy.cases.empty() ? "" : energy.cases[0], inputs, 20);
    auto holds = [](const std::vector<double>& margins) {
      return std::all_of(margins.begin(), margins.end(), [](double m) { return m > 0.1; });
    };
    if (!holds(r.active) || !holds(r.require)) continue;
    ++tried;
    expect_differences_match(energy, energy.cases.empty() ? "" : energy.cases[0], inputs);
  }
  EXPECT_EQ(tried, 4);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Differences, testing::ValuesIn(test::catalogue_names()),
                         [](const auto& info) { return test::name_of_test(info.param); });

TEST(Reference, HingeAngleDifferences) {
  const Energy hinge = parse_energy(
      "energy e hinge\ndof p0 p1 p2 p3 m\nparam k J\nparam angle 1\n"
      "value k/2*(dihedral(p0, p1, p2, p3) - angle)^2\n",
      "e.energy");
  std::mt19937 engine(3);
  for (int i = 0; i < 3; ++i) {
    Inputs inputs = random_inputs(hinge, engine);
    inputs["p1"][0] += 3;
    inputs["p2"][1] += 3;
    inputs["p3"][1] -= 3;
    expect_differences_match(hinge, "", inputs);
  }
}

// sin(pi/6) = 1/2 and cos(pi) = -1, to more digits than a double holds.
TEST(Reference, PiHasAllDigits) {
  const Energy e = parse_energy(
      "energy e point\ndof x m\nparam k J\nvalue k*((sin(pi/6) - 1/2) + (cos(pi) + 1) + x[0]*0)*1e40\n", "e.energy");
  EXPECT_LT(std::fabs(evaluate_reference(e, "", {{"x", {1, 0, 0}}, {"k", {1}}}).value), 1e-5);
  const Energy area = parse_energy("energy e point\ndof x m\nparam k N/m\nvalue pi*k*norm2(x)\n", "area.energy");
  EXPECT_EQ(evaluate_reference(area, "", {{"x", {1, 0, 0}}, {"k", {1}}}).value, M_PI);
  EXPECT_EQ(evaluate_reference(area, "", {{"x", {1, 0, 0}}, {"k", {1}}}).gradient[0], 2 * M_PI);
}

}  // namespace
}  // namespace ergon
