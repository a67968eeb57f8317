// The closed form of every isotropic density against an eigen-decomposition of the 50-digit Hessian.

#include "codegen/principal.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "runtime/aligned.h"
#include "runtime/lanes/projection_table.h"
#include "symbolic/isotropy.h"
#include "tests/codegen/evaluate_kernel.h"
#include "tests/codegen/states.h"
#include "tests/symbolic/energy_files.h"

namespace ergon::testing {
namespace {

struct IsotropicCase {
  std::string name;
  Energy energy;
};

void PrintTo(const IsotropicCase& c, std::ostream* out) { *out << c.name; }

Energy flat(const std::string& geometry, const std::string& unit, const std::string& value) {
  return parse_energy("density flat " + geometry + "\nparam k " + unit + " (0, inf) stiffness\nvalue " + value + "\n",
                      "flat.energy");
}

// The densities of the catalogue, and flat ones of different structure. Nothing is generated here: every process that
// runs one of the tests lists them all.
std::vector<IsotropicCase> densities() {
  std::vector<IsotropicCase> out;
  for (const Energy& energy : test::catalogue()) {
    if (energy.kind != Energy::Kind::density || !energy.cases.empty()) continue;
    out.push_back({energy.name, energy});
  }
  out.push_back({"membrane_st_venant", flat("membrane", "N/m", "k*norm2(F'*F - identity(2))")});
  out.push_back({"membrane_neo_hookean", flat("membrane", "N/m", "k*(tr(F'*F) - 3 + 1/det(F'*F))")});
  out.push_back({"membrane_area", flat("membrane", "N/m", "k*sqrt(det(F'*F))")});
  out.push_back({"line_green", flat("line", "N", "k*(norm2(F) - 1)^2")});
  out.push_back({"line_length", flat("line", "N", "k*(norm(F) - 1)^2")});
  return out;
}

class Principal : public ::testing::TestWithParam<IsotropicCase> {};

TEST_P(Principal, ClosedFormIsTheProjectedHessian) {
  const Energy& energy = GetParam().energy;
  if (generate(energy, {}).module.principal.empty()) {
    EXPECT_FALSE(is_isotropic(energy, ""));
    return;
  }
  const std::vector<State> states = draw_states(energy, "", 11);
  for (const int width : test_widths()) {
    const CompiledKernel compiled = test_kernel(energy, "", width);
    const ErgonKernel& k = *compiled.table;
    ASSERT_NE(k.principal, nullptr);
    const lanes::ProjectionTable& table = lanes::projection_table(width);
    const int n = k.q_vectors, m = 3 * n;
    const auto lanes_of = [&](int components) { return static_cast<size_t>(components * width); };
    for (const State& state : states) {
      const std::vector<double>& F = state.inputs.at("F");
      AlignedVector<double> f(lanes_of(m)), s(lanes_of(n)), u(static_cast<size_t>(k.uniforms)),
          params(static_cast<size_t>(k.params)), raw(lanes_of(k.raw)), e(lanes_of(k.elements)), blocks(lanes_of(12)),
          packed(lanes_of(m * (m + 1) / 2));
      for (int i = 0; i < m; ++i)
        for (int l = 0; l < width; ++l) f[static_cast<size_t>(i * width + l)] = F[static_cast<size_t>(i)];
      for (int i = 0; i < k.n_inputs; ++i)
        std::copy(state.inputs.at(k.inputs[i].name).begin(), state.inputs.at(k.inputs[i].name).end(),
                  params.begin() + k.inputs[i].offset);
      k.prepare_uniforms(params.data(), u.data());
      k.prepare_elements(raw.data(), u.data(), e.data());
      table.stretches[n](f.data(), s.data());
      k.principal(s.data(), e.data(), u.data(), blocks.data());

      const ReferenceValue exact = evaluate_reference(energy, "", state.inputs, 50);
      using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
      const Eigen::Map<const Eigen::MatrixXd> H(exact.hessian.data(), m, m);
      const Eigen::SelfAdjointEigenSolver<Matrix> eigen(H.cast<long double>());
      Inputs stretched = state.inputs;
      for (double& x : stretched.at("F")) x *= 1 + 1e-7;
      const ReferenceValue beside = evaluate_reference(energy, "", stretched, 50);
      double change = 0;  // per relative change of F
      for (size_t i = 0; i < exact.hessian.size(); ++i)
        change = std::max(change, std::abs(beside.hessian[i] - exact.hessian[i]) / 1e-7);
      for (const bool absolute : {false, true}) {
        table.isotropic[n](f.data(), blocks.data(), absolute, packed.data());
        const auto kept = absolute ? eigen.eigenvalues().cwiseAbs().eval() : eigen.eigenvalues().cwiseMax(0).eval();
        const Matrix expected = eigen.eigenvectors() * kept.asDiagonal() * eigen.eigenvectors().transpose();
        long double error = 0;
        for (int i = 0, entry = 0; i < m; ++i)
          for (int j = 0; j <= i; ++j, ++entry)
            for (int l = 0; l < width; ++l)
              error = std::max(error, std::abs(packed[static_cast<size_t>(entry * width + l)] - expected(i, j)));
        // Rounding of the singular values moves blocks by up to cond(F)^2 where they grow with 1/s^2, and where a law
        // just begins to act by what it changes with them.
        const double condition = s[0] / std::max(std::abs(s[lanes_of(n - 1)]), 1e-3 * s[0]);
        EXPECT_LE(error, 1e-14 * condition * condition * eigen.eigenvalues().cwiseAbs().maxCoeff() + 4e-16 * change)
            << state.kind << " width " << width;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Densities, Principal, ::testing::ValuesIn(densities()),
                         [](const auto& info) { return info.param.name; });

TEST(PrincipalPass, LeavesOutWhatNeedsNoProjectionOrIsNotIsotropic) {
  const auto principal = [](const std::string& value) {
    const Energy energy = parse_energy(
        "density law solid\nframe fixed\nparam k Pa (0, inf) stiffness\nvalue " + value + "\n", "law.energy");
    return generate(energy, {}).module.principal.size();
  };
  EXPECT_EQ(principal("k*tr(F'*F)"), 0U);    // constant Hessian
  EXPECT_EQ(principal("k*F[0,0]^4"), 0U);    // not isotropic
  EXPECT_EQ(principal("k*tr(F'*F)^2"), 0U);  // convex
  EXPECT_EQ(principal("k*(tr(F'*F) - 3)^2"), 12U);
}

}  // namespace
}  // namespace ergon::testing
