// Every law of the catalogue has a closed form that a test compares it with: here, or where `elsewhere` says.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "symbolic/reference.h"
#include "tests/symbolic/energy_files.h"

namespace ergon {
namespace {

constexpr double a = 1.5, b = 0.8, c = 0.9, J = a * b * c, I1 = a * a + b * b + c * c;
constexpr double E = 2, nu = 0.25, mu = E / (2 * (1 + nu)), la = E * nu / ((1 + nu) * (1 - 2 * nu));
constexpr double ea = (a * a - 1) / 2, eb = (b * b - 1) / 2, e = ea + eb + (c * c - 1) / 2;  // Green's strain

using Values = std::vector<double>;

Values stretched(double x, double y, double z) { return {x, 0, 0, 0, y, 0, 0, 0, z}; }

struct Form {
  std::string law;
  Inputs inputs;
  size_t component;   // of the gradient: the first of F is 0, x1 of an edge along y is 4
  double derivative;  // by hand
};

// Isotropic solids of E and nu, or with params of their own, at F = diag(a, b, c).
std::vector<Form> solids() {
  const Values F = stretched(a, b, c), I = stretched(1, 1, 1), none(9, 0.0);
  const Inputs moduli = {{"F", F}, {"E", {E}}, {"nu", {nu}}};
  const double stable = mu * a - mu * b * c + (la + mu) * (J - 1) * b * c;
  const double mu3 = 4 * mu / 3, la3 = la + 5 * mu3 / 8, volume = std::log(J);
  const double da = std::log(a) - volume / 3, db = std::log(b) - volume / 3, dc = std::log(c) - volume / 3;
  const double shape = 2 * 3 * da * std::exp(0.5 * (da * da + db * db + dc * dc));
  const double fibre = 2 * a * 3 * (a * a - 1) * std::exp(0.5 * (a * a - 1) * (a * a - 1));
  const double g = 1.25;
  const Inputs fibres = {{"F", F}, {"mu", {mu}}, {"la", {la}}, {"k1", {3}}, {"k2", {0.5}}, {"a", {2, 0, 0}}};
  Inputs two = fibres;
  two["b"] = {0, 3, 0};
  return {
      {"neo_hookean", moduli, 0, mu * (a - 1 / a) + la * volume / a},
      {"st_venant_kirchhoff", moduli, 0, a * (2 * mu * ea + la * e)},
      {"linear_elasticity", moduli, 0, 2 * mu * (a - 1) + la * (a + b + c - 3)},
      {"stable_neo_hookean", moduli, 0, stable},
      {"stable_neo_hookean_log", moduli, 0, mu3 * a + la3 * (J - 1) * b * c - 0.75 * mu3 * b * c - mu3 * a / (1 + I1)},
      {"symmetric_dirichlet", {{"F", F}, {"k", {3}}}, 0, 3 * (a - std::pow(a, -3))},
      {"volume_penalty", {{"F", F}, {"K", {3}}}, 0, 3 * (J - 1) * b * c},
      {"affine_orthogonality", {{"F", F}, {"stiffness", {3}}}, 0, 12 * a * (a * a - 1)},
      {"exponentiated_hencky",
       {{"F", F}, {"mu", {3}}, {"K", {5}}, {"k", {0.5}}, {"kv", {0.25}}},
       0,
       (shape + 5 * volume * std::exp(0.25 * volume * volume)) / a},
      {"fibre_reinforced", fibres, 0, stable + fibre},
      {"two_fibre_families", two, 0, stable + fibre},
      {"thermal_neo_hookean",
       {{"F", stretched(g * a, g * b, g * c)}, {"E", {E}}, {"nu", {nu}}, {"alpha", {1e-3}}, {"dT", {250}}},
       0,
       g * g * (mu * (a - 1 / a) + la * volume / a)},
      {"kelvin_voigt",
       {{"F", F}, {"Flag", I}, {"eta", {3}}, {"zeta", {5}}, {"dt", {0.5}}},
       0,
       a * (6 * ea + 5 * e) / 0.5},
      {"maxwell_branch",
       {{"F", F}, {"flow", none}, {"mu", {3}}, {"tau", {1.5}}, {"dt", {0.5}}},
       0,
       2 * 3 * 0.75 * ea * a},
  };
}

std::vector<Form> membranes_and_lines() {
  const Values F = {a, 0, 0, 0, b, 0};
  const double sheet = E * 0.5 / (1 - nu * nu) * a * (ea + nu * eb), g = 1.25;
  return {
      {"st_venant_kirchhoff_membrane", {{"F", F}, {"E", {E}}, {"nu", {nu}}, {"h", {0.5}}}, 0, sheet},
      {"growing_membrane",
       {{"F", {g * a, 0, 0, 0, g * b, 0}}, {"E", {E}}, {"nu", {nu}}, {"h", {0.5}}, {"growth", {g}}},
       0,
       g * sheet},
      {"symmetric_dirichlet_membrane", {{"F", F}, {"k", {3}}}, 0, 3 * (a - std::pow(a, -3))},
      {"incompressible_membrane",
       {{"F", F}, {"mu", {3}}, {"h", {0.5}}},
       0,
       1.5 * (a - std::pow(a, -3) * std::pow(b, -2))},
      {"green_rod", {{"F", {0, a, 0}}, {"EA", {3}}}, 1, 1.5 * a * (a * a - 1)},
      {"rod_stretching", {{"F", {0, a, 0}}, {"EA", {3}}}, 1, 3 * (a - 1)},
  };
}

// The edge from the origin to (0, 3, 4); points at (1, 2, 3).
std::vector<Form> points() {
  const Values O = {0, 0, 0}, end = {0, 3, 4}, x = {1, 2, 3}, start = {0, 1.5, 2};
  return {
      {"spring", {{"x0", O}, {"x1", end}, {"X0", O}, {"X1", {4, 0, 0}}, {"k", {2}}}, 4, 2 * 1 * 0.6},
      {"distance_limit",
       {{"x0", O}, {"x1", end}, {"X0", O}, {"X1", {4, 0, 0}}, {"k", {2}}, {"threshold", {1}}, {"limit", {1.5}}},
       4,
       2 * (std::log(2) + 0.5) / 0.5 * 0.6},
      {"damper",
       {{"x0", O}, {"x1", end}, {"x0lag", O}, {"x1lag", start}, {"c", {2}}, {"dt", {0.5}}},
       4,
       2 * 2.5 / 0.5 * 0.6},
      {"drag", {{"x", x}, {"xlag", O}, {"mass", {3}}, {"rate", {2}}, {"dt", {0.5}}}, 1, 2 * 3 * 2 / 0.5},
      {"inertia", {{"x", x}, {"xhat", {1, 1, 1}}, {"mass", {3}}, {"dt", {0.5}}}, 2, 3 * 2 / 0.25},
      {"gravity", {{"x", x}, {"mass", {3}}, {"g", {0, 0, -10}}}, 2, 30},
      {"dead_load", {{"x", x}, {"share", {0.25}}, {"force", {0, 8, 0}}}, 1, -2},
      {"attachment", {{"x", x}, {"target", {1, 1, 1}}, {"k", {2}}}, 2, 4},
      {"joined_points", {{"p", x}, {"q", end}, {"k", {2}}}, 1, -2},
      {"friction_secant", {{"x", x}, {"xlag", O}, {"t", {0, 0.6, 0.8}}, {"stiffness", {2}}}, 1, 2 * 3.6 * 0.6},
      {"cubic_barrier:point_point", {{"p", O}, {"q", end}, {"dhat", {6}}, {"kappa", {3}}}, 4, -3.0 * 2 / 6 * 0.6},
      {"log_barrier:point_point",
       {{"p", O}, {"q", end}, {"dhat", {6}}, {"kappa", {3}}},
       4,
       -3 * (-2 * std::log(5.0 / 6) + 1.0 / 5) * 0.6},
      {"squared_log_barrier:point_point",
       {{"p", O}, {"q", end}, {"dhat", {6}}, {"kappa", {3}}},
       4,
       -3 * (-22 * std::log(25.0 / 36) + 121.0 / 25) * 10 * 0.6},
  };
}

std::vector<Form> triangles_and_tetrahedra() {
  const Values O = {0, 0, 0}, x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1}, xx = {a, 0, 0}, yy = {0, b, 0},
               zz = {0, 0, c};
  return {
      {"area_constraint",
       {{"x0", O}, {"x1", xx}, {"x2", yy}, {"X0", O}, {"X1", x}, {"X2", y}, {"k", {2}}},
       3,
       2 * (a * b - 1) / 2 * b / 2},
      {"volume_constraint",
       {{"x0", O}, {"x1", xx}, {"x2", yy}, {"x3", zz}, {"X0", O}, {"X1", x}, {"X2", y}, {"X3", z}, {"k", {2}}},
       3,
       2 * (J - 1) / 6 * b * c / 6},
      {"pinned_to_triangle",
       {{"p", {0.25, 0.5, 3}}, {"t0", O}, {"t1", x}, {"t2", y}, {"w1", {0.25}}, {"w2", {0.5}}, {"k", {2}}},
       11,
       -2 * 0.5 * 3},
      // The place turns with the triangle: raising t1 draws the point of height 1 towards -x.
      {"held_above_triangle",
       {{"p", {0.5, 0.5, 1}}, {"t0", O}, {"t1", x}, {"t2", y}, {"w1", {0.25}}, {"w2", {0.5}}, {"h", {1}}, {"k", {2}}},
       8,
       2 * 0.25},
      {"strain_rate",
       {{"x0", O},
        {"x1", xx},
        {"x2", yy},
        {"x3", zz},
        {"X0", O},
        {"X1", x},
        {"X2", y},
        {"X3", z},
        {"x0lag", O},
        {"x1lag", x},
        {"x2lag", y},
        {"x3lag", z},
        {"eta", {3}},
        {"zeta", {5}},
        {"dt", {0.5}}},
       3,
       a * (6 * ea + 5 * e) / 0.5 / 6},
  };
}

std::vector<Form> forms() {
  std::vector<Form> all;
  for (const auto& some : {solids(), membranes_and_lines(), points(), triangles_and_tetrahedra()})
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

TEST(ClosedForms, AreTheForcesOfTheLaws) {
  for (const Form& form : forms()) {
    const double found = evaluate_reference(test::shipped(form.law), "", form.inputs).gradient.at(form.component);
    EXPECT_NEAR(found, form.derivative, 1e-14 * (1 + std::abs(form.derivative))) << form.law;
  }
}

// A simple shear of 1 has I1 - 3 = 1, a knot.
TEST(ClosedForms, TheTableIsMetAtItsKnots) {
  const Inputs shear = {{"F", {1, 0, 0, 1, 1, 0, 0, 0, 1}}, {"mu", {3}}, {"K", {5}}};
  EXPECT_NEAR(evaluate_reference(test::shipped("data_driven"), "", shear).value, 3 * 0.493, 1e-15);
}

TEST(ClosedForms, AreKnownOfEveryLaw) {
  const std::map<std::string, std::string> elsewhere = {{"discrete_shell_hinge", "tests/symbolic/laws_test.cpp"},
                                                        {"tan_hinge", "tests/symbolic/laws_test.cpp"},
                                                        {"quadratic_bending", "tests/symbolic/laws_test.cpp"},
                                                        {"koiter_bending", "tests/symbolic/laws_test.cpp"},
                                                        {"friction", "tests/symbolic/laws_test.cpp"},
                                                        {"pressure", "tests/symbolic/laws_test.cpp"},
                                                        {"baraff_witkin", "tests/symbolic/laws_test.cpp"},
                                                        {"orthotropic_membrane", "tests/symbolic/laws_test.cpp"},
                                                        {"neo_hookean_membrane", "tests/symbolic/laws_test.cpp"},
                                                        {"ogden_membrane", "tests/symbolic/laws_test.cpp"},
                                                        {"strain_limit", "tests/symbolic/laws_test.cpp"},
                                                        {"rod_bending", "tests/symbolic/laws_test.cpp"},
                                                        {"arap", "tests/symbolic/laws_test.cpp"},
                                                        {"arruda_boyce", "tests/symbolic/laws_test.cpp"},
                                                        {"blatz_ko", "tests/symbolic/laws_test.cpp"},
                                                        {"corotated_linear", "tests/symbolic/laws_test.cpp"},
                                                        {"fixed_corotated", "tests/symbolic/laws_test.cpp"},
                                                        {"fung", "tests/symbolic/laws_test.cpp"},
                                                        {"gent", "tests/symbolic/laws_test.cpp"},
                                                        {"hencky", "tests/symbolic/laws_test.cpp"},
                                                        {"isochoric_neo_hookean", "tests/symbolic/laws_test.cpp"},
                                                        {"mooney_rivlin", "tests/symbolic/laws_test.cpp"},
                                                        {"muscle", "tests/symbolic/laws_test.cpp"},
                                                        {"ogden", "tests/symbolic/laws_test.cpp"},
                                                        {"yeoh", "tests/symbolic/laws_test.cpp"},
                                                        {"bilayer_bending", "tests/scenes/growth_test.cpp"},
                                                        {"curled_hinge", "tests/scenes/growth_test.cpp"},
                                                        {"plastic_hinge", "tests/scenes/inelastic_test.cpp"},
                                                        {"von_mises", "tests/scenes/inelastic_test.cpp"},
                                                        {"discrete_rod", "tests/codegen/rod_laws_test.cpp"},
                                                        {"curled_rod", "tests/codegen/rod_laws_test.cpp"},
                                                        {"round_rod", "tests/codegen/rod_laws_test.cpp"}};
  std::set<std::string> here = {"data_driven"};  // by the test above
  for (const Form& form : forms()) here.insert(form.law.substr(0, form.law.find(':')));
  for (const Energy& energy : test::catalogue()) {
    const std::string law = energy.name.substr(0, energy.name.find(':'));
    const auto found = elsewhere.find(law);
    EXPECT_NE(here.contains(law), found != elsewhere.end()) << law << ": give a closed form of it, in one place";
    if (found == elsewhere.end()) continue;
    const std::string text = test::contents(test::source("/" + found->second));
    const bool named = text.find('"' + law + '"') != std::string::npos ||
                       text.find('"' + law + "\\\"") != std::string::npos;  // within a string
    EXPECT_TRUE(named) << law;
  }
}

}  // namespace
}  // namespace ergon
