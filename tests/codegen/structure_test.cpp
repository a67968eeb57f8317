// What the structure pass knows of an energy, held against the eigen-decomposition of its Hessian: for every energy of
// the catalogue, and for some that are written to be close to the border of what it may find.

#include "codegen/structure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <algorithm>

#include "tests/codegen/evaluate_kernel.h"
#include "tests/codegen/states.h"
#include "tests/symbolic/energy_files.h"

namespace ergon::testing {
namespace {

Eigen::MatrixXd unpacked(const std::vector<double>& packed, int n) {
  Eigen::MatrixXd a(n, n);
  for (int i = 0, k = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j, ++k) a(i, j) = a(j, i) = packed[static_cast<size_t>(k)];
  return a;
}

struct Found {
  bool psd = false, closed = false;
  int changed = 0;  // states in which the closed form changed something
};

// Evaluates the energy at its test states in all widths and holds what was found against the eigenvalues.
Found hold_against_eigenvalues(const Energy& energy, const std::string& case_name) {
  Found found;
  for (int lanes : test_widths()) {
    const CompiledKernel kernel = test_kernel(energy, case_name, lanes);
    const int n = 3 * kernel.table->q_vectors;
    found.psd = kernel.table->psd_hessian;
    found.closed = kernel.table->projected != nullptr;
    EXPECT_FALSE(found.psd && found.closed);
    for (const State& state : draw_states(energy, case_name, 21)) {
      const KernelValue v = evaluate_kernel(energy, *kernel.table, {state.inputs})[0];
      const Eigen::MatrixXd hessian = unpacked(v.q_hessian, n);
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(hessian);
      const Eigen::VectorXd& x = eigen.eigenvalues();
      const double size = x.cwiseAbs().maxCoeff(), rounding = 1e-13 * size;
      if (found.psd) {
        EXPECT_GE(x.minCoeff(), -rounding) << energy.name << " " << state.kind;
      }
      for (int mode = 0; mode < 2 && found.closed; ++mode) {
        const Eigen::VectorXd kept = mode == 0 ? Eigen::VectorXd(x.cwiseMax(0)) : Eigen::VectorXd(x.cwiseAbs());
        const Eigen::MatrixXd expected = eigen.eigenvectors() * kept.asDiagonal() * eigen.eigenvectors().transpose();
        EXPECT_LE((unpacked(v.projected[mode], n) - expected).cwiseAbs().maxCoeff(), rounding)
            << energy.name << " " << state.kind << (mode == 0 ? " clamped" : " absolute");
        if (std::abs(x.minCoeff()) > rounding) {
          EXPECT_EQ(v.changed[mode], x.minCoeff() < 0) << energy.name << " " << state.kind;
        }
        found.changed += v.changed[mode];
      }
    }
  }
  return found;
}

class StructureOf : public ::testing::TestWithParam<std::string> {};

TEST_P(StructureOf, AgreesWithEigenvalues) {
  const Energy& energy = test::shipped(GetParam());
  for (const std::string& c : energy.cases.empty() ? std::vector<std::string>{""} : energy.cases)
    hold_against_eigenvalues(energy, c);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, StructureOf, ::testing::ValuesIn(test::catalogue_names()),
                         [](const auto& info) { return test::name_of_test(info.param); });

Found found_in(const std::string& header, const std::string& value) {
  const Energy energy = parse_energy(header + "value " + value + "\n", "made_up.energy");
  return hold_against_eigenvalues(energy, "");
}

// An energy must use all that it declares.
Found of_point(const std::string& value) {
  std::string header =
      "energy a point\ncite Made up for a test.\nframe fixed\ndof x m\nparam k J (0, inf)\nparam L m (0, inf)\n";
  if (value.find("nu") != std::string::npos) header += "param nu 1 (-1, 1/2)\n";
  if (value.find("x - c") != std::string::npos || value.find("(c, x)") != std::string::npos) header += "lag c[3] m\n";
  return found_in(header, value);
}

Found of_triangle(const std::string& value) {
  return found_in(
      "energy a triangle\ncite Made up for a test.\nframe fixed\ndof x0 x1 x2 m\nparam k J (0, inf)\n"
      "param L m (0, inf)\n",
      value);
}

TEST(ClosedForm, IsFoundForFunctionsOfOneScalar) {
  for (const char* value : {"k*(norm(x - c)/L - 1)^2", "k*(norm2(x - c)/L^2 - 1)^2", "-k*log(norm2(x - c)/L^2)",
                            "k*(norm2(x - c)/L^2 + 3*x[0]/L - 1)^2", "-k*norm2(x - c)/L^2", "k*nu*norm2(x - c)/L^2",
                            "k*sin(dot(c, x)/L^2)"}) {
    const Found found = of_point(value);
    EXPECT_TRUE(found.closed) << value;
    EXPECT_GT(found.changed, 0) << value;
  }
  for (const char* value : {"k*((norm2(x1 - x0) + norm2(x2 - x0))/L^2 - 1)^2",
                            "k*sin((x1[0] - x0[0])/L + 2*(x2[1] - x0[1])/L)", "k*(norm(x1 - 3*x0 + 2*x2)/L - 1)^2"}) {
    EXPECT_TRUE(of_triangle(value).closed) << value;
  }
}

TEST(ClosedForm, IsNotFoundWhereThereIsNone) {
  for (const char* value :
       {"k*sin(x[0]/L)*sin(x[1]/L)", "k*(norm2(x - c)/L^2 - 1)^2 + k*sin(x[0]/L)",
        "k*sin((x[0]^2 + 2*x[1]^2 + x[2]^2)/L^2)", "k*sin((x[0]^2 + x[1]^2)/L^2)", "k*sin(x[0]*x[1]*x[2]/L^3)"}) {
    EXPECT_FALSE(of_point(value).closed) << value;
  }
  EXPECT_FALSE(of_triangle("k*((norm2(x1 - x0) + 2*norm2(x2 - x0))/L^2 - 1)^2").closed);
}

TEST(Convexity, IsFoundFromThePartsOfAnEnergy) {
  for (const char* value :
       {"k*norm2(x - c)/L^2", "k*norm(x - c)/L", "k*(norm(x - c)/L)^3", "k*exp(dot(c, x)/L^2) + k*x[0]/L",
        "k*max(norm(x - c)/L - 1, 0)^2", "k*(1 - 2*nu)*norm2(x - c)/L^2", "k*sqrt(1 + norm2(x - c)/L^2)",
        "k*(x[0]/L + 1)^2 + 2*k*((x[1] - x[2])/L)^4", "k*abs(x[0]/L - 1)", "k/(1 - 2*nu)*norm2(x)/L^2",
        "-k*min(-norm2(x - c)/L^2, 1)", "k*max(norm2(x - c)/L^2, x[0]/L)"}) {
    EXPECT_TRUE(of_point(value).psd) << value;
  }
}

TEST(Convexity, IsNotClaimedOfWhatMayBeConcave) {
  for (const char* value :
       {"k*(norm(x - c)/L - 1)^2", "k*min(norm(x - c)/L, x[0]/L)", "k*nu*norm2(x - c)/L^2", "-k*norm(x - c)/L",
        "k*(norm2(x - c)/L^2 - 1)^2", "k*log(1 + norm2(x - c)/L^2)", "k*(x[0]/L)^3", "k*x[0]*x[1]/L^2",
        "k*sqrt(norm2(x - c)/L^2 + nu + 1)*x[0]/L", "k*sin(x[0]/L)", "k*max(x[0]/L, -norm2(x)/L^2)"}) {
    EXPECT_FALSE(of_point(value).psd) << value;
  }
}

}  // namespace
}  // namespace ergon::testing
