// The symmetry group of a density's shape at rest, for crafted laws of every group and for the catalogue.
#include "symbolic/symmetry.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/symbolic/energy_files.h"

namespace ergon {
namespace {

std::string symmetry(const std::string& text) {
  const auto found = material_symmetry(parse_energy(text, "law.energy"), "");
  return found ? to_string(*found) : "-";
}

std::string solid(const std::string& rest) {
  return symmetry("density law solid\nparam k Pa (0, inf)\nlet E = (F'*F - identity(3))/2\n" + rest);
}

std::string membrane(const std::string& rest) {
  return symmetry("density law membrane\nparam k N/m (0, inf)\nlet E = (F'*F - identity(2))/2\n" + rest);
}

// E in the axes of R.
const char* const turned = "let R = [2, -1, 2; 2, 2, -1; -1, 2, 2]/3\nlet S = R'*E*R\n";
const char* const turned_flat = "let R = [3, -4; 4, 3]/5\nlet S = R'*E*R\n";

TEST(Symmetry, OfSolids) {
  EXPECT_EQ(solid("value k*norm2(E) + k*tr(E)^3\n"), "isotropic");
  EXPECT_EQ(solid("frame fixed\nvalue k*norm2(sym(F) - identity(3)) + 0*E[0,0]*k\n"), "isotropic");
  EXPECT_EQ(
      solid("param fibre[3] 1\nrequire norm2(fibre) > 0\nvalue k*norm2(E) + k*dot(fibre, E*fibre)^2/norm2(fibre)\n"),
      "transversely isotropic about fibre");
  EXPECT_EQ(solid("value k*norm2(E) + k*E[1,1]^2\n"), "transversely isotropic about y");
  const std::string cubic = "value k*norm2(E) + k*(S[0,0]^2 + S[1,1]^2 + S[2,2]^2)\n";
  EXPECT_EQ(solid("let S = E\n" + cubic), "cubic along x, y and z");
  EXPECT_EQ(solid(turned + cubic),
            "cubic along (0.3333, -0.6667, -0.6667), (0.6667, -0.3333, 0.6667) and (0.6667, 0.6667, -0.3333)");
  EXPECT_EQ(solid(turned + std::string("value 2*k*norm2(S) - k*(S[0,0]^2 + S[1,1]^2 + S[2,2]^2)\n")).substr(0, 11),
            "cubic along");  // the axes are the softest directions
  EXPECT_EQ(solid("value k*(norm2(E) + E[0,0]^2 + E[1,1]^2) + k*E[2,2]\n"), "tetragonal about z");
  EXPECT_EQ(solid("let a = E[0,0] - E[1,1]\nlet b = 2*E[0,1]\nvalue k*norm2(E) + k*E[2,2]^2 + k*(a^3 - 3*a*b^2)\n"),
            "hexagonal about z");
  EXPECT_EQ(solid("value k*norm2(E) + k*((E[0,0] - E[1,1])*E[0,2] - 2*E[0,1]*E[1,2])\n"), "trigonal about z");
  const std::string orthotropic = "value k*norm2(S) + k*(S[0,0]^2 + 2*S[1,1]^2)\n";
  EXPECT_EQ(solid("let S = E\n" + orthotropic), "orthotropic along x, y and z");
  EXPECT_EQ(solid(turned + orthotropic),
            "orthotropic along (0.3333, -0.6667, -0.6667), (0.6667, 0.6667, -0.3333) and (0.6667, -0.3333, 0.6667)");
  const std::string fibres = "param a[3] b[3] 1\nlet u = dot(a, E*a)/norm2(a)\nlet v = dot(b, E*b)/norm2(b)\n";
  EXPECT_EQ(solid(fibres + "value k*norm2(E) + k*u^2 + k*v^2\n"),
            "orthotropic along cross(a, b), the bisector of a and b and the bisector of a and -b");
  EXPECT_EQ(solid(fibres + "value k*norm2(E) + k*u^2 + 2*k*v^2\n"),
            "monoclinic: symmetric in the plane across cross(a, b)");
  EXPECT_EQ(solid("value k*norm2(E) + k*(E[0,0] + E[1,1]/2)*(E[0,0] - 3*E[0,1]) + 9*k*E[0,0]^2\n"),
            "monoclinic: symmetric in the plane across z");
  EXPECT_EQ(solid("value k*norm2(E) + k*(E[0,0] + E[0,1])^2 + k*(E[1,1] - 2*E[1,2])^2\n"),
            "none: any turn of the shape at rest changes the value");
}

TEST(Symmetry, SeenOnlyInWhatIsNotLinear) {
  EXPECT_EQ(solid("value k*norm2(E) + k*E[0,0]^4\n"), "transversely isotropic about x");
  EXPECT_EQ(solid("value k*norm2(E) + k*(E[0,0]*E[1,1]*E[2,2])^2/10^9\n"), "cubic along x, y and z");
  EXPECT_EQ(solid("let I = E[0,0] + E[1,1] - 2*E[2,2]\nvalue k*norm2(E) + k*I^6\n"), "transversely isotropic about z");
}

TEST(Symmetry, OfMembranes) {
  EXPECT_EQ(membrane("value k*norm2(E)\n"), "isotropic");
  const std::string square = "value k*norm2(E) + k*(S[0,0]^2 + S[1,1]^2)\n";
  EXPECT_EQ(membrane("let S = E\n" + square), "square along the first axis and the second axis");
  EXPECT_EQ(membrane(turned_flat + square), "square along (0.6, 0.8, 0) and (0.8, -0.6, 0)");
  const std::string orthotropic = "value k*norm2(E) + k*S[0,0]^2\n";
  EXPECT_EQ(membrane("let S = E\n" + orthotropic), "orthotropic along the first axis and the second axis");
  EXPECT_EQ(membrane(turned_flat + orthotropic), "orthotropic along (0.6, 0.8, 0) and (0.8, -0.6, 0)");
  EXPECT_EQ(membrane("param warp[2] 1\nvalue k*norm2(E) + k*dot(warp, E*warp)^2/norm2(warp)^2\n"),
            "orthotropic along warp and across warp");
  EXPECT_EQ(membrane("let a = E[0,0] - E[1,1]\nlet b = 2*E[0,1]\nvalue k*norm2(E) + k*(a^3 - 3*a*b^2)\n"),
            "hexagonal along the first axis and the second axis");
  EXPECT_EQ(membrane("value k*norm2(E) + k*E[0,0]^2 + k*E[0,0]*E[0,1]\n"),
            "none: any turn of the shape at rest changes the value");
}

TEST(Symmetry, OfWhatIsNoSolidIsNotTold) {
  EXPECT_EQ(symmetry("density law line\nparam k N (0, inf)\nvalue k*(norm2(F) - 1)^2\n"), "-");
  EXPECT_EQ(symmetry("energy law point\nframe fixed\ndof x m\nparam k N/m (0, inf)\nvalue k*norm2(x)\n"), "-");
}

TEST(Symmetry, OfTheShapeWithoutStress) {
  const std::string grown =
      "density law membrane\nparam k N/m (0, inf)\nparam g 1 (1, 2)\nnatural [g, 0; 0, 1]\n"
      "let Fe = F*[1/g, 0; 0, 1]\nvalue g*k*norm2(Fe'*Fe - identity(2))\n";
  EXPECT_EQ(symmetry(grown), "isotropic");
}

TEST(Symmetry, OfTheCatalogue) {
  const std::map<std::string, std::string> other = {
      {"baraff_witkin", "orthotropic along the first axis and the second axis"},
      {"fibre_reinforced", "transversely isotropic about a"},
      {"muscle", "transversely isotropic about a"},
      {"orthotropic_membrane", "orthotropic along the first axis and the second axis"},
      {"two_fibre_families", "orthotropic along cross(a, b), the bisector of a and b and the bisector of a and -b"}};
  size_t seen = 0;
  for (const Energy& energy : test::catalogue()) {
    if (energy.kind != Energy::Kind::density || energy.geometry == "line") continue;
    const auto found = material_symmetry(energy, "");
    ASSERT_TRUE(found) << energy.name;
    const auto expected = other.find(energy.name);
    if (expected != other.end()) ++seen;
    EXPECT_EQ(to_string(*found), expected == other.end() ? "isotropic" : expected->second) << energy.name;
  }
  EXPECT_EQ(seen, other.size());
}

}  // namespace
}  // namespace ergon
