// `part`: energies that are sound in a sum only.

#include <gtest/gtest.h>

#include "symbolic/checks.h"

namespace ergon {
namespace {

std::vector<std::string> faults(const std::string& text) {
  std::vector<std::string> out;
  for (const Finding& finding : check_energy(parse_energy(text, "law.energy")))
    if (finding.severity >= Severity::warning) out.push_back(finding.check);
  return out;
}

// A tension and the pressure on a triangle are not sound alone; as parts they are, and rotation is still looked at.
TEST(Part, IsNotAskedForWhatOnlyTheWholeHas) {
  const std::string part = "part of a sum\n";
  const auto tension = [](const std::string& stated) {
    return faults("density law solid\n" + stated +
                  "param T Pa (0, inf) tension\nrequire norm2(column(F, 0)) > 0\nvalue T*norm(column(F, 0))\n");
  };
  EXPECT_EQ(tension(""), (std::vector<std::string>{"rest", "stable at rest"}));
  EXPECT_EQ(tension(part), std::vector<std::string>{});
  const auto pressure = [](const std::string& stated, const std::string& value) {
    return faults("energy law triangle\n" + stated + "dof x0 x1 x2 m\nparam p Pa (0, inf) pressure\nvalue " + value +
                  "\n");
  };
  EXPECT_EQ(pressure("", "-p/6*dot(x0, cross(x1, x2))"), std::vector<std::string>{"rigid motion"});
  EXPECT_EQ(pressure(part, "-p/6*dot(x0, cross(x1, x2))"), std::vector<std::string>{});
  EXPECT_EQ(pressure(part, "-p/6*x0[0]*dot(x1, x2)"), std::vector<std::string>{"rigid motion"});
}

TEST(Part, IsReadAsText) {
  const Energy energy = parse_energy(
      "density law solid\npart of a solid that resists shear\nparam K Pa (0, inf) modulus\nvalue K*(det(F) - 1)^2\n",
      "law.energy");
  EXPECT_EQ(energy.part_of, "of a solid that resists shear");
}

}  // namespace
}  // namespace ergon
