// Operation counts of the catalogue are pinned: a change of the compiler that costs or saves shows here.
// ERGON_UPDATE_GOLDEN=1 writes the file anew.

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "codegen/compile.h"
#include "tests/paths.h"
#include "tests/symbolic/energy_files.h"

namespace ergon {
namespace {

TEST(OperationCounts, ArePinned) {
  std::string counted =
      "# energy case: value gradient hessian principal projected (divisions roots calls) kept per material, per "
      "element\n";
  for (const Energy& energy : test::catalogue()) {
    std::vector<std::string> cases = energy.cases.empty() ? std::vector<std::string>{""} : energy.cases;
    for (const std::string& c : cases) {
      OperationCounts n = generate(energy, {.case_name = c}).counts;
      counted +=
          fmt::format("{} {}: {} {} {} {} {} ({} {} {}) {} {}\n", energy.name, c.empty() ? "-" : c, n.value, n.gradient,
                      n.hessian, n.principal, n.projected, n.divisions, n.roots, n.calls, n.uniforms, n.elements);
    }
  }
  const std::string golden = test::source("/tests/codegen/operation_counts.golden");
  if (std::getenv("ERGON_UPDATE_GOLDEN")) std::ofstream(golden) << counted;
  std::ostringstream kept;
  kept << std::ifstream(golden).rdbuf();
  EXPECT_EQ(counted, kept.str()) << "run with ERGON_UPDATE_GOLDEN=1 when the change is meant";
}

}  // namespace
}  // namespace ergon
