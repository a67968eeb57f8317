#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "runtime/aligned.h"
#include "runtime/lanes/lanes.h"
#include "runtime/lanes/projection_table.h"

namespace ergon::lanes {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix9d = Eigen::Matrix<double, 9, 9>;
using Exact9 = Eigen::Matrix<long double, 9, 9>;

// psi = mu/2 (tr(F'F) - 3) - mu (J - 1) + la/2 (J - 1)^2.
constexpr double kMu = 1.0, kLa = 4.0;

// d(cof F)/dF is linear in F: entry (r, c) of the derivative along E(q, d) is the sum over s, b of e_rqs e_cdb F(s, b).
Matrix9d hessian(const Matrix3d& f) {
  const auto permutation = [](int i, int j, int k) { return (i - j) * (j - k) * (k - i) / 2.0; };
  const double j = f.determinant();
  Matrix3d cofactor;
  for (int i = 0; i < 3; ++i) cofactor.col(i) = f.col((i + 1) % 3).cross(f.col((i + 2) % 3));
  const Eigen::Map<Eigen::Matrix<double, 9, 1>> g(cofactor.data());
  Matrix9d h = kMu * Matrix9d::Identity() + kLa * g * g.transpose();
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      for (int d = 0; d < 3; ++d) {
        for (int q = 0; q < 3; ++q) {
          for (int s = 0; s < 3; ++s) {
            for (int b = 0; b < 3; ++b) {
              h(3 * c + r, 3 * d + q) += (kLa * (j - 1) - kMu) * permutation(r, q, s) * permutation(c, d, b) * f(s, b);
            }
          }
        }
      }
    }
  }
  return h;
}

// The same law in singular values.
void blocks(const Vector3d& s, double* out, int lanes, int lane) {
  const double c = kLa * (s.prod() - 1) - kMu;
  const Vector3d dj(s[1] * s[2], s[0] * s[2], s[0] * s[1]);
  int n = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      out[n++ * lanes + lane] = i == j ? kMu + kLa * dj[i] * dj[i] : kLa * dj[i] * dj[j] + c * s[3 - i - j];
    }
  }
  for (int k = 0; k < 3; ++k) out[n++ * lanes + lane] = kMu + c * s[k];
  for (int k = 0; k < 3; ++k) out[n++ * lanes + lane] = kMu - c * s[k];
}

class IsotropicTest : public ::testing::TestWithParam<int> {};

TEST_P(IsotropicTest, AgreesWithTheProjectedDenseHessian) {
  if (GetParam() > best_lanes()) GTEST_SKIP() << "this machine has no vectors of " << GetParam() << " doubles";
  const ProjectionTable& table = projection_table(GetParam());
  const int lanes = table.lanes;
  std::mt19937 engine(3);
  std::normal_distribution<double> normal;
  const double amplitudes[] = {0, 1e-9, 0.01, 0.3, 1, 3};
  int changed_count = 0, kept_count = 0;
  for (int round = 0; round < 600; ++round) {
    const bool absolute = round % 2 == 1;
    AlignedVector<double> f(9 * lanes), u(9 * lanes), v(9 * lanes), s(3 * lanes), b(12 * lanes), packed(45 * lanes);
    std::vector<Matrix3d> states;
    for (int lane = 0; lane < lanes; ++lane) {
      const Matrix3d noise = Matrix3d::NullaryExpr([&] { return normal(engine); });
      const Eigen::Quaterniond rotation =
          Eigen::Quaterniond(normal(engine), normal(engine), normal(engine), normal(engine)).normalized();
      states.push_back(rotation.toRotationMatrix() + amplitudes[(round / 2 + lane) % 6] * noise);
      if (round % 7 == 0) states.back().col(round % 3).setZero();
      for (int i = 0; i < 9; ++i) f[i * lanes + lane] = states.back().data()[i];
    }
    table.svd3(f.data(), u.data(), s.data(), v.data());
    for (int lane = 0; lane < lanes; ++lane) {
      blocks(Vector3d(s[lane], s[lanes + lane], s[2 * lanes + lane]), b.data(), lanes, lane);
    }
    const unsigned changed = table.isotropic[3](f.data(), b.data(), absolute, packed.data());
    for (int lane = 0; lane < lanes; ++lane) {
      Matrix9d h;
      for (int i = 0; i < 9; ++i) {
        for (int j = 0; j <= i; ++j) h(i, j) = h(j, i) = packed[(i * (i + 1) / 2 + j) * lanes + lane];
      }
      const Eigen::SelfAdjointEigenSolver<Exact9> oracle(hessian(states[lane]).cast<long double>());
      const long double norm = oracle.eigenvalues().cwiseAbs().maxCoeff();
      const auto kept = absolute ? oracle.eigenvalues().cwiseAbs().eval() : oracle.eigenvalues().cwiseMax(0).eval();
      const Exact9 expected = oracle.eigenvectors() * kept.asDiagonal() * oracle.eigenvectors().transpose();
      ASSERT_LE((h.cast<long double>() - expected).norm(), 1e-14L * norm) << states[lane];
      if (std::abs(oracle.eigenvalues().minCoeff()) > 1e-12L * norm) {
        ASSERT_EQ(changed >> lane & 1, oracle.eigenvalues().minCoeff() < 0) << states[lane];
        ++(changed >> lane & 1 ? changed_count : kept_count);
      }
    }
  }
  EXPECT_GT(changed_count, 50);
  EXPECT_GT(kept_count, 50);
}

TEST_P(IsotropicTest, NotFiniteStaysNotFinite) {
  if (GetParam() > best_lanes()) GTEST_SKIP() << "this machine has no vectors of " << GetParam() << " doubles";
  const ProjectionTable& table = projection_table(GetParam());
  const int lanes = table.lanes;
  for (int entry = 0; entry < 12; ++entry) {
    AlignedVector<double> f(9 * lanes), b(12 * lanes), packed(45 * lanes);
    for (int lane = 0; lane < lanes; ++lane) {
      for (int i = 0; i < 3; ++i) f[4 * i * lanes + lane] = 1;
      blocks(Vector3d::Ones(), b.data(), lanes, lane);
    }
    b[entry * lanes] = std::numeric_limits<double>::quiet_NaN();
    table.isotropic[3](f.data(), b.data(), false, packed.data());
    bool finite = true;
    for (int i = 0; i < 45; ++i) finite = finite && std::isfinite(packed[i * lanes]);
    EXPECT_FALSE(finite) << entry;
    for (int i = 0; i < 45; ++i) {
      for (int lane = 1; lane < lanes; ++lane) EXPECT_TRUE(std::isfinite(packed[i * lanes + lane]));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Lanes, IsotropicTest, ::testing::ValuesIn(lanes::kWidths));

}  // namespace
}  // namespace ergon::lanes
