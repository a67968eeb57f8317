#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>
#include <cstring>
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

using Exact = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using Spectrum = Eigen::VectorXd;
using Packed = AlignedVector<double>;

std::vector<int> widths() {
  std::vector<int> w;
  for (int lanes : lanes::kWidths) {
    if (lanes <= best_lanes()) w.push_back(lanes);
  }
  return w;
}

class Random {
 public:
  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(engine_); }
  double normal() { return normal_(engine_); }
  int integer(int n) { return static_cast<int>(engine_() % static_cast<unsigned>(n)); }
  Eigen::MatrixXd square(int n) {
    return Eigen::MatrixXd::NullaryExpr(n, n, [this] { return normal(); });
  }
  Eigen::MatrixXd with_spectrum(const Spectrum& d) {
    const int n = static_cast<int>(d.size());
    const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(square(n)).householderQ();
    const Eigen::MatrixXd h = q * d.asDiagonal() * q.transpose();
    return 0.5 * (h + h.transpose());
  }

 private:
  std::mt19937 engine_{7};
  std::normal_distribution<double> normal_;
};

struct Family {
  const char* name;
  std::function<Eigen::MatrixXd(Random&, int n)> make;
};

Eigen::MatrixXd kronecker(const Eigen::MatrixXd& a, int n) {
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      if (i % 3 == j % 3) h(i, j) = a(i / 3, j / 3);
    }
  }
  return h;
}

Spectrum spectrum(int n, const std::function<double(int)>& value) {
  Spectrum d(n);
  for (int i = 0; i < n; ++i) d[i] = value(i);
  return d;
}

std::vector<Family> families() {
  const auto sign = [](Random& r) { return r.integer(2) ? 1.0 : -1.0; };
  return {
      {"normal entries",
       [](Random& r, int n) {
         const Eigen::MatrixXd a = r.square(n);
         return Eigen::MatrixXd(a + a.transpose());
       }},
      {"few negative",
       [](Random& r, int n) {
         const int negative = r.integer(4);
         return r.with_spectrum(spectrum(n, [&](int i) { return (i < negative ? -1 : 1) * std::abs(r.normal()); }));
       }},
      {"spread over 18 decades",
       [=](Random& r, int n) {
         return r.with_spectrum(spectrum(n, [&](int) { return sign(r) * std::pow(10.0, r.uniform(-18, 0)); }));
       }},
      {"one cluster",
       [=](Random& r, int n) {
         const double width = std::pow(10.0, r.uniform(-16, -2));
         return r.with_spectrum(spectrum(n, [&](int) { return -1 + width * r.normal(); }));
       }},
      {"negative cluster",
       [=](Random& r, int n) {
         const double width = std::pow(10.0, r.uniform(-17, -2));
         const int negative = r.integer(n + 1);
         return r.with_spectrum(
             spectrum(n, [&](int i) { return i < negative ? -0.5 + width * r.normal() : 2 + r.normal(); }));
       }},
      {"equal eigenvalues",
       [=](Random& r, int n) { return r.with_spectrum(spectrum(n, [&](int) { return r.integer(3) - 1.0; })); }},
      {"plus and minus one",
       [=](Random& r, int n) { return r.with_spectrum(spectrum(n, [&](int) { return sign(r); })); }},
      {"rank one",
       [=](Random& r, int n) {
         const Eigen::VectorXd v = r.square(n).col(0);
         return Eigen::MatrixXd(sign(r) * v * v.transpose());
       }},
      {"semi-definite",
       [](Random& r, int n) {
         const Eigen::MatrixXd v = r.square(n).leftCols(n - r.integer(n));
         return Eigen::MatrixXd(v * v.transpose());
       }},
      {"nearly singular",
       [=](Random& r, int n) {
         return r.with_spectrum(
             spectrum(n, [&](int i) { return i < 2 ? sign(r) * std::pow(10, r.uniform(-17, -11)) : 1 + i; }));
       }},
      {"diagonal",
       [](Random& r, int n) {
         return Eigen::MatrixXd(spectrum(n, [&](int) { return r.integer(5) - 2.0; }).asDiagonal());
       }},
      {"zero", [](Random&, int n) { return Eigen::MatrixXd(Eigen::MatrixXd::Zero(n, n)); }},
      {"identity", [=](Random& r, int n) { return Eigen::MatrixXd(sign(r) * Eigen::MatrixXd::Identity(n, n)); }},
      {"three equal parts",
       [](Random& r, int n) {
         const Eigen::MatrixXd a = r.square((n + 2) / 3);
         return kronecker(a + a.transpose(), n);
       }},
      {"off-diagonal only",
       [](Random& r, int n) {
         Eigen::MatrixXd h = Eigen::MatrixXd::Zero(n, n);
         for (int i = 0; i + 1 < n; ++i) h(i, i + 1) = h(i + 1, i) = r.integer(2);
         return h;
       }},
      {"graded",
       [](Random& r, int n) {
         const Eigen::MatrixXd a = r.square(n);
         const Eigen::VectorXd s = spectrum(n, [](int i) { return std::pow(10.0, -2.0 * i); });
         return Eigen::MatrixXd(s.asDiagonal() * (a + a.transpose()) * s.asDiagonal());
       }},
      {"Wilkinson",
       [](Random&, int n) {
         Eigen::MatrixXd h = Eigen::MatrixXd::Zero(n, n);
         for (int i = 0; i < n; ++i) h(i, i) = std::abs(i - (n - 1) / 2) - 2.0;
         for (int i = 0; i + 1 < n; ++i) h(i, i + 1) = h(i + 1, i) = 1;
         return h;
       }},
      // A function of one scalar of a stencil: one large eigenvalue, pairs of both signs decades apart, zeros.
      {"stencil",
       [](Random& r, int n) {
         const double decade = r.uniform(-3, -1);
         return r.with_spectrum(spectrum(n, [&](int i) {
           if (i == 0) return 1.0;
           return i > 8 ? 0.0 : (i % 2 == 0 ? -1 : 1) * std::pow(10.0, decade * (1 + i / 5)) * r.uniform(0.8, 1);
         }));
       }},
      {"entries of one", [=](Random& r, int n) { return Eigen::MatrixXd(sign(r) * Eigen::MatrixXd::Ones(n, n)); }},
  };
}

int entries(int n) { return n * (n + 1) / 2; }

void pack(const Eigen::MatrixXd& h, int lanes, int lane, double* packed) {
  for (int i = 0; i < h.rows(); ++i) {
    for (int j = 0; j <= i; ++j) packed[(i * (i + 1) / 2 + j) * lanes + lane] = h(i, j);
  }
}

Eigen::MatrixXd unpack(const double* packed, int n, int lanes, int lane) {
  Eigen::MatrixXd h(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) h(i, j) = h(j, i) = packed[(i * (i + 1) / 2 + j) * lanes + lane];
  }
  return h;
}

double smallest_eigenvalue(const Eigen::MatrixXd& h) {
  return static_cast<double>(
      Eigen::SelfAdjointEigenSolver<Exact>(h.cast<long double>(), Eigen::EigenvaluesOnly).eigenvalues().minCoeff());
}

void expect_projected(const Eigen::MatrixXd& before, const Eigen::MatrixXd& after, bool absolute,
                      const std::string& what) {
  const Eigen::SelfAdjointEigenSolver<Exact> oracle(before.cast<long double>());
  const long double norm = oracle.eigenvalues().cwiseAbs().maxCoeff();
  const auto projected = absolute ? oracle.eigenvalues().cwiseAbs().eval() : oracle.eigenvalues().cwiseMax(0).eval();
  const Exact expected = oracle.eigenvectors() * projected.asDiagonal() * oracle.eigenvectors().transpose();
  const long double error = (after.cast<long double>() - expected).norm();
  const long double rounding = (before.rows() > 12 ? 2e-14L : 1e-14L) * norm;
  ASSERT_LE(error, rounding) << what << "\n" << before;
  ASSERT_GE(smallest_eigenvalue(after), -rounding) << what << "\n" << before;
}

// Every family at every size and width, several scales, both modes; neighbours in a vector are of different families.
class ProjectionTest : public ::testing::TestWithParam<int> {};

TEST_P(ProjectionTest, AgreesWithEigenDecomposition) {
  const int n = GetParam();
  const std::vector<Family> all = families();
  Random random;
  for (const int lanes : widths()) {
    const ProjectionTable& table = projection_table(lanes);
    for (int round = 0; round < 160 / lanes; ++round) {
      const double scale = std::vector<double>{1, 1, 1e-150, 1e150, 3e-7}[round % 5];
      const bool absolute = round % 2 == 1;
      Packed packed(entries(n) * lanes);
      std::vector<Eigen::MatrixXd> before;
      std::vector<std::string> names;
      for (int lane = 0; lane < lanes; ++lane) {
        // Odd rounds hold one family: then a family decides alone how the whole vector is treated.
        const Family& family = all[(round % 4 < 2 ? round + lane : round) % all.size()];
        before.push_back(scale * family.make(random, n));
        names.push_back(std::string(family.name) + ", N = " + std::to_string(n) + ", lanes = " + std::to_string(lanes) +
                        (absolute ? ", absolute" : ", clamp"));
        pack(before.back(), lanes, lane, packed.data());
      }
      const unsigned every = (1u << lanes) - 1;
      const Packed given = packed;
      Packed first = packed, second = packed;
      table.project[n](packed.data(), absolute, every);
      // Two vectors at a time, one of them with half its lanes.
      table.project_two[n](first.data(), every, second.data(), every & 0x55u, absolute);
      for (int lane = 0; lane < lanes; ++lane) {
        const Eigen::MatrixXd once = unpack(packed.data(), n, lanes, lane);
        const double rounding = 1e-14 * before[lane].norm();
        ASSERT_LE((unpack(first.data(), n, lanes, lane) - once).norm(), rounding) << names[lane];
        const bool asked = lane % 2 == 0;
        ASSERT_LE(
            (unpack(second.data(), n, lanes, lane) - (asked ? once : unpack(given.data(), n, lanes, lane))).norm(),
            asked ? rounding : 0)
            << names[lane];
      }
      for (int lane = 0; lane < lanes; ++lane) {
        expect_projected(before[lane], unpack(packed.data(), n, lanes, lane), absolute, names[lane]);
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST_P(ProjectionTest, KeepsDefiniteMatricesAndOtherLanesBitByBit) {
  const int n = GetParam();
  Random random;
  for (const int lanes : widths()) {
    const ProjectionTable& table = projection_table(lanes);
    for (int round = 0; round < 40; ++round) {
      Packed packed(entries(n) * lanes);
      for (int lane = 0; lane < lanes; ++lane) {
        const double sign = lane % 2 == 0 ? 1 : -1;
        pack(random.with_spectrum(spectrum(n, [&](int) { return sign * random.uniform(0.01, 1); })), lanes, lane,
             packed.data());
      }
      const Packed before = packed;
      const unsigned chosen = 0x77 & ((1u << lanes) - 1);
      table.project[n](packed.data(), false, chosen);
      for (int lane = 0; lane < lanes; ++lane) {
        const Eigen::MatrixXd a = unpack(before.data(), n, lanes, lane), b = unpack(packed.data(), n, lanes, lane);
        if (lane % 2 == 0 || (chosen >> lane & 1) == 0) {
          ASSERT_EQ(0, std::memcmp(a.data(), b.data(), sizeof(double) * n * n)) << "lane " << lane << " of " << lanes;
        } else {
          ASSERT_LE(b.norm(), 1e-14 * a.norm()) << "lane " << lane << " of " << lanes;
        }
      }
    }
  }
}

TEST_P(ProjectionTest, LeavesWhatIsNotFiniteAndProjectsItsNeighbours) {
  const int n = GetParam();
  Random random;
  const double bad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity()};
  for (const int lanes : widths()) {
    const ProjectionTable& table = projection_table(lanes);
    for (int entry = 0; entry < entries(n); ++entry) {
      Packed packed(entries(n) * lanes);
      std::vector<Eigen::MatrixXd> before;
      for (int lane = 0; lane < lanes; ++lane) {
        const Eigen::MatrixXd a = random.square(n);
        before.push_back(a + a.transpose());
        pack(before.back(), lanes, lane, packed.data());
      }
      const int bad_lane = entry % lanes;
      packed[entry * lanes + bad_lane] = bad[entry % 3];
      const Eigen::MatrixXd bad_before = unpack(packed.data(), n, lanes, bad_lane);
      ASSERT_EQ(0u, table.definite[n](packed.data()) >> bad_lane & 1);
      table.project[n](packed.data(), false, (1u << lanes) - 1);
      for (int lane = 0; lane < lanes; ++lane) {
        const Eigen::MatrixXd after = unpack(packed.data(), n, lanes, lane);
        if (lane == bad_lane) {
          ASSERT_EQ(0, std::memcmp(bad_before.data(), after.data(), sizeof(double) * n * n));
        } else {
          expect_projected(before[lane], after, false, "beside a lane that is not finite");
          if (HasFatalFailure()) return;
        }
      }
    }
  }
}

// Matrices on both sides of the tolerance, where only the bound decides.
TEST_P(ProjectionTest, DefiniteNeverAcceptsWhatIsBelowTheTolerance) {
  const int n = GetParam();
  std::vector<Family> all = families();
  all.push_back({"at the tolerance", [](Random& r, int size) {
                   return r.with_spectrum(spectrum(size, [&](int i) {
                     return i == 0 ? r.uniform(-2, 0.5) * 2e-15 * size : std::pow(10, r.uniform(-16, 0));
                   }));
                 }});
  all.push_back({"just below zero", [](Random& r, int size) {
                   return r.with_spectrum(spectrum(
                       size, [&](int i) { return i == 0 ? -std::pow(10, r.uniform(-16, -10)) : r.uniform(0.001, 1); }));
                 }});
  Random random;
  long accepted = 0, refused = 0;
  for (const int lanes : widths()) {
    const ProjectionTable& table = projection_table(lanes);
    for (int round = 0; round < 60 * static_cast<int>(all.size()) / lanes; ++round) {
      Packed packed(entries(n) * lanes);
      std::vector<Eigen::MatrixXd> h;
      for (int lane = 0; lane < lanes; ++lane) {
        h.push_back(all[(round + lane) % all.size()].make(random, n));
        pack(h.back(), lanes, lane, packed.data());
      }
      const unsigned definite = table.definite[n](packed.data());
      ASSERT_EQ(0u, definite >> lanes);
      for (int lane = 0; lane < lanes; ++lane) {
        const double least = smallest_eigenvalue(h[lane]), largest = h[lane].diagonal().maxCoeff();
        if (definite >> lane & 1) {
          ++accepted;
          ASSERT_GE(least, -table.definite_tolerance[n] * largest) << all[(round + lane) % all.size()].name << h[lane];
        } else {
          ++refused;
          ASSERT_LT(least, 1e-14 * n * h[lane].cwiseAbs().maxCoeff()) << h[lane];
        }
      }
    }
  }
  EXPECT_GT(accepted, 50);
  EXPECT_GT(refused, 50);
}

// At rest the Hessians of springs and of many membranes are exactly singular.
TEST_P(ProjectionTest, DefiniteAcceptsExactlySemiDefinite) {
  const int n = GetParam();
  Random random;
  for (const int lanes : widths()) {
    const ProjectionTable& table = projection_table(lanes);
    for (int round = 0; round < 50; ++round) {
      Packed packed(entries(n) * lanes);
      for (int lane = 0; lane < lanes; ++lane) {
        const int rank = random.integer(n + 1);
        const Eigen::MatrixXd v = Eigen::MatrixXd::NullaryExpr(n, rank, [&] { return random.integer(7) - 3.0; });
        pack(v * v.transpose(), lanes, lane, packed.data());
      }
      ASSERT_EQ((1u << lanes) - 1, table.definite[n](packed.data()));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, ProjectionTest, ::testing::Range(1, ProjectionTable::kLargest + 1));

TEST(ProjectionTableTest, RefusesAWidthThatDoesNotExist) { EXPECT_THROW(projection_table(3), std::invalid_argument); }

}  // namespace
}  // namespace ergon::lanes
