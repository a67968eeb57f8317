// The meaning of every operation against plain doubles, and the order in which operations are formed.
#include "symbolic/elaborate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "symbolic/double_algebra.h"

namespace ergon {
namespace {

using Values = std::map<std::string, std::vector<double>>;

ExactInputs exact(const Values& values) {
  ExactInputs inputs;
  for (const auto& [name, components] : values)
    for (const double c : components) inputs[name].push_back(cln::rational(cln::cl_DF(c)));
  return inputs;
}

const Values state = {{"F", {1, 0, 0, 0, 1, 0, 0, 0, 1}},
                      {"k", {1}},
                      {"s", {0.75}},
                      {"t", {-0.5}},
                      {"u", {0.5, -1, 2}},
                      {"v", {1.5, 0.25, -0.75}},
                      {"w", {-0.25, 2, 1}},
                      {"A", {2, 0.5, -1, 0.25, 3, 1, -0.5, 0.75, 1.5}},
                      {"B", {1, 2, -1, 0.5, 1, 0.25, 0, 3, -2}},
                      {"M", {2, 1, -1, 3}},
                      {"P", {1, 2, 3, 4, 5, 6}}};

// A scalar expression over the state above, as an energy that uses all of it.
Energy energy_of(const std::string& expression) {
  return parse_energy(
      "density e solid\n"
      "param k Pa\n"
      "param s 1\n"
      "param t 1\n"
      "param u[3] v[3] w[3] 1\n"
      "param A[3,3] B[3,3] 1\n"
      "param M[2,2] 1\n"
      "param P[3,2] 1\n"
      "let unused = 0*(tr(F) + s + t + u[0] + v[0] + w[0] + A[0,0] + B[0,0] + M[0,0] + P[0,0])\n"
      "value k*(" +
          expression + " + unused)\n",
      "e.energy");
}

double value_of(const std::string& expression) {
  const ExactInputs inputs = exact(state);
  DoubleAlgebra algebra(inputs);
  return elaborate(energy_of(expression), "", algebra).value;
}

double A(int i, int j) { return state.at("A")[static_cast<size_t>(j * 3 + i)]; }
double B(int i, int j) { return state.at("B")[static_cast<size_t>(j * 3 + i)]; }
double u(int i) { return state.at("u")[static_cast<size_t>(i)]; }
double v(int i) { return state.at("v")[static_cast<size_t>(i)]; }
double w(int i) { return state.at("w")[static_cast<size_t>(i)]; }

double det_A() {
  return A(0, 0) * (A(1, 1) * A(2, 2) - A(1, 2) * A(2, 1)) - A(0, 1) * (A(1, 0) * A(2, 2) - A(1, 2) * A(2, 0)) +
         A(0, 2) * (A(1, 0) * A(2, 1) - A(1, 1) * A(2, 0));
}

TEST(Elaborate, ScalarOperations) {
  const double s = 0.75, t = -0.5;
  EXPECT_DOUBLE_EQ(value_of("s + t*2 - s/t"), s + t * 2 - s / t);
  EXPECT_DOUBLE_EQ(value_of("-s^2"), -s * s);
  EXPECT_DOUBLE_EQ(value_of("s^(3/2)"), std::pow(s, 1.5));
  EXPECT_DOUBLE_EQ(value_of("s^(1/3)"), std::cbrt(s));
  EXPECT_DOUBLE_EQ(value_of("s^0.5"), std::sqrt(s));
  EXPECT_DOUBLE_EQ(value_of("t^-3"), 1 / (t * t * t));
  EXPECT_DOUBLE_EQ(value_of("t^0"), 1);
  EXPECT_DOUBLE_EQ(value_of("s^t"), std::pow(s, t));
  EXPECT_DOUBLE_EQ(value_of("pow(s, 2 - 1/2)"), std::pow(s, 1.5));
  EXPECT_DOUBLE_EQ(value_of("sqrt(s) + exp(t) + log(s) + log1p(s) + expm1(t)"),
                   std::sqrt(s) + std::exp(t) + std::log(s) + std::log1p(s) + std::expm1(t));
  EXPECT_DOUBLE_EQ(value_of("sin(s) + cos(t) + tan(s)"), std::sin(s) + std::cos(t) + std::tan(s));
  EXPECT_DOUBLE_EQ(value_of("asin(s) + acos(t) + atan(s) + atan2(s, t)"),
                   std::asin(s) + std::acos(t) + std::atan(s) + std::atan2(s, t));
  EXPECT_DOUBLE_EQ(value_of("abs(t) + 10*min(s, t) + 100*max(s, t)"), 0.5 - 5 + 75);
}

TEST(Elaborate, Vectors) {
  EXPECT_DOUBLE_EQ(value_of("dot(u, v)"), u(0) * v(0) + u(1) * v(1) + u(2) * v(2));
  EXPECT_DOUBLE_EQ(value_of("u'*v"), u(0) * v(0) + u(1) * v(1) + u(2) * v(2));
  EXPECT_DOUBLE_EQ(value_of("norm2(u)"), 0.25 + 1 + 4);
  EXPECT_DOUBLE_EQ(value_of("norm(u - v)"), std::hypot(u(0) - v(0), u(1) - v(1), u(2) - v(2)));
  EXPECT_DOUBLE_EQ(value_of("cross(u, v)[0]"), u(1) * v(2) - u(2) * v(1));
  EXPECT_DOUBLE_EQ(value_of("cross(u, v)[1]"), u(2) * v(0) - u(0) * v(2));
  EXPECT_DOUBLE_EQ(value_of("cross(u, v)[2]"), u(0) * v(1) - u(1) * v(0));
  EXPECT_DOUBLE_EQ(value_of("outer(u, v)[2,1]"), u(2) * v(1));
  EXPECT_DOUBLE_EQ(value_of("(u*v')[2,1]"), u(2) * v(1));
  EXPECT_DOUBLE_EQ(value_of("[s, t, 3][2] + [s, t; 5, 7][1,0] + [s, t; 5, 7][0,1]"), 3 + 5 - 0.5);
  EXPECT_DOUBLE_EQ(value_of("norm2(2*u/4)"), 5.25 / 4);
}

TEST(Elaborate, Matrices) {
  EXPECT_DOUBLE_EQ(value_of("tr(A)"), A(0, 0) + A(1, 1) + A(2, 2));
  EXPECT_DOUBLE_EQ(value_of("det(A)"), det_A());
  EXPECT_DOUBLE_EQ(value_of("det(M)"), 2 * 3 - (-1) * 1);
  EXPECT_DOUBLE_EQ(value_of("inverse(M)[0,1]"), 1.0 / 7);
  EXPECT_DOUBLE_EQ(value_of("inverse(M)[1,0]"), -1.0 / 7);
  EXPECT_DOUBLE_EQ(value_of("inverse(M)[0,0]"), 3.0 / 7);
  EXPECT_DOUBLE_EQ(value_of("A'[0,2] + transpose(A)[1,2]"), A(2, 0) + A(2, 1));
  EXPECT_DOUBLE_EQ(value_of("(A*B)[1,2]"), A(1, 0) * B(0, 2) + A(1, 1) * B(1, 2) + A(1, 2) * B(2, 2));
  EXPECT_DOUBLE_EQ(value_of("(A*u)[1]"), A(1, 0) * u(0) + A(1, 1) * u(1) + A(1, 2) * u(2));
  EXPECT_DOUBLE_EQ(value_of("(P*M)[2,1]"), 3 * -1 + 6 * 3);
  EXPECT_DOUBLE_EQ(value_of("det(P'*P)"), 14 * 77 - 32 * 32);
  EXPECT_DOUBLE_EQ(value_of("columns(u, v, w)[1,2] + columns(u, v)[2,0]"), w(1) + u(2));
  EXPECT_DOUBLE_EQ(value_of("column(A, 1)[2]"), A(2, 1));
  EXPECT_DOUBLE_EQ(value_of("tr(identity(3)) + identity(2)[0,1]"), 3);
  EXPECT_DOUBLE_EQ(value_of("sym(A)[0,2]"), (A(0, 2) + A(2, 0)) / 2);
  EXPECT_DOUBLE_EQ(value_of("dev(A)[1,1]"), A(1, 1) - (A(0, 0) + A(1, 1) + A(2, 2)) / 3);
  EXPECT_DOUBLE_EQ(value_of("dev(M)[0,1]"), -1);
  double contraction = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) contraction += A(i, j) * B(i, j);
  EXPECT_DOUBLE_EQ(value_of("dot(A, B)"), contraction);
}

TEST(Elaborate, InverseTimesMatrixIsTheUnitMatrix) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const std::string at = "[" + std::to_string(i) + "," + std::to_string(j) + "]";
      EXPECT_NEAR(value_of("(inverse(A)*A)" + at), i == j ? 1 : 0, 1e-15);
      EXPECT_NEAR(value_of("(B*inverse(B))" + at), i == j ? 1 : 0, 1e-15);
    }
  }
}

double dihedral_of(const std::vector<double>& p2, const std::vector<double>& p3) {
  const Energy e =
      parse_energy("energy e hinge\ndof p0 p1 p2 p3 m\nparam k J\nvalue k*dihedral(p0, p1, p2, p3)\n", "e.energy");
  const ExactInputs inputs = exact({{"p0", {0, 0, 0}}, {"p1", {2, 0, 0}}, {"p2", p2}, {"p3", p3}, {"k", {1}}});
  DoubleAlgebra algebra(inputs);
  return elaborate(e, "", algebra).value;
}

TEST(Elaborate, DihedralAngle) {
  EXPECT_DOUBLE_EQ(dihedral_of({0.5, 1, 0}, {1.5, -3, 0}), 0) << "flat";
  EXPECT_DOUBLE_EQ(dihedral_of({0.5, 1, 0}, {0.25, 0, -2}), M_PI / 2) << "p3 below: positive";
  EXPECT_DOUBLE_EQ(dihedral_of({0.5, 1, 0}, {0.25, 0, 2}), -M_PI / 2) << "p3 above: negative";
  for (const double angle : {-3.0, -1.0, -0.01, 0.01, 0.3, 2.0, 3.1})
    EXPECT_NEAR(dihedral_of({0.3, 1, 0}, {1.7, -std::cos(angle), -std::sin(angle)}), angle, 1e-15);
}

// Writes down every operation it is asked for.
struct Recorder {
  using Scalar = int;
  std::vector<std::string> log;
  int note(const std::string& what) {
    log.push_back(what);
    return static_cast<int>(log.size()) - 1;
  }
  static std::string id(int a) { return std::to_string(a); }
  int number(const std::string& text) { return note("number " + text); }
  int add(int a, int b) { return note("add " + id(a) + " " + id(b)); }
  int subtract(int a, int b) { return note("subtract " + id(a) + " " + id(b)); }
  int multiply(int a, int b) { return note("multiply " + id(a) + " " + id(b)); }
  int divide(int a, int b) { return note("divide " + id(a) + " " + id(b)); }
  int negate(int a) { return note("negate " + id(a)); }
  int power(int a, long num, long den) {
    return note("power " + id(a) + " " + std::to_string(num) + "/" + std::to_string(den));
  }
  int power(int a, int b) { return note("power " + id(a) + " by " + id(b)); }
  int call(Function f, const std::vector<int>& a) { return note(std::string(name_of(f)) + " " + id(a[0])); }
  int input(const Symbol& symbol, int i) { return note(symbol.name + id(i)); }
  void named(const std::string& let, int i, int n, int value) {
    note("let " + let + " " + id(i) + "/" + id(n) + " = " + id(value));
  }
};

TEST(Elaborate, OrderIsThatOfTheText) {
  const Energy e = parse_energy(
      "energy e point\ndof x m\nparam k N/m\nparam a 1\nlet d = [x[1], x[0], 0]\nlet s = norm2(d)\n"
      "require s > 0\nvalue k*s^(3/2)/(s^(1/2) - s^(1/2)*a^a/2)\n",
      "e.energy");
  Recorder recorder;
  const auto result = elaborate(e, "", recorder);
  const std::vector<std::string> expected = {"x0",
                                             "x1",
                                             "x2",
                                             "k0",
                                             "a0",  // 0-4
                                             "number 0",
                                             "let d 0/3 = 1",
                                             "let d 1/3 = 0",
                                             "let d 2/3 = 5",  // 5-8
                                             "multiply 1 1",
                                             "multiply 0 0",
                                             "add 9 10",
                                             "multiply 5 5",
                                             "add 11 12",
                                             "let s 0/1 = 13",  // 9-14
                                             "power 13 3/2",
                                             "multiply 3 15",  // 15, 16
                                             "power 13 1/2",
                                             "power 13 1/2",
                                             "power 4 by 4",
                                             "multiply 18 19",
                                             "number 2",
                                             "divide 20 21",
                                             "subtract 17 22",
                                             "divide 16 23",  // 17-24
                                             "number 0",
                                             "subtract 13 25"};
  EXPECT_EQ(recorder.log, expected);
  EXPECT_EQ(result.value, 24);
  EXPECT_EQ(result.require, std::vector<int>{26});
}

TEST(Elaborate, OnlyTheLetsOfTheCaseAreFormed) {
  const Energy e = parse_energy(
      "energy e point\ndof x m\nparam k N/m\ncase a g = norm2(x)\ncase b g = x[0]^2\nvalue k*g\n", "e.energy");
  const ExactInputs inputs = exact({{"x", {1, 2, 3}}, {"k", {2}}});
  DoubleAlgebra algebra(inputs);
  EXPECT_EQ(elaborate(e, "a", algebra).value, 28);
  EXPECT_EQ(elaborate(e, "b", algebra).value, 2);
  EXPECT_THROW(elaborate(e, "", algebra), std::invalid_argument);
  EXPECT_THROW(elaborate(e, "c", algebra), std::invalid_argument);
}

TEST(Elaborate, MarginsArePositiveWhereConditionsHold) {
  const Energy e = parse_energy(
      "energy e point\ndof x m\nparam d m\nparam k N/m\nactive d > norm(x)\nrequire x[2] > 0\nvalue k*norm2(x)\n",
      "e.energy");
  const ExactInputs inputs = exact({{"x", {3, 4, -1}}, {"k", {2}}, {"d", {5}}});
  DoubleAlgebra algebra(inputs);
  const auto result = elaborate(e, "", algebra);
  EXPECT_DOUBLE_EQ(result.active.at(0), 5 - std::sqrt(26.0));
  EXPECT_DOUBLE_EQ(result.require.at(0), -1);
}

}  // namespace
}  // namespace ergon
