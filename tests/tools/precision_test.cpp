// Evaluation in floats, throughout and for Hessians alone, against doubles: over elements, stencils, widths, and far
// from the origin.

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "runtime/lanes/lanes.h"
#include "runtime/mesh/mesh_stencils.h"
#include "tests/tools/command.h"
#include "tools/installation.h"
#include "tools/problem.h"
#include "tools/sample.h"
#include "tools/stencils.h"

namespace ergon {
namespace {

struct Evaluated {
  double value = 0;
  Eigen::Matrix3Xd gradient, gradient_alone;
  BlockMatrix hessian;
  long indefinite = 0;
};

Evaluated evaluate(System& system, const Eigen::Matrix3Xd& x, Projection projection) {
  Evaluated out;
  out.value = system.value(x).value;
  system.gradient(x, out.gradient_alone);
  out.indefinite = system.hessian(x, projection, out.gradient, out.hessian).indefinite;
  return out;
}

double difference(const BlockMatrix& a, const BlockMatrix& b) {
  using Vector = Eigen::Map<const Eigen::VectorXd>;
  EXPECT_EQ(a.values().size(), b.values().size());
  const auto size = static_cast<Eigen::Index>(a.values().size());
  const Vector p(a.values().data(), size), q(b.values().data(), size);
  return (p - q).norm() / q.norm();
}

// Units of 2^-24 of the norm. A result is a sum over elements of products of a few dozen roundings each.
constexpr double kBound = 64 * 0x1p-24;

// Relative differences of floats from doubles are within kBound; mixed values and gradients are those of doubles.
void compare(const Energy& energy, const Mesh& mesh, const std::vector<int>& stencils, const Eigen::Matrix3Xd& x,
             const Values& values, int lanes, double bound = kBound) {
  const auto system = [&](Precision precision) {
    return make_system(energy, load_kernel(energy, "", lanes, precision), mesh, stencils, values);
  };
  System doubles = system(Precision::double_), floats = system(Precision::single), mixed = system(Precision::mixed);
  for (const Projection projection : {Projection::none, Projection::clamp, Projection::absolute}) {
    const Evaluated d = evaluate(doubles, x, projection), f = evaluate(floats, x, projection),
                    m = evaluate(mixed, x, projection);
    EXPECT_NEAR(f.value / d.value, 1, bound);
    EXPECT_LE((f.gradient - d.gradient).norm(), bound * d.gradient.norm());
    EXPECT_LE((f.gradient - f.gradient_alone).norm(), bound * d.gradient.norm());
    EXPECT_LE(difference(f.hessian, d.hessian), bound);
    EXPECT_EQ(m.value, d.value);
    EXPECT_EQ(m.gradient, d.gradient_alone);
    EXPECT_EQ(m.gradient_alone, d.gradient_alone);
    EXPECT_EQ(difference(m.hessian, f.hessian), 0) << "one kernel gives both";
    EXPECT_EQ(m.indefinite, f.indefinite);
    if (projection == Projection::none) {
      EXPECT_EQ(f.indefinite, 0);
    }
  }
}

Values sampled(const Energy& energy) {
  Values values;
  for (const Symbol* symbol : needed_inputs(energy))
    values[symbol->name] = sample_values(energy, symbol->role, 0).at(symbol->name);
  return values;
}

class InFloats : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (GetParam() > lanes::best_lanes()) GTEST_SKIP() << "this machine lacks such vectors";
  }
};

TEST_P(InFloats, DensitiesOnEveryElement) {
  struct Case {
    const char* energy;
    std::vector<Element> elements;
  };
  const std::vector<Case> cases = {
      {"stable_neo_hookean", {Element::tet4, Element::tet10, Element::hex8, Element::hex27, Element::prism6}},
      {"fibre_reinforced", {Element::tet4, Element::tet10}},
      {"st_venant_kirchhoff", {Element::tet4}}};
  for (const Case& c : cases) {
    const Energy energy = find_energy(c.energy);
    for (const Element element : c.elements) {
      SCOPED_TRACE(std::string(c.energy) + " on " + std::string(name_of(element)));
      const Mesh mesh = sample_mesh(element, 2);
      compare(energy, mesh, {}, displaced(mesh.X, 0.5, 0.06), sampled(energy), GetParam());
    }
  }
}

TEST_P(InFloats, MembranesAndLines) {
  const char* const membrane = "density sheet membrane\nparam k Pa*m (0, inf) stiffness\nvalue k*norm2(F)^2\n";
  const char* const line = "density wire line\nparam k N (0, inf) stiffness\nvalue k*norm2(F)^2\n";
  for (const auto& [text, element] : {std::pair(membrane, Element::tri3), std::pair(membrane, Element::tri6),
                                      std::pair(line, Element::edge2), std::pair(line, Element::edge3)}) {
    const Energy energy = parse_energy(text, "made_up.energy");
    SCOPED_TRACE(energy.name + " on " + std::string(name_of(element)));
    const Mesh mesh = sample_mesh(element, 3);
    compare(energy, mesh, {}, displaced(mesh.X, 0.3, 0.03), sampled(energy), GetParam());
  }
}

TEST_P(InFloats, Stencils) {
  for (const char* name : {"spring", "discrete_shell_hinge"}) {
    const Energy energy = find_energy(name);
    const StencilSample sample = sample_stencils(energy.geometry, 3);
    SCOPED_TRACE(name);
    compare(energy, sample.mesh, sample.stencils, displaced(sample.mesh.X, 0.3, 0.04), sampled(energy), GetParam(),
            16 * kBound);
  }
}

// Points are subtracted in doubles, so that floats have the digits of the differences.
TEST_P(InFloats, FarFromTheOrigin) {
  const Energy solid = find_energy("stable_neo_hookean"), spring = find_energy("spring");
  Mesh mesh = sample_mesh(Element::tet4, 2);
  const Eigen::Matrix3Xd moved = displaced(mesh.X, 0.5, 0.06);
  const Eigen::Vector3d offset(1e4, -2e4, 5e3);
  const Eigen::Matrix3Xd x = moved.colwise() + offset;
  mesh.X.colwise() += offset;
  compare(solid, mesh, {}, x, sampled(solid), GetParam());
  compare(spring, mesh, stencils_on_mesh("edge", mesh), x, sampled(spring), GetParam(), 16 * kBound);
}

INSTANTIATE_TEST_SUITE_P(Lanes, InFloats, testing::ValuesIn(lanes::kWidths));

// What is set later reaches the kernel that gives the Hessian too.
TEST(MixedPrecision, ParamsAndStencilsAreThoseOfBothKernels) {
  const Energy energy = find_energy("spring");
  const Mesh mesh = sample_mesh(Element::tet4, 2);
  const std::vector<int> all = stencils_on_mesh("edge", mesh);
  const std::vector<int> some(all.begin(), all.begin() + 20);
  Values values = sampled(energy);
  const auto system = [&](Precision precision, const std::vector<int>& stencils) {
    return make_system(energy, load_kernel(energy, "", lanes::best_lanes(), precision), mesh, stencils, values);
  };
  System changed = system(Precision::mixed, all);
  changed.potential(0).set_stencils(some, mesh.X, {});
  values["k"][0] *= 3;
  changed.potential(0).set_param("k", values["k"]);
  System fresh = system(Precision::mixed, some);
  const Eigen::Matrix3Xd x = displaced(mesh.X, 0.5, 0.06);
  EXPECT_EQ(changed.potential_count(), 1);
  EXPECT_EQ(changed.value(x).by_potential.size(), 1u);
  Eigen::Matrix3Xd a, b;
  BlockMatrix p, q;
  changed.hessian(x, Projection::clamp, a, p);
  fresh.hessian(x, Projection::clamp, b, q);
  EXPECT_EQ(a, b);
  // The changed system's pattern may keep couplings of stencils that are gone.
  double norm_p = 0, norm_q = 0;
  for (const double v : p.values()) norm_p += v * v;
  for (const double v : q.values()) norm_q += v * v;
  EXPECT_NEAR(norm_p / norm_q, 1, 1e-12);
}

TEST(MixedPrecision, IsForEnergiesThatGainByIt) {
  const Energy solid = find_energy("stable_neo_hookean"), linear = find_energy("linear_elasticity"),
               inertia = find_energy("inertia");
  const std::vector<Kernel> mixed = load_kernels({{&solid, ""}, {&linear, ""}, {&inertia, ""}}, 1, Precision::mixed);
  EXPECT_NE(mixed[0].curvature, nullptr);
  for (size_t i : {1, 2}) EXPECT_EQ(mixed[i].curvature, nullptr) << i;
  const std::vector<Kernel> floats = load_kernels({{&solid, ""}, {&linear, ""}, {&inertia, ""}}, 1, Precision::single);
  EXPECT_NE(floats[0]->single, nullptr);
  for (size_t i : {1, 2}) EXPECT_EQ(floats[i]->single, nullptr) << i;
}

class PrecisionCommand : public CommandTest {};

TEST_F(PrecisionCommand, IsAnOptionOfWhatEvaluates) {
  write("tet.msh",
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
        "$EndNodes\n$Elements\n1 1 1 1\n3 1 4 1\n1 1 2 3 4\n$EndElements\n");
  write("x.txt", "0 0 0\n1.1 0 0\n0 1 0.2\n0 0 0.9\n");
  std::vector<std::string> rows;
  for (const std::string precision : {"double", "float", "mixed"}) {
    const Answer answer = ergon(
        "eval stable_neo_hookean --mesh tet.msh --positions x.txt --set E=1e5 --set nu=0.3 "
        "--json --precision " +
        precision);
    ASSERT_EQ(answer.code, 0) << answer.err;
    rows.push_back(answer.out);
  }
  EXPECT_NE(rows[0], rows[1]);
  EXPECT_NE(rows[0], rows[2]);
  EXPECT_EQ(rows[0].substr(0, rows[0].find("hessian")), rows[2].substr(0, rows[2].find("hessian")));
  EXPECT_EQ(ergon("eval spring --mesh tet.msh --precision half").err,
            "ergon: error: --precision: 'half' is none of double, float, mixed\n");
  const Answer compiled = ergon("compile spring --precision float");
  EXPECT_THAT(compiled.out, testing::MatchesRegex("spring: [0-9]+ lanes of floats; operations: .*\n"));
}

TEST_F(PrecisionCommand, NumbersThatNoFloatComesNearAreNamed) {
  write("far.energy",
        "density far solid\nparam a Pa (0, inf) stress\nvalue a*norm2(F - identity(3)) + a*1e-60*det(F)^2\n");
  EXPECT_EQ(ergon("compile far.energy").code, 0);
  const Answer answer = ergon("compile far.energy --precision float");
  EXPECT_EQ(answer.code, 2);
  EXPECT_THAT(answer.err, testing::HasSubstr("far cannot be evaluated in single precision: no float comes near its "
                                             "number "));
}

}  // namespace
}  // namespace ergon
