#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "runtime/aligned.h"
#include "runtime/lanes/lanes.h"
#include "runtime/lanes/projection_table.h"

namespace ergon::lanes {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Exact = Eigen::Matrix<long double, 3, 3>;

class Random {
 public:
  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(engine_); }
  double normal() { return normal_(engine_); }
  int integer(int n) { return static_cast<int>(engine_() % static_cast<unsigned>(n)); }
  Matrix3d normal_matrix() {
    return Matrix3d::NullaryExpr([this] { return normal(); });
  }
  Matrix3d rotation() {
    return Eigen::Quaterniond(normal(), normal(), normal(), normal()).normalized().toRotationMatrix();
  }
  Matrix3d with_values(double a, double b, double c) {
    return rotation() * Vector3d(a, b, c).asDiagonal() * rotation().transpose();
  }
  double power(double low, double high) { return std::pow(10.0, uniform(low, high)); }

 private:
  std::mt19937 engine_{11};
  std::normal_distribution<double> normal_;
};

struct Family {
  const char* name;
  std::function<Matrix3d(Random&)> make;
};

const std::vector<Family>& families() {
  static const std::vector<Family> all = {
      {"normal entries", [](Random& r) { return r.normal_matrix(); }},
      {"identity", [](Random&) { return Matrix3d(Matrix3d::Identity()); }},
      {"rotation", [](Random& r) { return r.rotation(); }},
      {"reflection", [](Random& r) { return Matrix3d(-r.rotation()); }},
      {"zero", [](Random&) { return Matrix3d(Matrix3d::Zero()); }},
      {"rank one", [](Random& r) { return r.with_values(2, 0, 0); }},
      {"rank one, whole numbers",
       [](Random& r) {
         const Vector3d a(r.integer(3) - 1, r.integer(3) - 1, r.integer(3) - 1);
         return Matrix3d(a * Vector3d(r.integer(3) - 1, r.integer(3) - 1, 1).transpose());
       }},
      {"rank two", [](Random& r) { return r.with_values(2, r.uniform(0.01, 2), 0); }},
      {"two equal", [](Random& r) { return r.with_values(3, 3, r.uniform(-3, 3)); }},
      {"two small equal", [](Random& r) { return r.with_values(3, r.power(-17, 0), r.power(-17, 0)); }},
      {"two equal and opposite",
       [](Random& r) {
         const double s = r.uniform(0, 1);
         return r.with_values(1, s, -s);
       }},
      {"nearly a rotation", [](Random& r) { return Matrix3d(r.rotation() + r.power(-17, -1) * r.normal_matrix()); }},
      {"nearly equal",
       [](Random& r) { return r.with_values(1 + r.power(-17, -1), 1 - r.power(-17, -1), 1 + r.power(-17, -1)); }},
      {"spread", [](Random& r) { return r.with_values(r.power(-20, 0), -r.power(-20, 0), r.power(-20, 0)); }},
      {"diagonal",
       [](Random& r) { return Matrix3d(Vector3d(r.integer(5) - 2, r.integer(5) - 2, r.integer(5) - 2).asDiagonal()); }},
      {"permutation",
       [](Random& r) {
         Matrix3d f = Matrix3d::Zero();
         const int first = r.integer(3), step = 1 + r.integer(2);
         for (int i = 0; i < 3; ++i) f((first + i * step) % 3, i) = r.integer(2) ? 1 : -1;
         return f;
       }},
      {"ones", [](Random&) { return Matrix3d(Matrix3d::Ones()); }},
      {"one entry",
       [](Random& r) {
         Matrix3d f = Matrix3d::Zero();
         f(r.integer(3), r.integer(3)) = r.normal();
         return f;
       }},
      {"shear", [](Random& r) {
         Matrix3d f = Matrix3d::Identity();
         f(0, 1) = r.power(-17, 3);
         return f;
       }}};
  return all;
}

struct Decomposition {
  Matrix3d u, v;
  Vector3d s;
};

std::vector<Decomposition> decompose(const ProjectionTable& table, const std::vector<Matrix3d>& f) {
  const int lanes = table.lanes;
  AlignedVector<double> in(9 * lanes), u(9 * lanes), s(3 * lanes), v(9 * lanes);
  for (int lane = 0; lane < lanes; ++lane) {
    for (int i = 0; i < 9; ++i) in[i * lanes + lane] = f[lane].data()[i];
  }
  table.svd3(in.data(), u.data(), s.data(), v.data());
  std::vector<Decomposition> out(lanes);
  for (int lane = 0; lane < lanes; ++lane) {
    for (int i = 0; i < 9; ++i) {
      out[lane].u.data()[i] = u[i * lanes + lane];
      out[lane].v.data()[i] = v[i * lanes + lane];
    }
    for (int i = 0; i < 3; ++i) out[lane].s[i] = s[i * lanes + lane];
  }
  return out;
}

void expect_rotation(const Matrix3d& r) {
  const Exact e = r.cast<long double>();
  ASSERT_LE((e.transpose() * e - Exact::Identity()).norm(), 3e-15L);
  ASSERT_NEAR(static_cast<double>(e.determinant()), 1.0, 3e-15);
}

class Svd3Test : public ::testing::TestWithParam<int> {};

TEST_P(Svd3Test, AgreesWithJacobi) {
  if (GetParam() > best_lanes()) GTEST_SKIP() << "this machine has no vectors of " << GetParam() << " doubles";
  const ProjectionTable& table = projection_table(GetParam());
  Random random;
  for (int round = 0; round < 4000; ++round) {
    const double scale = std::vector<double>{1, 1, 1e-150, 1e150, 3e-7}[round % 5];
    std::vector<Matrix3d> f;
    for (int lane = 0; lane < table.lanes; ++lane) {
      f.push_back(scale * families()[(round + lane) % families().size()].make(random));
    }
    const std::vector<Decomposition> d = decompose(table, f);
    for (int lane = 0; lane < table.lanes; ++lane) {
      SCOPED_TRACE(families()[(round + lane) % families().size()].name);
      // Eigen's Jacobi iteration takes what is below the smallest double for zero: it gets the matrix scaled.
      const Exact exact = (f[lane] / scale).cast<long double>();
      const Eigen::JacobiSVD<Exact> oracle(exact, Eigen::ComputeFullU | Eigen::ComputeFullV);
      const long double norm = oracle.singularValues()[0];
      const Vector3d s = d[lane].s / scale;
      expect_rotation(d[lane].u);
      expect_rotation(d[lane].v);
      const Exact product = d[lane].u.cast<long double>() * s.cast<long double>().asDiagonal() *
                            d[lane].v.cast<long double>().transpose();
      ASSERT_LE((product - exact).norm(), 4e-15L * norm) << exact;
      for (int i = 0; i < 3; ++i) {
        ASSERT_LE(std::abs(std::abs(static_cast<long double>(s[i])) - oracle.singularValues()[i]), 3e-15L * norm)
            << exact << "\n"
            << s;
      }
      ASSERT_GE(s[1], -3e-15L * norm);
      // The determinant itself is lost to rounding where two singular values are small.
      if (oracle.singularValues()[2] > 1e-14L * norm) {
        ASSERT_EQ(s[2] > 0, oracle.matrixU().determinant() * oracle.matrixV().determinant() > 0) << exact;
      }
      if (HasFatalFailure()) return;
    }
  }
}

TEST_P(Svd3Test, RestStateIsExact) {
  if (GetParam() > best_lanes()) GTEST_SKIP() << "this machine has no vectors of " << GetParam() << " doubles";
  const ProjectionTable& table = projection_table(GetParam());
  for (const Decomposition& d : decompose(table, std::vector<Matrix3d>(table.lanes, Matrix3d::Identity()))) {
    EXPECT_EQ(d.s, Vector3d::Ones());
    EXPECT_EQ(d.u, d.v);
  }
}

TEST_P(Svd3Test, NotFiniteStaysInItsLane) {
  if (GetParam() > best_lanes()) GTEST_SKIP() << "this machine has no vectors of " << GetParam() << " doubles";
  const ProjectionTable& table = projection_table(GetParam());
  Random random;
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (int entry = 0; entry < 9; ++entry) {
      std::vector<Matrix3d> f;
      for (int lane = 0; lane < table.lanes; ++lane) f.push_back(random.normal_matrix());
      const int bad_lane = entry % table.lanes;
      f[bad_lane].data()[entry] = bad;
      const std::vector<Decomposition> d = decompose(table, f);
      for (int lane = 0; lane < table.lanes; ++lane) {
        if (lane == bad_lane) {
          EXPECT_FALSE(d[lane].s.allFinite());
        } else {
          EXPECT_LE((d[lane].u * d[lane].s.asDiagonal() * d[lane].v.transpose() - f[lane]).norm(),
                    1e-14 * f[lane].norm());
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Lanes, Svd3Test, ::testing::ValuesIn(lanes::kWidths));

}  // namespace
}  // namespace ergon::lanes
