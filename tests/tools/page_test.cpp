// The page of the catalogue: every energy with formula and curve, well formed, links that lead somewhere.

#include <gmock/gmock.h>

#include "symbolic/print.h"
#include "tests/symbolic/energy_files.h"
#include "tests/tools/command.h"
#include "tests/tools/xml.h"

namespace ergon {
namespace {

using testing::HasSubstr;

class Page : public CommandTest {};
class SlowPage : public Page {};

TEST_F(SlowPage, HoldsTheWholeCatalogue) {
  const Answer answer = ergon("show --all --html catalogue.html");
  ASSERT_EQ(answer.code, 0) << answer.err;
  const std::string page = read("catalogue.html");
  EXPECT_EQ(test::fault_of_xml(page), "");
  // Nothing is fetched: the only addresses are names of XML's own.
  EXPECT_EQ(test::count_of(page, "http"), test::count_of(page, "xmlns=\"http"));
  const auto files = test::energy_files("energies");
  EXPECT_EQ(answer.out, "catalogue.html: " + std::to_string(files.size()) + " energies\n");
  EXPECT_EQ(test::count_of(page, "<section "), static_cast<int>(files.size()));
  EXPECT_EQ(test::count_of(page, "<math "), static_cast<int>(files.size()));
  EXPECT_EQ(test::count_of(page, "<svg "), static_cast<int>(files.size()));
  for (const auto& file : files) {
    EXPECT_THAT(page, HasSubstr("<section id=\"" + file.stem().string() + "\">"));
    EXPECT_THAT(page, HasSubstr("<a href=\"#" + file.stem().string() + "\">"));
  }
  EXPECT_EQ(test::count_of(page, "<a href=\"#"), static_cast<int>(files.size()));
  EXPECT_EQ(page.find("NaN"), std::string::npos);
}

TEST_F(Page, ShowsOneEnergyOrAFolder) {
  ASSERT_EQ(ergon("show mooney_rivlin --html one.html").code, 0);
  const std::string page = read("one.html");
  EXPECT_EQ(test::fault_of_xml(page), "");
  for (const char* part : {"<h2>mooney_rivlin ", "of the second invariant; the shear modulus is 2*(C10 + C01)",
                           "Mooney 1940.", "<td>isotropic; projected in closed form", "<td>[0, inf)</td>",
                           ">equibiaxial<", "<mfrac>", "<summary>the file</summary>"})
    EXPECT_THAT(page, HasSubstr(part));
  ASSERT_EQ(ergon("new solid rubber --folder laws").code, 0);
  ASSERT_EQ(ergon("new barrier wall --folder laws").code, 0);
  EXPECT_EQ(ergon("show laws --html two.html").out, "two.html: 2 energies\n");
  EXPECT_EQ(test::fault_of_xml(read("two.html")), "");
  EXPECT_EQ(ergon("show --html none.html").err,
            "ergon: error: 'ergon show' needs an energy, or --all for the whole catalogue\n");
  EXPECT_THAT(ergon("show --all").out, HasSubstr("\nmooney_rivlin: density of a solid, in Pa\n"));
  EXPECT_THAT(ergon("show spring --kernel").out, testing::StartsWith("static void prepare_uniforms"));
}

TEST(MathMl, WritesEveryFormulaOfTheCatalogue) {
  for (const Energy& energy : test::catalogue())
    EXPECT_EQ(test::fault_of_xml(formula_mathml(energy)), "") << energy.name;
  const Energy energy = parse_energy("density a solid\nparam mu Pa\nvalue -mu/2*(tr(F'*F) - 3)^2\n", "a");
  EXPECT_EQ(
      to_mathml(*energy.value),
      "<mrow><mfrac><mrow><mrow><mo>−</mo><mi>μ</mi></mrow></mrow><mrow><mn>2</mn></mrow></mfrac><mo>&#8290;</mo>"
      "<msup><mrow><mo>(</mo><mrow><mrow><mi>tr</mi><mrow><mo>(</mo><mrow><msup><mi style=\"font-weight:bold\">F</mi>"
      "<mi>T</mi></msup><mo>&#8290;</mo><mi style=\"font-weight:bold\">F</mi></mrow><mo>)</mo></mrow></mrow>"
      "<mo>−</mo><mn>3</mn></mrow><mo>)</mo></mrow><mrow><mn>2</mn></mrow></msup></mrow>");
}

}  // namespace
}  // namespace ergon
