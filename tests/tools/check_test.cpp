// What `ergon check` tells of a file beyond its soundness as mechanics: its name, and what the compiler makes of it.

#include <gmock/gmock.h>

#include "tests/symbolic/energy_files.h"
#include "tests/tools/command.h"
#include "tools/installation.h"
#include "tools/kernel_findings.h"

namespace ergon {
namespace {

using testing::HasSubstr;
using testing::Not;

class Check : public CommandTest {};

TEST_F(Check, TellsStructureCostAndAccuracy) {
  const Answer answer = ergon("check neo_hookean");
  EXPECT_EQ(answer.code, 0) << answer.err;
  EXPECT_THAT(answer.out, HasSubstr("  ok       structure       isotropic; projected in closed form over the singular "
                                    "values of F\n"));
  EXPECT_THAT(answer.out, HasSubstr("  ok       cost            operations per point of quadrature: value "));
  EXPECT_THAT(answer.out,
              HasSubstr("  ok       accuracy        against 50 digits at strains of 0.25, in units of 2^-53: "));
  EXPECT_THAT(answer.out, HasSubstr("  ok       collapse        the value grows without bound as the length along one "
                                    "axis falls to 0\n"));
  EXPECT_THAT(answer.out, HasSubstr(" along one axis, "));
}

TEST_F(Check, FindsNamesThatLeadAstray) {
  write("one.energy",
        "# A spring to the origin.\nenergy other point\nframe fixed\ndof x m\nparam k N/m (0, inf)\n"
        "value k/2*norm2(x)\n");
  EXPECT_THAT(
      ergon("check one.energy").out,
      HasSubstr("  warning  name          the file one.energy holds an energy named 'other'; name both alike\n"));
  write("spring.energy",
        "# A spring to the origin.\nenergy spring point\nframe fixed\ndof x m\nparam k N/m (0, inf)\n"
        "value k/2*norm2(x)\n");
  const Answer clash = ergon("check spring.energy");
  EXPECT_EQ(clash.code, 0);
  EXPECT_THAT(clash.out, HasSubstr("  warning  name          the catalogue has 'spring' too ("));
  EXPECT_THAT(clash.out, HasSubstr("and finds that one where a scene names no file; choose another name\n"));
  EXPECT_THAT(ergon("check spring").out, Not(HasSubstr(" name ")));
}

std::string structure(const std::string& energy) { return structure_text(test::shipped(energy), ""); }

TEST(KernelFindings, NameTheStructureThatWasFound) {
  EXPECT_EQ(structure("linear_elasticity"), "the Hessian is constant: evaluated and assembled once");
  EXPECT_EQ(structure("gravity"), "the Hessian is zero");
  EXPECT_THAT(structure("spring"), HasSubstr("a function of one scalar: projected in closed form"));
  EXPECT_EQ(structure("fibre_reinforced"),
            "the Hessian depends on the state and is projected where a test finds it needed");
}

TEST(SlowKernelFindings, EveryKernelOfTheCatalogueIsThatOfItsText) {
  for (const Energy& energy : test::catalogue()) {
    if (energy.name.ends_with(":offset")) continue;
    int accuracies = 0;
    for (const Finding& finding : kernel_findings(energy)) {
      EXPECT_EQ(finding.severity, Severity::ok) << energy.name << ": " << to_string(finding);
      accuracies += finding.check == "accuracy" ? 1 : 0;
    }
    EXPECT_GE(accuracies, 1) << energy.name;
  }
}

}  // namespace
}  // namespace ergon
