#include "symbolic/checks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "symbolic/eigenvalues.h"
#include "symbolic/sample_states.h"
#include "tests/symbolic/energy_files.h"

namespace ergon {
namespace {

std::string told(const Finding& f) {
  const char* severity = f.severity == Severity::ok ? "ok" : f.severity == Severity::warning ? "warning" : "error";
  return std::string(severity) + " " + f.check + ": " + f.message;
}

// The findings that are not ok.
std::vector<std::string> faults(const Energy& energy) {
  std::vector<std::string> result;
  for (const Finding& f : check_energy(energy))
    if (f.severity != Severity::ok) result.push_back(told(f));
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

class Catalogue : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Catalogue, IsSound) {
  const Energy energy = read_energy(GetParam());
  EXPECT_EQ(faults(energy), Faults{});
  EXPECT_GE(check_energy(energy).size(), 2u);
}

INSTANTIATE_TEST_SUITE_P(Files, Catalogue, testing::ValuesIn(test::energy_files("energies")),
                         [](const auto& info) { return info.param.stem().string(); });

TEST(Checks, SolidsAreCheckedExactly) {
  std::vector<std::string> all;
  for (const Finding& f : check_energy(read_energy(ERGON_SOURCE_DIR "/energies/solids/neo_hookean.energy")))
    all.push_back(told(f));
  EXPECT_EQ(all, (std::vector<std::string>{"ok defined: value and derivatives are finite at random states",
                                           "ok rigid motion: the value keeps under rotation (exactly)",
                                           "ok rest: stress-free at F = I (exactly)",
                                           "ok moduli: the linearisation at F = I has the moduli E and nu (exactly)",
                                           "ok stable at rest: every small strain costs energy at F = I",
                                           "ok inversion: not finite at inversion; `require` keeps away from it"}));
}

// At nu = 0.25 the shear modulus is half of what E and nu give; towards nu = -1 volume changes then give energy away.
const Faults half_the_shear = {
    "error moduli: with E = 1 Pa and nu = 0.25 the second derivative by F[0,0] and F[0,0] at F = I is 0.8 Pa, expected "
    "1.2 Pa",
    "error stable at rest: a small strain at F = I gives energy away: the smallest eigenvalue of the stiffness is "
    "-0.93 "
    "of the largest"};

TEST(Checks, StressAtRest) {
  Faults expected = {"error rest: not stress-free at F = I: the derivative by F[0,0] is 4, expected 0"};
  expected.insert(expected.end(), half_the_shear.begin(), half_the_shear.end());
  EXPECT_EQ(faults(solid("value mu/2*(tr(F'*F) - 3) + la/2*(det(F) - 1)^2\n")), expected);
}

TEST(Checks, WrongModuli) {
  EXPECT_EQ(faults(solid("let G = (F'*F - identity(3))/2\nvalue mu/2*norm2(G) + la/2*tr(G)^2\n")), half_the_shear);
}

TEST(Checks, RotationChangesTheValue) {
  const Faults found = faults(solid("let strain = sym(F) - identity(3)\nvalue mu*norm2(strain) + la/2*tr(strain)^2\n"));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].starts_with("error rigid motion: the value changes under rotation (by ")) << found[0];
  EXPECT_TRUE(found[0].ends_with("of itself); state `frame fixed` if that is meant")) << found[0];
}

TEST(Checks, FrameIsNotFixed) {
  EXPECT_EQ(
      faults(solid("frame fixed\nlet G = (F'*F - identity(3))/2\nvalue mu*norm2(G) + la/2*tr(G)^2\n")),
      (Faults{"warning rigid motion: the value keeps under rotation, yet the energy states `frame fixed`; remove it"}));
}

TEST(Checks, TranslationChangesTheValue) {
  const Energy e = parse_energy("energy e point\ndof x m\nparam k N/m (0, inf)\nvalue k/2*norm2(x)\n", "e.energy");
  const Faults found = faults(e);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].starts_with("error rigid motion: the value changes under rotation and translation")) << found[0];
}

TEST(Checks, InversionIsNotKeptAway) {
  EXPECT_EQ(
      faults(solid("let J = det(F)\nvalue mu/2*(tr(F'*F) - 3) - mu*log(J) + la/2*log(J)^2\n")),
      (Faults{"warning inversion: not finite for det(F) < 0, and no `require` keeps away from there; add `require "
              "det(F) > 0`"}));
}

TEST(Checks, SignErrorIsUnstable) {
  const Energy e = parse_energy(
      "density e solid\nparam k Pa (0, inf)\nlet G = (F'*F - identity(3))/2\nvalue -k*norm2(G)\n", "e.energy");
  EXPECT_EQ(faults(e),
            (Faults{"error stable at rest: a small strain at F = I gives energy away: the smallest eigenvalue of "
                    "the stiffness is -1 of the largest"}));
}

TEST(Checks, VolumeTermAloneIsOnlySemiDefinite) {
  const Energy e = parse_energy("density e solid\nparam k Pa (0, inf)\nvalue k/2*(det(F) - 1)^2\n", "e.energy");
  EXPECT_EQ(faults(e), (Faults{"warning stable at rest: some small strain at F = I costs nothing"}));
}

TEST(Checks, ForceAtRestPositions) {
  const Energy e = parse_energy(
      "energy e edge\ndof x0 x1 m\nrest X0[3] X1[3] m\nparam k N/m (0, inf)\nlet L = norm(X1 - X0)\nrequire L > 0\n"
      "value k/2*(norm(x1 - x0) - L/2)^2\n",
      "e.energy");
  const Faults found = faults(e);
  ASSERT_GE(found.size(), 1u);
  EXPECT_TRUE(found[0].starts_with("error rest: not force-free at the rest positions: the derivative by x"))
      << found[0];
}

TEST(Checks, NotFiniteWhereConditionsHold) {
  const Energy e = parse_energy(
      "energy e edge\ndof x0 x1 m\nparam L m (0, inf)\nparam k J (0, inf)\nvalue k*log(norm(x1 - x0)/L - 1)\n",
      "e.energy");
  const Faults found = faults(e);
  ASSERT_GE(found.size(), 1u);
  EXPECT_TRUE(
      found[0].starts_with("error defined: value or derivatives are not finite where all conditions hold, at x0 = ["))
      << found[0];
}

TEST(Checks, ConditionsThatNeverHoldAreTold) {
  const Energy e = parse_energy(
      "energy e edge\ndof x0 x1 m\nparam k N/m (0, inf)\nlet d2 = norm2(x1 - x0)\nactive d2 < 0\nvalue k*d2\n",
      "e.energy");
  EXPECT_EQ(faults(e), (Faults{"warning defined: not checked: no random state satisfies `active` and `require`",
                               "warning rigid motion: not checked: no random state satisfies `active` and `require`"}));
}

TEST(Checks, EveryCaseIsChecked) {
  const Energy e = parse_energy(
      "energy e edge\ndof x0 x1 m\nparam k N/m (0, inf)\ncase pair d2 = norm2(x1 - x0)\ncase origin d2 = norm2(x1 + "
      "x0)\n"
      "value k*d2\n",
      "e.energy");
  const Faults found = faults(e);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].starts_with("error rigid motion: case origin: the value changes")) << found[0];
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
