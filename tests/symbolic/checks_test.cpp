#include "symbolic/checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "symbolic/eigenvalues.h"
#include "symbolic/reference.h"
#include "symbolic/sample_states.h"
#include "tests/paths.h"
#include "tests/symbolic/energy_files.h"

namespace ergon {
namespace {

std::string told(const Finding& f) { return std::string(to_string(f.severity)) + " " + f.check + ": " + f.message; }

// Warnings and errors.
std::vector<std::string> faults(const Energy& energy) {
  std::vector<std::string> result;
  for (const Finding& f : check_energy(energy))
    if (f.severity >= Severity::warning) result.push_back(told(f));
  return result;
}

Energy solid(const std::string& lines) {
  return parse_energy(
      "density e solid\nparam E Pa (0, inf)\nparam nu 1 (-1, 1/2)\nlet mu = E/(2*(1 + nu))\n"
      "let la = E*nu/((1 + nu)*(1 - 2*nu))\n" +
          lines,
      "e.energy");
}

using Faults = std::vector<std::string>;

class Catalogue : public testing::TestWithParam<std::string> {};

TEST_P(Catalogue, IsSound) {
  const Energy energy = test::shipped(GetParam());
  EXPECT_EQ(faults(energy), Faults{});
  EXPECT_GE(check_energy(energy).size(), 2u);
}

INSTANTIATE_TEST_SUITE_P(Files, Catalogue, testing::ValuesIn(test::catalogue_names()),
                         [](const auto& info) { return test::name_of_test(info.param); });

TEST(Checks, SolidsAreCheckedExactly) {
  std::vector<std::string> all;
  for (const Finding& f : check_energy(read_energy(test::source("/energies/solids/neo_hookean.energy"))))
    all.push_back(told(f));
  EXPECT_EQ(all,
            (std::vector<std::string>{
                "ok defined: value and derivatives are finite at random states",
                "ok smooth: no kink and no pole was found inside the domain",
                "ok rigid motion: the value keeps under rotation (exactly)", "ok rest: stress-free at F = I (exactly)",
                "ok moduli: the linearisation at F = I has the moduli E and nu (exactly)",
                "ok stable at rest: every small strain costs energy at F = I",
                "ok stiffness: every small strain costs energy from 0.01 to 3.79 times the "
                "length along one axis, 0.01 to 2.67 along two, 0.01 to 100 along three, and up to "
                "a shear of 4 (E = 1, nu = 0.3)",
                "ok symmetry: isotropic",
                "ok collapse: the value grows without bound as the length along one axis "
                "falls to 0",
                "ok inversion: not finite at inversion; `require` keeps away from it"}));
}

TEST(Checks, WhatIsInfiniteAtCollapseNeedsARequire) {
  const std::string law = "density e solid\nparam k Pa (0, inf)\nvalue k/2*(norm2(F) + norm2(inverse(F)) - 6)\n";
  EXPECT_THAT(faults(parse_energy(law, "e.energy")),
              testing::ElementsAre(testing::StartsWith("warning inversion: inverse(F) is infinite at det(F) = 0")));
  EXPECT_EQ(faults(parse_energy(law + "require det(F) > 0\n", "e.energy")), Faults{});
}

// The state of a finding is one that `ergon eval` takes; here it is read back, to the digits that it is told with.
TEST(Checks, TheStateShowsTheFault) {
  const Energy e = solid("let J = det(F)\nvalue mu/2*(tr(F'*F) - 3) + la/2*(J - 1)^2 + mu*abs(J - 2)\n");
  bool found = false;
  for (const Finding& f : check_energy(e)) {
    if (f.check != "smooth") continue;
    found = true;
    EXPECT_EQ(f.severity, Severity::error);
    EXPECT_EQ(to_string(f.place), "e.energy:7:49");
    Inputs inputs;
    std::istringstream words(f.state);
    for (std::string word; words >> word;) {
      if (word == "--set") continue;
      const size_t equals = word.find('=');
      std::istringstream numbers(word.substr(equals + 1));
      for (std::string number; std::getline(numbers, number, ',');)
        inputs[word.substr(0, equals)].push_back(std::stod(number));
    }
    const std::vector<double>& F = inputs.at("F");
    const double J =
        F[0] * (F[4] * F[8] - F[5] * F[7]) - F[3] * (F[1] * F[8] - F[2] * F[7]) + F[6] * (F[1] * F[5] - F[2] * F[4]);
    EXPECT_NEAR(J, 2, 1e-10);
    EXPECT_EQ(inputs.size(), 3u);
  }
  EXPECT_TRUE(found);
}

// Smoothed kinks, and kinks of parts that are flat there, are none.
TEST(Checks, WhatIsSmoothIsNotBlamed) {
  for (const char* term : {"mu*max(J - 2, 0)^3", "mu*abs(J - 2)^3", "mu*sqrt((J - 2)^2 + 0.01)", "mu*sqrt(norm2(F))^4",
                           "mu*norm(F)^2", "mu*(sqrt(abs(J - 2)))^8", "mu*exp(-(J - 2)^2)"}) {
    const Energy e = solid(std::string("let J = det(F)\nvalue la*J + ") + term + "\n");
    for (const Finding& f : check_energy(e)) {
      if (f.check == "smooth") {
        EXPECT_EQ(f.severity, Severity::ok) << term << ": " << to_string(f);
      }
    }
  }
}

// Poles at the open end of a range, or where `require` ends, are outside.
TEST(Checks, PolesAtTheBoundaryAreOutside) {
  EXPECT_EQ(faults(solid("let G = (F'*F - identity(3))/2\nvalue mu*norm2(G) + la/2*tr(G)^2\n")), Faults{});
  EXPECT_EQ(
      faults(parse_energy("energy e edge\ndof x0 x1 m\nrest X0[3] X1[3] m\nparam k J (0, inf)\nlet L = norm2(X1 - "
                          "X0)\nrequire L > 0\nvalue k/2*(norm2(x1 - x0)/L - 1)^2\n",
                          "e.energy")),
      Faults{});
}

TEST(Checks, MembraneAndLineDensities) {
  EXPECT_EQ(
      faults(parse_energy(
          "density e membrane\nparam k N/m (0, inf)\nlet G = (F'*F - identity(2))/2\nvalue k*norm2(G)\n", "e.energy")),
      Faults{});
  EXPECT_EQ(faults(parse_energy("density e line\nparam k N (0, inf)\nvalue k/2*(norm(F) - 1)^2\n", "e.energy")),
            Faults{});
}

TEST(Checks, HingeIsSound) {
  const Energy e = parse_energy(
      "energy e hinge\ndof x0 x1 x2 x3 m\nrest X0[3] X1[3] X2[3] X3[3] m\nparam k J (0, inf)\n"
      "require norm2(cross(X1 - X0, X2 - X0)) > 0\nrequire norm2(cross(X1 - X0, X3 - X0)) > 0\n"
      "let rest = dihedral(X0, X1, X2, X3)\nvalue k/2*(dihedral(x0, x1, x2, x3) - rest)^2\n",
      "e.energy");
  EXPECT_EQ(faults(e), Faults{});
}

TEST(SampleStates, RotationsAreExact) {
  StateSampler sampler;
  for (int i = 0; i < 5; ++i) {
    const auto R = sampler.rotation();
    EXPECT_EQ(determinant(R), Rational(1));
    for (size_t a = 0; a < 3; ++a) {
      for (size_t b = 0; b < 3; ++b) {
        Rational dot = 0;
        for (size_t k = 0; k < 3; ++k) dot = dot + R[3 * a + k] * R[3 * b + k];
        EXPECT_EQ(dot, Rational(a == b ? 1 : 0));
      }
    }
  }
}

TEST(Eigenvalues, OfKnownMatrices) {
  EXPECT_EQ(symmetric_eigenvalues({3}, 1), std::vector<double>{3});
  const auto two = symmetric_eigenvalues({2, 1, 1, 2}, 2);
  EXPECT_NEAR(two[0], 1, 1e-15);
  EXPECT_NEAR(two[1], 3, 1e-15);
  // 2 on the diagonal and -1 beside it: 2 - 2 cos(k pi/(n + 1)).
  const int n = 7;
  std::vector<double> a(n * n, 0.0);
  for (int i = 0; i < n; ++i) {
    a[static_cast<size_t>(i * n + i)] = 2;
    if (i > 0) a[static_cast<size_t>(i * n + i - 1)] = a[static_cast<size_t>((i - 1) * n + i)] = -1;
  }
  const auto values = symmetric_eigenvalues(a, n);
  for (int k = 0; k < n; ++k)
    EXPECT_NEAR(values[static_cast<size_t>(k)], 2 - 2 * std::cos((k + 1) * M_PI / (n + 1)), 1e-14);
}

}  // namespace
}  // namespace ergon
