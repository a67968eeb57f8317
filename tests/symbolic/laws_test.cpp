// Laws of the catalogue against closed forms.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <functional>

#include "symbolic/reference.h"
#include "tests/symbolic/energy_files.h"

namespace ergon {
namespace {

ReferenceValue at(const std::string& law, const Inputs& inputs) {
  return evaluate_reference(test::shipped(law), "", inputs, 50);
}

// Nominal stress of a bar that is pulled to `stretch` at constant volume and free at its sides, Pa.
double uniaxial_stress(const std::string& law, Inputs params, double stretch) {
  const double across = 1 / std::sqrt(stretch);
  params["F"] = {stretch, 0, 0, 0, across, 0, 0, 0, across};
  const std::vector<double> P = at(law, params).gradient;
  return P[0] - P[4] * across / stretch;
}

// The textbook form: 2*(l - 1/l^2)*(dW/dI1 + dW/dI2/l).
void expect_uniaxial(const std::string& law, const Inputs& params,
                     const std::function<double(double stretch, double I1)>& slope) {
  for (const double l : {0.5, 0.9, 1.1, 1.5, 2.0}) {
    const double expected = 2 * (l - 1 / (l * l)) * slope(l, l * l + 2 / l);
    EXPECT_NEAR(uniaxial_stress(law, params, l), expected, 1e-13 * std::abs(expected)) << law << " at " << l;
  }
}

TEST(Laws, RubberInUniaxialTension) {
  expect_uniaxial("mooney_rivlin", {{"C10", {3}}, {"C01", {2}}, {"K", {70}}},
                  [](double l, double) { return 3 + 2 / l; });
  expect_uniaxial("yeoh", {{"C1", {3}}, {"C2", {-0.25}}, {"C3", {0.5}}, {"K", {70}}},
                  [](double, double I1) { return 3 - 0.5 * (I1 - 3) + 1.5 * (I1 - 3) * (I1 - 3); });
  expect_uniaxial("gent", {{"mu", {3}}, {"Jm", {8}}, {"K", {70}}},
                  [](double, double I1) { return 1.5 * 8 / (8 - (I1 - 3)); });
  expect_uniaxial("fung", {{"mu", {3}}, {"b", {0.5}}, {"K", {70}}},
                  [](double, double I1) { return 1.5 * std::exp(0.5 * (I1 - 3)); });
  expect_uniaxial("isochoric_neo_hookean", {{"mu", {3}}, {"K", {70}}}, [](double, double) { return 1.5; });
  expect_uniaxial("arruda_boyce", {{"mu", {3}}, {"N", {8}}, {"K", {70}}}, [](double, double I1) {
    const double x = I1 / 8;
    return 3 * (0.5 + x / 10 + 33 * x * x / 1050 + 76 * x * x * x / 7000 + 2595 * x * x * x * x / 673750);
  });
}

// A long chain is a neo-Hookean solid; a chain of Gent's without limit too.
TEST(Laws, LimitsOfRubber) {
  const double free = uniaxial_stress("isochoric_neo_hookean", {{"mu", {3}}, {"K", {70}}}, 1.5);
  EXPECT_NEAR(uniaxial_stress("arruda_boyce", {{"mu", {3}}, {"N", {1e9}}, {"K", {70}}}, 1.5), free, 1e-8);
  EXPECT_NEAR(uniaxial_stress("gent", {{"mu", {3}}, {"Jm", {1e9}}, {"K", {70}}}, 1.5), free, 1e-8);
}

// Ogden's stress of an incompressible bar: the sum of mu_p*(l^(a_p - 1) - l^(-a_p/2 - 1)).
TEST(Laws, OgdenInUniaxialTension) {
  const Inputs params = {{"mu1", {0.63}}, {"mu2", {0.0012}}, {"mu3", {0.01}}, {"a1", {1.3}},
                         {"a2", {5}},     {"a3", {-2}},      {"K", {70}}};  // his rubber, in MPa
  for (const double l : {0.5, 0.9, 1.1, 2.0, 6.0}) {
    const auto term = [&](double a) { return std::pow(l, a - 1) - std::pow(l, -a / 2 - 1); };
    const double expected = 0.63 * term(1.3) + 0.0012 * term(5) - 0.01 * term(-2);
    EXPECT_NEAR(uniaxial_stress("ogden", params, l), expected, 1e-13 * std::abs(expected)) << l;
  }
}

// With the power 2 alone, and next to nothing against volume, Ogden's rubber is neo-Hookean, as a solid and as a sheet.
TEST(Laws, OgdenWithOneSquareIsNeoHookean) {
  Inputs in = {{"mu", {3}}, {"mu1", {3}}, {"mu2", {0}},   {"mu3", {0}}, {"a1", {2}},
               {"a2", {4}}, {"a3", {-2}}, {"K", {1e-30}}, {"h", {0.5}}};
  const auto same = [&](const std::string& a, const std::string& b) {
    const ReferenceValue x = at(a, in), y = at(b, in);
    EXPECT_NEAR(x.value, y.value, 1e-13 * y.value);
    for (size_t i = 0; i < y.hessian.size(); ++i) EXPECT_NEAR(x.hessian[i], y.hessian[i], 1e-11);
  };
  in["F"] = {1.2, 0.1, -0.3, 0.2, 0.9, 0.4, 0.1, -0.2, 1.1};
  same("ogden", "isochoric_neo_hookean");
  in["F"] = {1.2, 0.1, -0.3, 0.2, 0.9, 0.4};
  same("ogden_membrane", "incompressible_membrane");
}

// Stress along the first axis of F = diag(a, b, b), turned in space: the laws in principal stretches by hand.
TEST(Laws, PrincipalStretchesInTension) {
  const double a = 1.5, b = 0.8, E = 2, nu = 0.25, mu = E / (2 * (1 + nu)), la = E * nu / ((1 + nu) * (1 - 2 * nu));
  const Inputs in = {{"F", {0, a, 0, -b, 0, 0, 0, 0, b}}, {"E", {E}}, {"nu", {nu}}, {"mu", {mu}}};
  const auto stress = [&](const std::string& law) { return at(law, in).gradient[1]; };
  EXPECT_NEAR(stress("hencky"), (2 * mu * std::log(a) + la * std::log(a * b * b)) / a, 1e-14);
  EXPECT_NEAR(stress("arap"), 2 * mu * (a - 1), 1e-14);
  EXPECT_NEAR(stress("corotated_linear"), 2 * mu * (a - 1) + la * (a + 2 * b - 3), 1e-14);
  EXPECT_NEAR(stress("fixed_corotated"), 2 * mu * (a - 1) + la * (a * b * b - 1) * b * b, 1e-14);
}

// A bar of foam that is free at its sides: b = a^(-1/4), Poisson's ratio 1/4 in logarithms.
TEST(Laws, BlatzAndKoContractByAQuarter) {
  const double a = 1.5, b = std::pow(a, -0.25);
  const ReferenceValue v = at("blatz_ko", {{"F", {a, 0, 0, 0, b, 0, 0, 0, b}}, {"mu", {3}}});
  EXPECT_NEAR(v.gradient[0], 3 * (std::pow(a, -0.5) - std::pow(a, -3.0)), 1e-14);
  EXPECT_NEAR(v.gradient[4], 0, 1e-14);
}

TEST(Laws, AMuscleInItsFullTensionPullsAlongItsFibres) {
  const ReferenceValue v =
      at("muscle", {{"F", {1, 0, 0, 0, 1, 0, 0, 0, 1}}, {"tension", {8}}, {"activation", {0.25}}, {"a", {0, 3, 0}}});
  for (size_t i = 0; i < 9; ++i) EXPECT_NEAR(v.gradient[i], i == 4 ? 2 : 0, 1e-15);
}

// The four triangles of a tetrahedron of volume 1/6, wherever it is.
TEST(Laws, PressureOnAClosedSurfaceIsThatTimesItsVolume) {
  const std::vector<std::vector<double>> x = {{5, 6, 7}, {6, 6, 7}, {5, 7, 7}, {5, 6, 8}};
  double value = 0;
  std::vector<double> force(3, 0.0);
  for (const auto& [i, j, k] : {std::array{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) {
    const auto point = [&](int p) { return x[static_cast<size_t>(p)]; };
    const ReferenceValue v = at("pressure", {{"x0", point(i)}, {"x1", point(j)}, {"x2", point(k)}, {"p", {3}}});
    value += v.value;
    for (size_t c = 0; c < 9; ++c) force[c % 3] += v.gradient[c];
  }
  EXPECT_NEAR(value, -3.0 / 6, 1e-13);
  for (const double f : force) EXPECT_NEAR(f, 0, 1e-13);
}

TEST(Laws, StrainIsLimited) {
  Inputs in = {{"F", {1.2, 0, 0, 0, 1.05, 0}}, {"k", {2}}, {"threshold", {1.1}}, {"limit", {1.3}}};
  const ReferenceValue v = at("strain_limit", in);
  EXPECT_NEAR(v.value, 2 * 0.25 * std::log(2.0), 1e-14);
  EXPECT_NEAR(v.gradient[4], 0, 1e-15);
  in["F"] = {1.09, 0, 0, 0, 1.05, 0};
  EXPECT_EQ(at("strain_limit", in).value, 0);
}

// Free at its sides a strip has its Young's modulus, and contracts by Poisson's ratio.
TEST(Laws, MembranesInUniaxialTension) {
  const double e = 1e-3, nu = 0.25, a = std::sqrt(1 + 2 * e), b = std::sqrt(1 - 2 * nu * e);
  const std::vector<double> F = {a, 0, 0, 0, b, 0};
  const ReferenceValue plain = at("st_venant_kirchhoff_membrane", {{"F", F}, {"E", {8}}, {"nu", {nu}}, {"h", {0.5}}});
  const ReferenceValue woven =
      at("orthotropic_membrane", {{"F", F}, {"E1", {4}}, {"E2", {2}}, {"nu", {nu}}, {"G", {3}}});
  for (const ReferenceValue& v : {plain, woven}) {
    EXPECT_NEAR(v.value, 8 * 0.5 * e * e / 2, 1e-15);
    EXPECT_NEAR(v.gradient[0], 4 * e * a, 1e-15);
    EXPECT_NEAR(v.gradient[4], 0, 1e-15);
  }
}

// The membrane is the solid with the stretch of the thickness at which nothing acts across it.
TEST(Laws, ANeoHookeanMembraneIsTheSolidWithoutStressAcross) {
  const double E = 8, nu = 0.3, h = 0.5, mu = E / (2 * (1 + nu)), la = E * nu / ((1 + nu) * (1 - 2 * nu)) + mu;
  const std::vector<double> states[] = {
      {1.3, 0.2, -0.1, 0.4, 0.9, 0.3}, {0.6, 0, 0.7, -0.5, 0.4, 0.2}, {2.5, 0.1, 0, 0.3, 3, -1}};
  for (const std::vector<double>& F : states) {
    const double n[] = {F[1] * F[5] - F[2] * F[4], F[2] * F[3] - F[0] * F[5], F[0] * F[4] - F[1] * F[3]};
    const double J = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), s = J * (mu + la) / (mu + la * J * J);
    std::vector<double> whole = F;
    for (const double c : n) whole.push_back(s * c / J);
    const ReferenceValue thin = at("neo_hookean_membrane", {{"F", F}, {"E", {E}}, {"nu", {nu}}, {"h", {h}}});
    const ReferenceValue thick = at("stable_neo_hookean", {{"F", whole}, {"E", {E}}, {"nu", {nu}}});
    EXPECT_NEAR(thin.value, h * thick.value, 1e-14 * thin.value);
    for (size_t i = 0; i < 6; ++i) EXPECT_NEAR(thin.gradient[i], h * thick.gradient[i], 1e-14 * E);
    for (size_t i = 6; i < 9; ++i) EXPECT_NEAR(thick.gradient[i], 0, 1e-14 * E);
  }
}

TEST(Laws, AClothOfBaraffAndWitkinResistsStretchAndShear) {
  const ReferenceValue v = at("baraff_witkin", {{"F", {2, 0, 0, 1.5, 2, 0}}, {"ku", {3}}, {"kv", {5}}, {"ks", {7}}});
  EXPECT_NEAR(v.value, 3.0 / 2 + 5.0 / 2 * 2.25 + 7.0 / 2 * 9, 1e-13);
}

// A rod bent to a circle stores EI/2 curvature^2 per length; its ends here are 2*tan(angle/2)/length apart from it.
TEST(Laws, ARodBentToACircle) {
  const double angle = 1e-3, length = 0.01, EI = 3;
  const Inputs bent = {
      {"x0", {-length, 0, 0}}, {"x1", {0, 0, 0}}, {"x2", {length * std::cos(angle), length * std::sin(angle), 0}},
      {"L0", {length}},        {"L1", {length}},  {"EI", {EI}}};
  const double curvature = 2 * std::tan(angle / 2) / length;
  EXPECT_NEAR(at("rod_bending", bent).value, EI / 2 * curvature * curvature * length, 1e-15);
}

// A plate of stiffness D = E h^3/(12 (1 - nu^2)) rolled to a cylinder stores D/2 curvature^2 per area, whichever way
// the triangles lie; how long the normals are, and how they lean along their edges, changes no turn.
TEST(Laws, AShellOfKoiterRolledToACylinder) {
  const double side = 1e-3, radius = 0.5, E = 3, nu = 0.3, h = 0.01;
  const double D = E * h * h * h / (12 * (1 - nu * nu));
  for (const double turn : {0.0, 0.4, 1.0}) {
    Inputs in = {{"E", {E}}, {"nu", {nu}}, {"h", {h}}};
    const double points[][2] = {{0, 0}, {side, 0}, {0.3 * side, 0.7 * side}};
    std::array<Eigen::Vector3d, 3> flat, rolled;
    for (size_t i = 0; i < 3; ++i) {
      const double u = std::cos(turn) * points[i][0] - std::sin(turn) * points[i][1];
      const double v = std::sin(turn) * points[i][0] + std::cos(turn) * points[i][1];
      flat[i] = {u, v, 0};
      rolled[i] = {radius * std::sin(u / radius), v, radius * std::cos(u / radius)};
    }
    const auto set = [&](const std::string& name, const Eigen::Vector3d& at) { in[name] = {at[0], at[1], at[2]}; };
    for (size_t i = 0; i < 3; ++i) {
      const size_t a = (i + 1) % 3, b = (i + 2) % 3;
      set("X" + std::to_string(i), flat[i]);
      set("x" + std::to_string(i), rolled[i]);
      const double u = (flat[a].x() + flat[b].x()) / 2, length = (flat[b] - flat[a]).norm();
      set("P" + std::to_string(i), (flat[a] + flat[b]) / 2 + length * Eigen::Vector3d::UnitZ());
      // Across the edge and as near as that lets it to the cylinder's normal.
      const Eigen::Vector3d along = (rolled[b] - rolled[a]).normalized(),
                            out(std::sin(u / radius), 0, std::cos(u / radius));
      set("p" + std::to_string(i), (rolled[a] + rolled[b]) / 2 + length * (out - along.dot(out) * along).normalized());
    }
    const double area = side * 0.7 * side / 2, expected = D / 2 * area / (radius * radius);
    EXPECT_NEAR(at("koiter_bending", in).value, expected, 1e-4 * expected) << turn;
    for (size_t i = 0; i < 3; ++i) in["p0"][i] += 0.1 * (in["x2"][i] - in["x1"][i]);
    EXPECT_NEAR(at("koiter_bending", in).value, expected + D / 2 * (0.01 + 0.25 * 1e-4), 1e-2 * D / 2 * 0.01) << turn;
  }
}

// At small angles the hinges are one.
TEST(Laws, HingesAgreeAtSmallAngles) {
  Inputs flat = {{"X0", {0, 0, 0}}, {"X1", {1, 0, 0}}, {"X2", {0.25, 1, 0}}, {"X3", {0.5, -0.75, 0}}, {"k", {2}}};
  for (const char* point : {"0", "1", "2", "3"}) flat[std::string("x") + point] = flat[std::string("X") + point];
  flat["x3"][2] = 1e-4;
  const double by_angle = at("discrete_shell_hinge", flat).value;
  EXPECT_GT(by_angle, 1e-9);
  EXPECT_NEAR(at("tan_hinge", flat).value, by_angle, 1e-8 * by_angle);
  EXPECT_NEAR(at("quadratic_bending", flat).value, by_angle, 1e-7 * by_angle);
}

// Friction grows to the static coefficient at epsv and falls to the kinetic one at epsv + fall.
TEST(Laws, FrictionIsStaticThenKinetic) {
  Inputs in = {{"epsv", {0.5}},       {"fall", {0.25}}, {"n", {0, 0, 1}},         {"mu_static", {0.75}},
               {"mu_kinetic", {0.5}}, {"dt", {0.125}},  {"xlag", {0.5, 0.25, 0}}, {"force", {8}}};
  const auto force_at = [&](double speed) {
    in["x"] = {0.5 + 0.125 * speed, 0.25, 0.7};
    return at("friction", in).gradient[0];
  };
  EXPECT_NEAR(force_at(0.25), 8 * 0.75 * 0.75, 1e-14);  // 2 y - y^2 of IPC at half of epsv
  EXPECT_NEAR(force_at(0.5), 8 * 0.75, 1e-14);
  EXPECT_NEAR(force_at(0.625), 8 * 0.625, 1e-14);
  EXPECT_NEAR(force_at(0.75), 8 * 0.5, 1e-14);
  EXPECT_NEAR(force_at(20), 8 * 0.5, 1e-14);
  EXPECT_EQ(force_at(0), 0);
}

// Only below its length less dhat is a rope slack.
TEST(Laws, ARopeActsOnlyWhereItIsNearlyTaut) {
  const Inputs taut = {{"x0", {0, 0, 0}}, {"x1", {0, 0, 0.9}}, {"length", {1}}, {"dhat", {0.25}}, {"kappa", {2}}};
  const ReferenceValue v = at("log_barrier:rope", taut);
  EXPECT_NEAR(v.value, -2 * 0.15 * 0.15 * std::log(0.1 / 0.25), 1e-15);
  EXPECT_GT(v.gradient[5], 0);
  EXPECT_GT(v.active[0], 0);
}

}  // namespace
}  // namespace ergon
