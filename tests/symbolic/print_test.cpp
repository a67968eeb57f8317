#include "symbolic/print.h"

#include <gtest/gtest.h>

#include "tests/paths.h"
#include "tests/symbolic/energy_files.h"

namespace ergon {
namespace {

const char* text =
    "energy e edge\n"
    "dof x0 x1 m\n"
    "rest X0[3] m rest position\n"
    "param k N/m (0, inf) stiffness\n"
    "lag dhat m [0, 1/2]\n"
    "let u_long = x1 - (x0 - X0)\n"
    "case a g = norm2(u_long)/(2*3)\n"
    "case b g = (-dot(u_long, x1))^2/norm2(x1)\n"
    "active g < dhat^2\n"
    "require g > 1e-6*dhat^2\n"
    "value -k*g*log(1 + g/dhat^2) + k*norm(cross(x0, x1)) + 0*k*[1, 2; 3, 4][0,1]*tr(identity(3))*dhat^2\n";

TEST(Print, FormulaKeepsTheAuthorsStructure) {
  EXPECT_EQ(formula_text(parse_energy(text, "e")),
            "let u_long = x1 - (x0 - X0)\n"
            "case a g = norm2(u_long)/(2*3)\n"
            "case b g = (-dot(u_long, x1))^2/norm2(x1)\n"
            "active g < dhat^2\n"
            "require 1e-6*dhat^2 < g\n"
            "value -k*g*log(1 + g/dhat^2) + k*norm(cross(x0, x1)) + 0*k*[1, 2; 3, 4][0, 1]*tr(identity(3))*dhat^2\n");
}

TEST(Print, FormulaReadsBackAsItself) {
  for (const auto& file : test::energy_files("energies")) {
    const Energy energy = read_energy(file);
    std::string declarations;
    std::istringstream lines(energy.text);
    for (std::string line; std::getline(lines, line);)
      if (!line.starts_with("let") && !line.starts_with("case") && !line.starts_with("active") &&
          !line.starts_with("require") && !line.starts_with("value") && !line.starts_with("update") &&
          !line.starts_with("natural") && !line.starts_with("constraint"))
        declarations += line + "\n";
    const Energy again = parse_energy(declarations + formula_text(energy), "again");
    EXPECT_EQ(formula_text(again), formula_text(energy)) << file;
  }
}

TEST(Print, Latex) {
  EXPECT_EQ(formula_latex(parse_energy(text, "e")),
            "\\begin{align*}\n"
            "\\mathbf{u\\_long} &= \\mathbf{x}_{1} - \\left(\\mathbf{x}_{0} - \\mathbf{X}_{0}\\right) \\\\\n"
            "g &= \\frac{\\left\\|\\mathbf{u\\_long}\\right\\|^2}{2 \\cdot 3} && \\text{(a)} \\\\\n"
            "g &= \\frac{\\left(-\\left(\\mathbf{u\\_long} \\cdot "
            "\\mathbf{x}_{1}\\right)\\right)^{2}}{\\left\\|\\mathbf{x}_{1}\\right\\|^2} && \\text{(b)} \\\\\n"
            "g &< \\hat{d}^{2} && \\text{(active)} \\\\\n"
            "1 \\cdot 10^{-6} \\, \\hat{d}^{2} &< g && \\text{(required)} \\\\\n"
            "E &= -k \\, g \\, \\log\\left(1 + \\frac{g}{\\hat{d}^{2}}\\right) + k \\, \\left\\|\\left(\\mathbf{x}_{0} "
            "\\times \\mathbf{x}_{1}\\right)\\right\\| + 0 \\, k \\, \\begin{pmatrix}1 & 2 \\\\ 3 & "
            "4\\end{pmatrix}_{0,1} \\, \\operatorname{tr}\\left(\\mathbf{I}\\right) \\, \\hat{d}^{2}\n"
            "\\end{align*}\n");
}

TEST(Print, LatexOfASolid) {
  const Energy energy = read_energy(test::source("/energies/solids/neo_hookean.energy"));
  EXPECT_EQ(
      to_latex(*energy.value),
      "\\frac{\\mu}{2} \\, \\left(\\operatorname{tr}\\left(\\mathbf{F}^{\\mathsf{T}} \\, \\mathbf{F}\\right) - "
      "3\\right) - \\mu \\, \\log\\left(J\\right) + \\frac{\\lambda}{2} \\, \\left(\\log\\left(J\\right)\\right)^{2}");
}

TEST(Print, SymbolTable) {
  EXPECT_EQ(symbol_table(parse_energy(text, "e")),
            "name  role   shape        unit  range     meaning\n"
            "x0    dof    vector of 3  m     any\n"
            "x1    dof    vector of 3  m     any\n"
            "X0    rest   vector of 3  m     any       rest position\n"
            "k     param  scalar       N/m   (0, inf)  stiffness\n"
            "dhat  lag    scalar       m     [0, 0.5]\n");
}

}  // namespace
}  // namespace ergon
