#include <gtest/gtest.h>

#include "symbolic/energy.h"
#include "symbolic/expression_parser.h"
#include "symbolic/functions.h"
#include "symbolic/print.h"
#include "symbolic/statements.h"
#include "tests/paths.h"
#include "tests/symbolic/energy_files.h"

namespace ergon {
namespace {

ExpressionPtr parse(const std::string& text) {
  Statement statement{text, {{0, {"text", 1, 1}}}};
  ExpressionParser parser(tokenise(statement, 0));
  ExpressionPtr expression = parser.expression();
  parser.finish();
  return expression;
}

// The tree with every operation in brackets.
std::string tree(const Expression& e) {
  using Kind = Expression::Kind;
  auto arg = [&](size_t i) { return tree(*e.arguments[i]); };
  switch (e.kind) {
    case Kind::number:
    case Kind::name:
      return e.text;
    case Kind::negate:
      return "(-" + arg(0) + ")";
    case Kind::add:
      return "(" + arg(0) + "+" + arg(1) + ")";
    case Kind::subtract:
      return "(" + arg(0) + "-" + arg(1) + ")";
    case Kind::multiply:
      return "(" + arg(0) + "*" + arg(1) + ")";
    case Kind::divide:
      return "(" + arg(0) + "/" + arg(1) + ")";
    case Kind::power:
      return "(" + arg(0) + "^" + arg(1) + ")";
    case Kind::transpose:
      return "(" + arg(0) + "')";
    default:
      break;
  }
  std::string text = e.kind == Kind::index ? "index(" : e.kind == Kind::literal ? "list(" : e.text + "(";
  for (size_t i = 0; i < e.arguments.size(); ++i) text += (i ? "," : "") + arg(i);
  return text + ")";
}

TEST(Expressions, Precedence) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"a + b*c", "(a+(b*c))"},
      {"a - b - c", "((a-b)-c)"},
      {"a/b/c", "((a/b)/c)"},
      {"a/b*c", "((a/b)*c)"},
      {"a^b^c", "(a^(b^c))"},
      {"-a^2", "(-(a^2))"},
      {"(-a)^2", "((-a)^2)"},
      {"2^-1", "(2^(-1))"},
      {"-a*b", "((-a)*b)"},
      {"a*-b", "(a*(-b))"},
      {"- -a", "(-(-a))"},
      {"a - -b", "(a-(-b))"},
      {"F'*F", "((F')*F)"},
      {"F'^2", "((F')^2)"},
      {"(A*B)'", "((A*B)')"},
      {"A''", "((A')')"},
      {"A'[0,1]^2", "(index((A'),0,1)^2)"},
      {"x[0]'", "(index(x,0)')"},
      {"f(a + 1, -b)^2", "(f((a+1),(-b))^2)"},
      {"f()", "f()"},
      {"[a, b; c, d]*[x, y]", "(list(a,b,c,d)*list(x,y))"},
      {"1.5e-3*x", "(1.5e-3*x)"},
      {"2e3", "2e3"},
      {"(((a)))", "a"},
  };
  for (const auto& [text, expected] : cases) EXPECT_EQ(tree(*parse(text)), expected) << text;
}

TEST(Expressions, ListsHaveShapes) {
  EXPECT_EQ(parse("[a, b, c]")->shape, (Shape{3, 1}));
  EXPECT_EQ(parse("[a; b; c]")->shape, (Shape{3, 1}));
  EXPECT_EQ(parse("[a, b; c, d; e, f]")->shape, (Shape{3, 2}));
  EXPECT_EQ(parse("[a]")->shape, (Shape{1, 1}));
}

TEST(Expressions, PlacesAreThoseOfTheOperators) {
  const ExpressionPtr e = parse("a + bb*log(c)");
  EXPECT_EQ(e->place.column, 3);
  EXPECT_EQ(e->arguments[1]->place.column, 7);
  EXPECT_EQ(e->arguments[1]->arguments[1]->place.column, 8);
}

TEST(Expressions, PrintingAndReadingGivesTheSameTree) {
  for (const char* text :
       {"a - (b - c)", "a/(b*c)", "(a + b)*c", "-(a + b)", "(a^b)^c", "a^b^c", "(-a)^2", "a^(-b)", "(A*B)'", "A'*B",
        "[a, b; c, d]", "[a, b, c][1]", "f(a, g(b))", "a - (b + c) - d", "a*(b/c)", "(a')[0]", "-a*b", "a*(-b)"}) {
    const ExpressionPtr first = parse(text);
    EXPECT_EQ(tree(*parse(to_text(*first))), tree(*first)) << text << " printed as " << to_text(*first);
  }
}

TEST(Expressions, DeepNestingIsRefused) {
  const std::string deep = std::string(5000, '(') + "a" + std::string(5000, ')');
  EXPECT_THROW(parse(deep), SourceError);
  EXPECT_THROW(parse(std::string(3000, '-') + "a"), SourceError);
  std::string wide = "a";
  for (int i = 0; i < 10000; ++i) wide += "+a";
  EXPECT_THROW(parse(wide), SourceError);
}

TEST(Statements, CommentsContinuationsAndPlaces) {
  const Statements s = split_statements(
      "\xEF\xBB\xBF# First line.\n#\n# Second line.\r\n\nvalue a +  # comment\n\n    b  # more\n\tc\nlet x = 1\n", "f");
  EXPECT_EQ(s.summary, "First line. Second line.");
  ASSERT_EQ(s.all.size(), 2u);
  EXPECT_EQ(s.all[0].text, "value a + b c");
  EXPECT_EQ(to_string(s.all[0].place(0)), "f:5:1");
  EXPECT_EQ(to_string(s.all[0].place(10)), "f:7:5");
  EXPECT_EQ(to_string(s.all[0].place(12)), "f:8:2");
  EXPECT_EQ(to_string(s.all[1].place(4)), "f:9:5");
}

TEST(EnergyFiles, DensityIsRead) {
  const Energy e = read_energy(test::source("/energies/solids/stable_neo_hookean.energy"));
  EXPECT_EQ(e.kind, Energy::Kind::density);
  EXPECT_EQ(e.name, "stable_neo_hookean");
  EXPECT_EQ(e.geometry, "solid");
  EXPECT_EQ(e.summary, "Isotropic solid. Finite at inversion, stress-free and stable at rest.");
  EXPECT_TRUE(e.cite.starts_with("Smith, de Goes, Kim 2018."));
  ASSERT_EQ(e.symbols.size(), 3u);
  EXPECT_EQ(e.symbols[0].name, "F");
  EXPECT_EQ(e.symbols[0].role, Role::dof);
  EXPECT_EQ(e.symbols[0].shape, (Shape{3, 3}));
  EXPECT_EQ(e.symbols[2].name, "nu");
  EXPECT_EQ(to_string(e.symbols[2].range), "(-1, 0.5)");
  EXPECT_EQ(e.symbols[2].help, "Poisson's ratio");
  EXPECT_EQ(to_string(e.find("E")->unit), "Pa");
  EXPECT_EQ(e.find("x"), nullptr);
  EXPECT_EQ(e.with_role(Role::param).size(), 2u);
  ASSERT_EQ(e.lets.size(), 2u);
  EXPECT_EQ(e.lets[0].name, "mu");
  EXPECT_TRUE(e.cases.empty());
  EXPECT_FALSE(e.fixed_frame);
  EXPECT_EQ(e.text, test::contents(e.file));
}

TEST(EnergyFiles, StencilWithCasesAndConditionsIsRead) {
  const Energy e = parse_energy(
      "energy   contact   point_triangle\n"
      "cite     Someone 2020. A paper,\n"
      "         continued.\n"
      "dof      p t0 t1 t2   m\n"
      "param    dhat         m       (0, inf)   activation distance\n"
      "lag      kappa        J/m^4   [0, 1e9]   (unlikely) stiffness\n"
      "rest     A0[3, 3]     1/m     # no help\n"
      "let      n = cross(t1 - t0, t2 - t0)\n"
      "case     face    gap2 = dot(p - t0, n)^2/norm2(n)\n"
      "case     vertex  gap2 = norm2(p - t0)\n"
      "active   gap2 < dhat^2\n"
      "require  gap2 > 0\n"
      "frame    fixed\n"
      "value    -kappa*(gap2 - dhat^2)^2*log(gap2/dhat^2)\n"
      "         *norm2(A0)*dhat^2\n",
      "f.energy");
  EXPECT_EQ(e.cite, "Someone 2020. A paper, continued.");
  EXPECT_EQ(e.cases, (std::vector<std::string>{"face", "vertex"}));
  EXPECT_EQ(e.with_role(Role::dof).size(), 4u);
  EXPECT_EQ(e.find("t2")->shape, (Shape{3, 1}));
  EXPECT_EQ(e.find("A0")->shape, (Shape{3, 3}));
  EXPECT_EQ(e.find("A0")->help, "");
  EXPECT_EQ(to_string(e.find("kappa")->range), "[0, 1000000000]");
  EXPECT_EQ(e.find("kappa")->help, "(unlikely) stiffness");
  EXPECT_FALSE(e.find("dhat")->range.contains(0));
  EXPECT_TRUE(e.find("kappa")->range.contains(0));
  EXPECT_TRUE(e.fixed_frame);
  ASSERT_EQ(e.active.size(), 1u);
  EXPECT_EQ(to_text(*e.active[0].left), "gap2");
  ASSERT_EQ(e.require.size(), 1u);
  EXPECT_EQ(to_text(*e.require[0].left), "0") << "gap2 > 0 is stored as 0 < gap2";
  EXPECT_EQ(e.lets[2].case_name, "vertex");
}

TEST(EnergyFiles, StencilsHavePointCounts) {
  EXPECT_EQ(points_of_stencil("point"), 1);
  EXPECT_EQ(points_of_stencil("hinge"), 4);
  EXPECT_EQ(points_of_stencil("point_edge"), 3);
  EXPECT_EQ(points_of_stencil("edge_edge"), 4);
  EXPECT_EQ(points_of_stencil("solid"), 0);
  EXPECT_EQ(shape_of_F("membrane"), (Shape{3, 2}));
  EXPECT_EQ(shape_of_F("edge"), std::nullopt);
}

TEST(EnergyFiles, WindowsLineEndsChangeNothing) {
  for (const auto& file : test::energy_files("energies")) {
    const std::string text = test::contents(file);
    std::string windows;
    for (const char c : text) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
    EXPECT_EQ(formula_text(parse_energy(windows, "w")), formula_text(parse_energy(text, "u"))) << file;
  }
}

TEST(Parser, ColumnsCountCharacters) {
  auto message = [](const std::string& text) -> std::string {
    try {
      parse_energy(text, "e.energy");
    } catch (const SourceError& error) {
      return error.what();
    }
    return "no error";
  };
  const std::string head = "energy e point\ndof x m\nparam k N/m (0, inf) ";
  EXPECT_EQ(message(head + "Steifigkeit in \xC3\xA4\xC3\xB6\xC3\xBC\nvalue k*norm2(y)\n"),
            "e.energy:4:15: unknown name 'y'; known here are k, x; a quantity is declared by `param NAME UNIT`, a part "
            "is named by `let`");
  EXPECT_EQ(
      message(head + "\nvalue \xC3\xA4 + k*norm2(y)\n"),
      "e.energy:4:7: found '\xC3\xA4', which has no meaning in an expression; names are written in the letters a to z, "
      "digits and '_'");
  EXPECT_EQ(message(head + "\nparam m\xC3\xBC 1\nvalue k*norm2(x)\n"),
            "e.energy:4:8: expected a blank after the name 'm', found '\xC3\xBC'");
  // Behind characters of two and three bytes in the same statement.
  EXPECT_EQ(message("energy e point\ncite \xC3\xA9\xE2\x82\xAC\ndof x \xC3\xA9 m\nvalue 0\n").substr(0, 14),
            "e.energy:3:7: ");
  const Statements split = split_statements("let \xC3\xA9\xE2\x82\xAC= x", "e.energy");
  EXPECT_EQ(split.all[0].place(4).column, 5);
  EXPECT_EQ(split.all[0].place(6).column, 6);
  EXPECT_EQ(split.all[0].place(9).column, 7);
}

TEST(Parser, PiIsAPureNumberThatNobodyElseNames) {
  const Energy e = parse_energy("energy e point\ndof x m\nparam k N/m\nvalue pi*k*norm2(x)*2^pi\n", "e.energy");
  EXPECT_EQ(to_text(*e.value), "pi*k*norm2(x)*2^pi");
  EXPECT_EQ(to_latex(*e.value->arguments[0]->arguments[0]), "\\pi \\, k");
  try {
    parse_energy("energy e point\ndof x m\nparam pi N/m\nvalue pi*norm2(x)\n", "e.energy");
    FAIL() << "no error";
  } catch (const SourceError& error) {
    EXPECT_STREQ(error.what(), "e.energy:3:7: 'pi' is the number 3.14159...; choose another name");
  }
}

}  // namespace
}  // namespace ergon
