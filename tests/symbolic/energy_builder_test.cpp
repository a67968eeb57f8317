// Energies written in C++: what their text is, what is refused, and at which line of this file.

#include "symbolic/energy_builder.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <functional>

#include "symbolic/compose.h"

namespace ergon {
namespace {

TEST(Expressions, OfCppKeepTheirStructure) {
  const Expr a = Expr::named("a"), b = Expr::named("b"), c = Expr::named("c");
  const std::vector<std::pair<Expr, std::string>> cases = {
      {a + b * c, "a + b*c"},
      {(a + b) * c, "(a + b)*c"},
      {a - (b - c), "a - (b - c)"},
      {a - b - c, "a - b - c"},
      {a / (b * c), "a/(b*c)"},
      {a / b * c, "a/b*c"},
      {a * (b / c), "a*(b/c)"},
      {-(a + b), "-(a + b)"},
      {-a * b, "-a*b"},
      {a * -2, "a*-2"},
      {pow(-a, 2), "(-a)^2"},
      {-pow(a, 2), "-a^2"},
      {pow(pow(a, b), c), "(a^b)^c"},
      {pow(a, pow(b, c)), "a^b^c"},
      {pow(a, Expr(-2) / 3), "a^(-2/3)"},
      {transpose(a + b) * c, "(a + b)'*c"},
      {(a + b)[1], "(a + b)[1]"},
      {a(0, 2) * b[1], "a[0, 2]*b[1]"},
      {0.1 * a + 1e-24, "0.1*a + 1e-24"},
      {vector({a, 2, b + c}), "[a, 2, b + c]"},
      {matrix({{a, b}, {c, 1}}), "[a, b; c, 1]"},
      {columns({a - b, c}), "columns(a - b, c)"},
      {atan2(a, max(b, 0)) + column(c, 1), "atan2(a, max(b, 0)) + column(c, 1)"}};
  for (const auto& [expression, text] : cases) EXPECT_EQ(expression.text(), text);
}

// Cases, distances, barriers, summary and all that a file may hold.
TEST(EnergyBuilder, WritesPartsOfContact) {
  EnergyBuilder near("distance", "near_points", "edge");
  const Expr p = near.dof("p", "m"), q = near.dof("q", "m");
  near.case_let("slanted", "gap2", norm2(p - q));
  near.case_let("upright", "gap2", pow(p[2] - q[2], 2));
  near.require(norm2(p - q) > 0);
  EnergyBuilder law("barrier", "soft");
  law.summary("Quadratic in the gap.");
  law.cite("Nobody.");
  const Expr dhat = law.param("dhat", "m", "(0, inf)", "activation distance");
  const Expr kappa = law.lag("kappa", "N/m", "(0, inf)");
  law.active(law.gap() < dhat);
  law.value(kappa / 2 * pow(dhat - law.gap(), 2));
  EXPECT_EQ(law.text(),
            "# Quadratic in the gap.\nbarrier soft\ncite Nobody.\nparam dhat m (0, inf) activation distance\n"
            "lag kappa N/m (0, inf)\nactive gap < dhat\nvalue kappa/2*(dhat - gap)^2\n");
  const Energy both = compose(law.build(), near.build(), Offset::none);
  EXPECT_EQ(both.name, "soft:near_points");
  EXPECT_EQ(both.cases, (std::vector<std::string>{"slanted", "upright"}));
  EXPECT_EQ(both.summary, "Quadratic in the gap.");
}

// The message is told at a line of this file.
void refused(const std::function<void()>& build, const std::string& message) {
  try {
    build();
    ADD_FAILURE() << "not refused: " << message;
  } catch (const SourceError& error) {
    const std::string what = error.what();
    EXPECT_EQ(what, fmt::format("{}:{}: {}", __FILE__, error.place().line, message));
  }
}

int line_of(const std::function<void()>& build) {
  try {
    build();
  } catch (const SourceError& error) {
    return error.place().line;
  }
  return 0;
}

void spring(const std::string& unit, const std::function<void(EnergyBuilder&, Expr x0, Expr x1, Expr k)>& rest) {
  EnergyBuilder law("energy", "my_spring", "edge");
  const Expr x0 = law.dof("x0", "m"), x1 = law.dof("x1", "m"), k = law.param("k", unit, "(0, inf)", "stiffness");
  rest(law, x0, x1, k);
  law.build();
}

TEST(EnergyBuilder, RefusesWhatAFileMayNotHold) {
  const auto with = [](const std::function<void(EnergyBuilder&, Expr, Expr, Expr)>& rest,
                       const std::string& unit = "N/m") { return [=] { spring(unit, rest); }; };
  const auto value = [](EnergyBuilder& law, Expr x0, Expr x1, Expr k) { law.value(k / 2 * norm2(x1 - x0)); };
  refused(with(value, "N/metre"),
          "unknown unit 'metre' in 'N/metre'; a declaration is written NAMES UNIT [RANGE] [HELP]");
  refused(with(value, "kN/m"),
          "expected an SI unit without prefix, found 'kN/m'; write 'N/m' (values in a scene may still be given in "
          "kN/m)");
  refused(with(value, "Pa"), "the value of an edge energy expects an energy (J), found N");
  refused(with([](EnergyBuilder& law, Expr x0, Expr x1, Expr k) { law.value(k * (x1 - x0)); }),
          "the value of an energy is a scalar, found vector of 3");
  refused(with([](EnergyBuilder& law, Expr x0, Expr x1, Expr k) { law.value(k * norm(x1 - x0) + norm2(x0)); }),
          "'+' needs the same unit on both sides: expected a force (N), found m^2");
  refused(with([](EnergyBuilder& law, Expr, Expr x1, Expr k) { law.value(k / 2 * norm2(x1)); }),
          "the dof 'x0' is not used");
  refused(with([](EnergyBuilder& law, Expr x0, Expr x1, Expr k) { law.value(k / 2 * norm2(x1 - x0) * det(law.F())); }),
          "unknown name 'F'; F is known in a density, a stencil energy has points");
  refused(with([](EnergyBuilder& law, Expr x0, Expr x1, Expr) { law.value(Expr::named("q") * norm2(x1 - x0)); }),
          "unknown name 'q'; known here are k, x0, x1; a quantity is declared by `param NAME UNIT`, a part is named by "
          "`let`");
  refused(with([](EnergyBuilder& law, Expr x0, Expr x1, Expr k) { law.value(k * call("nrm2", {x1 - x0})); }),
          "unknown function 'nrm2'; did you mean 'norm2'?");
  refused(with([](EnergyBuilder& law, Expr x0, Expr x1, Expr k) {
            law.let("J", norm(x1 - x0));
            law.value(k / 2 * norm2(x1 - x0));
          }),
          "the let 'J' is not used");
  const int line = __LINE__ + 2;
  refused(with([](EnergyBuilder& law, Expr x0, Expr x1, Expr k) {
            law.value(k / 2 * norm2(x1 - x0));
            law.value(k / 2 * norm2(x1 - x0));
          }),
          fmt::format("a second value; 'my_spring' has one already in line {}", line));
  refused(with([](EnergyBuilder&, Expr, Expr, Expr) {}),
          "'my_spring' has no value; expected a statement `value EXPRESSION`");
  refused(with([](EnergyBuilder& law, Expr x0, Expr, Expr k) { law.value(k / 2 * norm2(x0[3] - x0)); }),
          "index 3 is out of range: a vector of 3 has rows 0 to 2");
  refused(with([](EnergyBuilder& law, Expr x0, Expr x1, Expr k) {
            law.cite("line # 1");
            law.value(k / 2 * norm2(x1 - x0));
          }),
          "a '#' begins a comment and a line break ends a statement; leave them out of 'cite line # 1'");
  refused(with([](EnergyBuilder& law, Expr x0, Expr x1, Expr k) {
            law.value(k / 2 * norm2(x1 - x0) + std::numeric_limits<double>::infinity());
          }),
          "expected a finite number in an expression, found inf");
  refused([] { EnergyBuilder("energy", "my_spring", "edg").build(); },
          "unknown stencil 'edg'; known are point, edge, corner, triangle, tetrahedron, hinge, patch, shell_triangle, "
          "rod_corner, "
          "point_point, point_edge, point_triangle, edge_edge; did you mean 'edge'?");
}

// Of an expression over several lines the operation at fault is told, also where it was put together elsewhere.
TEST(EnergyBuilder, TellsTheLineOfTheOperation) {
  int faulty = 0;
  const int told = line_of([&] {
    EnergyBuilder law("energy", "my_spring", "edge");
    const Expr x0 = law.dof("x0", "m"), x1 = law.dof("x1", "m"), k = law.param("k", "N/m");
    faulty = __LINE__ + 1;
    const Expr wrong = norm2(x1 - x0) + norm(x1 - x0);
    law.value(k / 2 * norm2(x1 - x0) +  //
              k / 2 * wrong);
    law.build();
  });
  EXPECT_EQ(told, faulty);
  EXPECT_GT(faulty, 0);
}

}  // namespace
}  // namespace ergon
