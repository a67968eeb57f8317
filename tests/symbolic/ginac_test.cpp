// The symbolic form of an energy, differentiated by GiNaC, against the reference.
#include <gtest/gtest.h>

#include <cmath>

#include "symbolic/elaborate.h"
#include "symbolic/ginac_algebra.h"
#include "symbolic/reference.h"
#include "tests/paths.h"
#include "tests/symbolic/energy_files.h"

namespace ergon {
namespace {

using GiNaC::ex;

double number(const ex& e) { return GiNaC::ex_to<GiNaC::numeric>(e.evalf()).to_double(); }

void expect_same_as_reference(const Energy& energy, const Inputs& inputs) {
  const SymbolicEnergy symbolic = to_ginac(energy, "");
  const ReferenceValue r = evaluate_reference(energy, "", inputs);
  GiNaC::exmap at;
  std::vector<ex> dofs;
  for (const Symbol& symbol : energy.symbols) {
    for (size_t i = 0; i < inputs.at(symbol.name).size(); ++i) {
      const ex& s = symbolic.symbols.at(symbol.name).at(i);
      at[s] = GiNaC::numeric(inputs.at(symbol.name)[i]);
      if (symbol.role == Role::dof) dofs.push_back(s);
    }
  }
  EXPECT_NEAR(number(symbolic.value.subs(at)), r.value, 1e-13 * (1 + std::fabs(r.value)));
  for (size_t i = 0; i < dofs.size(); ++i) {
    const ex derivative = symbolic.value.diff(GiNaC::ex_to<GiNaC::symbol>(dofs[i]));
    EXPECT_NEAR(number(derivative.subs(at)), r.gradient[i], 1e-12 * (1 + std::fabs(r.gradient[i])));
    for (size_t j = 0; j <= i; ++j) {
      const ex second = derivative.diff(GiNaC::ex_to<GiNaC::symbol>(dofs[j]));
      const double expected = r.hessian[i * dofs.size() + j];
      EXPECT_NEAR(number(second.subs(at)), expected, 1e-11 * (1 + std::fabs(expected)));
    }
  }
}

TEST(Ginac, SolidsAgreeWithTheReference) {
  const Inputs inputs = {{"F", {1.1, 0.2, 0, -0.3, 0.9, 0.1, 0.05, 0, 1.2}}, {"E", {2}}, {"nu", {0.3}}};
  for (const char* law : {"neo_hookean", "stable_neo_hookean", "st_venant_kirchhoff", "linear_elasticity"})
    expect_same_as_reference(read_energy(test::source("/energies/solids/") + law + ".energy"), inputs);
}

TEST(Ginac, StencilsAgreeWithTheReference) {
  expect_same_as_reference(
      read_energy(test::source("/energies/rods/spring.energy")),
      {{"x0", {0.1, 0.2, 0.3}}, {"x1", {1, 2, -1}}, {"X0", {0, 0, 0}}, {"X1", {1, 1, 1}}, {"k", {3}}});
  expect_same_as_reference(
      test::shipped("log_barrier:half_space"),
      {{"x", {0.1, 0.2, 0.3}}, {"n", {0, 0.6, 0.8}}, {"height", {0.1}}, {"dhat", {0.5}}, {"kappa", {2}}});
}

TEST(Ginac, MinAndMaxAreExact) {
  const Energy e =
      parse_energy("energy e point\ndof x m\nparam k N\nvalue k*(min(x[0], x[1]) + 10*max(x[1], x[2]))\n", "e.energy");
  expect_same_as_reference(e, {{"x", {0.5, -0.25, 2}}, {"k", {1}}});
}

TEST(Ginac, LiteralsStayRational) {
  const Energy e =
      parse_energy("energy e point\ndof x m\nlet a = 0.1 + 1e-3\nparam k N/m\nvalue k*a*norm2(x)\n", "e.energy");
  const SymbolicEnergy symbolic = to_ginac(e, "");
  EXPECT_TRUE(symbolic.lets.at("a").at(0).is_equal(GiNaC::numeric(101, 1000)));
}

TEST(Ginac, PositiveParametersSimplify) {
  const Energy e = parse_energy("energy e point\ndof x m\nparam k J/m (0, inf)\nvalue sqrt(k^2)*norm(x)\n", "e.energy");
  const SymbolicEnergy symbolic = to_ginac(e, "");
  const ex k = symbolic.symbols.at("k").at(0);
  EXPECT_TRUE(GiNaC::is_a<GiNaC::possymbol>(k));
  EXPECT_TRUE(GiNaC::is_a<GiNaC::realsymbol>(symbolic.symbols.at("x").at(2)));
  EXPECT_TRUE((GiNaC::pow(symbolic.value / k, 2) - symbolic.value * symbolic.value / (k * k)).expand().is_zero());
}

TEST(Ginac, ExactValuesReplaceSymbols) {
  const Energy e = read_energy(test::source("/energies/solids/neo_hookean.energy"));
  GinacAlgebra algebra({{"F", {2, 0, 0, 0, 2, 0, 0, 0, 2}}, {"E", {1}}, {"nu", {0}}});
  const ex value = elaborate(e, "", algebra).value;
  const ex expected = GiNaC::numeric(1, 4) * 9 - GiNaC::log(ex(8)) / 2;
  EXPECT_TRUE((value - expected).expand().is_zero()) << value;
  EXPECT_TRUE(algebra.symbols().empty());
}

}  // namespace
}  // namespace ergon
