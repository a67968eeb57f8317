// `natural`: densities whose shape without stress is not the one at rest.

#include "symbolic/natural.h"

#include <cln/dfloat.h>
#include <gtest/gtest.h>

#include "symbolic/checks.h"
#include "symbolic/print.h"
#include "symbolic/reference.h"

namespace ergon {
namespace {

// A solid that grows by G, of the moduli E and nu where it is without stress; per volume of that shape, times det(G).
std::string grown(const std::string& natural, const std::string& growth) {
  return "density  law  solid\nparam    E  Pa  (0, inf)\nparam    nu  1  [0, 1/2)\n" + growth +
         "let      Fe = F*inverse(G)\nlet      strain = (Fe'*Fe - identity(3))/2\nrequire  det(G) > 0\n" + natural +
         "value    det(G)*E/(2*(1 + nu))*(norm2(strain) + nu/(1 - 2*nu)*tr(strain)^2)\n";
}

const std::string along_an_axis = "param    g  1  (0, inf)\nlet      G = [g, 0, 0; 0, 1, 0; 0, 0, 1]\n";
const std::string sheared = "param    g  1  (0, inf)\nlet      G = [1, g, 0; 0, 2, 0; 0, 0, 1]\n";

std::vector<std::string> told(const std::string& text) {
  std::vector<std::string> out;
  for (const Finding& finding : check_energy(parse_energy(text, "law.energy")))
    if (finding.check == "rest" || finding.check == "moduli") out.push_back(finding.message);
  return out;
}

TEST(Natural, IsWhereStressAndModuliAreLookedFor) {
  const std::vector<std::string> sound = {"stress-free at F = `natural` (exactly)",
                                          "the linearisation at F = `natural` has the moduli E and nu (exactly)"};
  EXPECT_EQ(told(grown("natural  G\n", along_an_axis)), sound);
  EXPECT_EQ(told(grown("natural  G\n", sheared)), sound);
  EXPECT_EQ(told(grown("", along_an_axis)).at(0).substr(0, 26), "not stress-free at F = I: ");
}

TEST(Natural, IsTheEnergyPerVolumeOfThatShape) {
  const Energy law = parse_energy(grown("natural  G\n", sheared), "law.energy");
  EXPECT_NE(formula_text(law).find("natural G\n"), std::string::npos);
  EXPECT_NE(formula_latex(law).find("\\mathbf{F}_\\text{natural} &= \\mathbf{G}"), std::string::npos);
  EXPECT_NE(formula_mathml(law).find("<mtext>natural</mtext></msub>"), std::string::npos);
  const Inputs params = {{"E", {3}}, {"nu", {0.25}}, {"g", {0.5}}};
  Inputs elastic = params, whole = params;
  elastic["F"] = {1.5, 0, 0, 0, 1, 0, 0, 0, 1};
  whole["F"] = {1.5, 0, 0, 0.75, 2, 0, 0, 0, 1};  // Fe G
  const double seen = evaluate_reference(seen_from_natural(law), "", elastic).value;
  EXPECT_EQ(2 * seen, evaluate_reference(law, "", whole).value);
  ExactInputs state = {{"F", {}}, {"E", {3}}, {"nu", {0}}, {"g", {cln::cl_RA("1/2")}}};
  for (const double x : elastic["F"]) state["F"].push_back(cln::rational(cln::cl_DF(x)));
  const ExactInputs there = seen_from_rest(law, "", state);
  for (size_t i = 0; i < 9; ++i) EXPECT_EQ(cln::double_approx(there.at("F")[i]), whole["F"][i]);
}

}  // namespace
}  // namespace ergon
