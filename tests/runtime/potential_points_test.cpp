// Stencils whose points are not those of their kernel: only the ones its q depends on, or others with weights of each
// stencil's own.

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "runtime/error.h"
#include "runtime/lanes/lanes.h"
#include "runtime/system.h"
#include "tests/runtime/count_allocations.h"
#include "tests/runtime/dense_oracle.h"
#include "tests/runtime/mesh_helpers.h"

namespace ergon {
namespace {

using namespace testing;  // NOLINT

constexpr int kVertices = 40;

// Four points, two vectors, every point used.
struct CrossLaw : BendLaw {
  static constexpr int kPoints = 4;
  static constexpr std::array<double, 8> kWeights{1, -2, 1, 0.5, 0, -1, 1, 0};
  static constexpr std::array<const char*, 4> kPointNames{"x0", "x1", "x2", "x3"};
};

// Four points of which q takes the first and the last; each stencil has a rest position of a point it takes.
struct AnchoredLaw : LawDefaults {
  static constexpr const char* kName = "anchored";
  static constexpr const char* kGeometry = "quadruple";
  static constexpr int kPoints = 4, kVectors = 1, kParams = 0, kRaw = 3;
  static constexpr std::array<double, 4> kWeights{-1, 0, 0, 1};
  static constexpr std::array<const char*, 4> kPointNames{"x0", "x1", "x2", "x3"};
  static constexpr std::array<ErgonInput, 1> kInputs{{{"X3", ERGON_REST, 3, 1, 0}}};
  template <class T>
  static T psi(const T* q, const double* e, const double*) {
    const T d[3] = {q[0] - e[0], q[1] - e[1], q[2] - e[2]};
    return dot(q, q) * dot(d, d);
  }
};

// The same with the rest position of a point it does not take.
struct ElsewhereLaw : AnchoredLaw {
  static constexpr std::array<ErgonInput, 1> kInputs{{{"X1", ERGON_REST, 3, 1, 0}}};
};

// Four vectors.
struct QuadrupleLaw : LawDefaults {
  static constexpr const char* kName = "quadruple";
  static constexpr const char* kGeometry = "quadruple";
  static constexpr int kPoints = 4, kVectors = 4, kParams = 0, kRaw = 0;
  static constexpr std::array<double, 16> kWeights{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  static constexpr std::array<const char*, 4> kPointNames{"x0", "x1", "x2", "x3"};
  static constexpr std::array<ErgonInput, 0> kInputs{};
  template <class T>
  static T psi(const T* q, const double*, const double*) {
    return triple(q, q + 3, q + 6) + dot(q, q + 9) * dot(q + 3, q + 6) + dot(q + 9, q + 9);
  }
};

struct Points {
  std::mt19937 random{5};
  std::normal_distribution<double> normal;
  Eigen::Matrix3Xd x{3, kVertices};

  Points() {
    for (double& v : x.reshaped()) v = normal(random);
  }
  std::vector<int> stencils(int count, int points) {
    std::vector<int> all, order(kVertices);
    std::iota(order.begin(), order.end(), 0);
    for (int i = 0; i < count; ++i) {
      std::shuffle(order.begin(), order.end(), random);
      all.insert(all.end(), order.begin(), order.begin() + points);
    }
    return all;
  }
  std::vector<double> numbers(size_t count) {
    std::vector<double> all(count);
    for (double& v : all) v = normal(random);
    return all;
  }
};

std::vector<char> some_fixed() {
  std::vector<char> fixed(kVertices, 0);
  for (int v = 0; v < kVertices; v += 7) fixed[static_cast<size_t>(v)] = 1;
  return fixed;
}

void expect_dense(System& system, const Eigen::Matrix3Xd& x, Projection projection, const Dense& dense) {
  Eigen::Matrix3Xd gradient;
  BlockMatrix matrix;
  const Evaluation at = system.hessian(x, projection, gradient, matrix);
  EXPECT_NEAR(at.value, dense.value, 1e-12 * (1 + std::abs(dense.value)));
  EXPECT_NEAR(system.value(x).value, dense.value, 1e-12 * (1 + std::abs(dense.value)));
  EXPECT_LT(difference(to_dense(matrix), dense.free_hessian(some_fixed())), 1e-12);
  EXPECT_LT(difference(gradient.reshaped(), dense.gradient), 1e-12);
  system.gradient(x, gradient);
  EXPECT_LT(difference(gradient.reshaped(), dense.gradient), 1e-12);
  EXPECT_EQ(at.indefinite, dense.indefinite);
}

// `rest`, values per stencil, is the law's only raw data; `params` its values.
template <class Law>
void combinations_agree(int points, const std::string& rest, const Parameters& params) {
  SCOPED_TRACE(std::string(Law::kName) + " over " + std::to_string(points));
  constexpr int vectors = Law::kVectors;
  for (const int width : {1, 4, 8}) {
    if (width > lanes::best_lanes()) continue;
    Points p;
    System system(kVertices);
    system.set_fixed(some_fixed());
    system.add(Potential::on_combinations("law", kernel_of<Law>(width), points, params));
    for (const int count : {37, 3, 61}) {
      const std::vector<int> stencils = p.stencils(count, points);
      const std::vector<double> weights = p.numbers(stencils.size() * vectors);
      const std::vector<double> data = p.numbers(static_cast<size_t>(count * Law::kRaw));
      system.potential(0).set_combinations(stencils, weights, rest.empty() ? StencilData{} : StencilData{{rest, data}});
      std::vector<double> values;
      for (const auto& param : params) values.insert(values.end(), param.second.begin(), param.second.end());
      for (const Projection projection : {Projection::clamp, Projection::absolute, Projection::none}) {
        Dense dense(kVertices);
        for (int s = 0; s < count; ++s) {
          const Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>> w(
              weights.data() + s * vectors * points, vectors, points);
          dense.add<Law>(p.x, stencils.data() + s * points, w, 1, data.data() + s * Law::kRaw, values.data(),
                         projection);
        }
        expect_dense(system, p.x, projection, dense);
      }
    }
  }
}

TEST(PotentialCombinations, AgreeWithTheDenseSum) {
  for (const int points : {1, 2, 3, 4}) combinations_agree<AnchoredLaw>(points, "X3", {});
  for (const int points : {2, 5}) combinations_agree<BendLaw>(points, "", {});
  for (const int points : {4, 8, 12}) combinations_agree<HingeLaw>(points, "area", {{"k", {2.5}}});
  combinations_agree<QuadrupleLaw>(6, "", {});
}

// A point against the middle of an edge, a million metres from the origin: the difference keeps the digits that the
// positions have.
TEST(PotentialCombinations, OfNoSumKeepTheirDigitsFarAway) {
  Eigen::Matrix3Xd x(3, 4);
  x << 1e6, 1e6, 1e6, 1e6,  //
      0, 0, 0, 0,           //
      0, 1e-3, 3e-3, 0;
  x.row(0).array() += 0.125;
  System system(4);
  system.add(Potential::on_combinations("law", kernel_of<InertiaLaw>(1), 3, {}));
  const double w = 1.0 / 3;
  system.potential(0).set_combinations({0, 1, 2}, {1, -w, w - 1}, {{"mass", {2}}});
  system.potential(0).set_lag("dt", {1});
  system.potential(0).set_lag("xhat", {0, 0, 0});
  Eigen::Matrix3Xd gradient;
  system.gradient(x, gradient);
  EXPECT_EQ(gradient(0, 0), 0);
  EXPECT_NEAR(gradient(2, 0), -2 * (1e-3 * w + 3e-3 * (1 - w)), 1e-17);
}

TEST(PotentialCombinations, RefuseWhatDoesNotFit) {
  const Kernel hinge = kernel_of<HingeLaw>(1);
  EXPECT_EQ(message_of([&] {
              Potential::on_combinations("law", hinge, 13, {{"k", {1}}});
            }),
            "potential 'law': combinations of 13 points; 1 to 12 can be evaluated");
  EXPECT_EQ(message_of([&] { Potential::on_combinations("law", kernel_of<NeoHookeanLaw>(1), 3, {}); }),
            "potential 'law': neo is a density: it needs a mesh, not stencils");
  Potential two = Potential::on_combinations("law", hinge, 2, {{"k", {1}}});
  EXPECT_EQ(two.points_per_stencil(), 2);
  const auto refusal = [&](const std::vector<int>& stencils, size_t weights, const StencilData& rest) {
    return message_of([&] { two.set_combinations(stencils, std::vector<double>(weights, 1.0), rest); });
  };
  EXPECT_EQ(refusal({0, 1, 2, 3}, 6, {}),
            "potential 'law': combinations of 4 vertices and 3 vectors in q take 12 weights, got 6");
  EXPECT_EQ(refusal({0, 1, 2}, 9, {}), "potential 'law': 3 vertices do not make whole stencils of 2 points");
  EXPECT_EQ(refusal({0, -1}, 6, {}), "potential 'law': stencil 0 names vertex -1; vertices are 0 to the system's last");
  EXPECT_EQ(refusal({0, 1}, 6, {}), "potential 'law': rest 'area' of hinge is missing; give 1 value per stencil");
  EXPECT_THROW(two.set_stencils({0, 1}, Eigen::Matrix3Xd::Zero(3, 2), {}), std::logic_error);
  Potential spring = Potential::on_combinations("law", kernel_of<SpringLaw>(1), 2, {{"k", {1}}});
  EXPECT_EQ(message_of([&] {
              spring.set_combinations({0, 1}, {1, -1}, {});
            }),
            "potential 'law': rest 'X0' of spring is missing; give 3 values per stencil");
  two.set_combinations({0, 7}, std::vector<double>(6, 1.0), {{"area", {1}}});
  System system(5);
  EXPECT_EQ(message_of([&] { system.add(two); }), "potential 'law' names vertex 7; the system has vertices 0 to 4");
}

template <class Law>
void used_points_agree(const std::vector<int>& used) {
  for (const int width : {1, 4, 8}) {
    if (width > lanes::best_lanes()) continue;
    Points p;
    const std::vector<int> all = p.stencils(53, 4);
    std::vector<int> few;
    std::vector<double> rest;
    for (size_t s = 0; s < all.size(); s += 4) {
      for (const int a : used) few.push_back(all[s + static_cast<size_t>(a)]);
      if (Law::kRaw > 0) rest.insert(rest.end(), p.x.col(all[s + 3]).begin(), p.x.col(all[s + 3]).end());
    }
    Dense dense(kVertices);
    dense.add_stencils<Law>(p.x, all, rest, {}, Projection::clamp);
    for (const bool whole : {true, false}) {
      const auto make = whole ? Potential::on_stencils : Potential::on_used_points;
      System system(kVertices);
      system.set_fixed(some_fixed());
      system.add(make("law", kernel_of<Law>(width), whole ? all : few, p.x, {}, {}));
      EXPECT_EQ(system.potential(0).points_per_stencil(), static_cast<int>(whole ? 4 : used.size()));
      EXPECT_EQ(system.potential(0).stencils(), whole ? all : few);
      expect_dense(system, p.x, Projection::clamp, dense);
    }
  }
}

TEST(PotentialUsedPoints, AgreeWithTheDenseSum) {
  used_points_agree<AnchoredLaw>({0, 3});
  used_points_agree<CrossLaw>({0, 1, 2, 3});
}

TEST(PotentialUsedPoints, OthersMakeNoCouplings) {
  const Points p;
  System system(kVertices);
  system.add(Potential::on_stencils("law", kernel_of<AnchoredLaw>(1), {0, 1, 2, 3}, p.x, {}, {}));
  Eigen::Matrix3Xd gradient;
  BlockMatrix matrix;
  system.hessian(p.x, Projection::clamp, gradient, matrix);
  EXPECT_EQ(matrix.blocks(), kVertices + 1u);
  EXPECT_GE(matrix.index_of(3, 0), 0);
}

TEST(PotentialUsedPoints, RestOfAPointThatIsNotListedIsGiven) {
  const Points p;
  EXPECT_EQ(message_of([&] {
              Potential::on_used_points("law", kernel_of<ElsewhereLaw>(1), {0, 3}, p.x, {}, {});
            }),
            "potential 'law': rest 'X1' of anchored is missing; give 3 values per stencil");
  System given(kVertices), found(kVertices);
  const std::vector<double> rest(p.x.col(1).begin(), p.x.col(1).end());
  given.add(Potential::on_used_points("law", kernel_of<ElsewhereLaw>(1), {0, 3}, p.x, {}, {{"X1", rest}}));
  found.add(Potential::on_stencils("law", kernel_of<ElsewhereLaw>(1), {0, 1, 2, 3}, p.x, {}, {}));
  EXPECT_NE(given.value(p.x).value, 0);
  EXPECT_EQ(given.value(p.x).value, found.value(p.x).value);
}

TEST(PotentialUsedPoints, ListsInAnyOrderTakeTheirOwnData) {
  Points p;
  const std::vector<int> stencils = p.stencils(200, 1);
  std::vector<double> mass = p.numbers(200), hats = p.numbers(600), data;
  for (size_t s = 0; s < 200; ++s) {
    data.insert(data.end(), {mass[s], 0.5, hats[3 * s], hats[3 * s + 1], hats[3 * s + 2]});
  }
  for (const int width : {1, lanes::best_lanes()}) {
    System system(kVertices);
    system.set_fixed(some_fixed());
    system.add(Potential::on_stencils("law", kernel_of<InertiaLaw>(width), stencils, p.x, {}, {{"mass", mass}}));
    system.potential(0).set_lag("dt", {0.5});
    system.potential(0).set_lag("xhat", hats);
    Dense dense(kVertices);
    dense.add_stencils<InertiaLaw>(p.x, stencils, data, {}, Projection::none);
    expect_dense(system, p.x, Projection::none, dense);
  }
}

TEST(PotentialLists, AskForNoMemoryOnceTheyWereThisLong) {
  Points p;
  const std::vector<int> longest = p.stencils(300, 4), shorter = p.stencils(200, 4);
  const std::vector<double> weights = p.numbers(3 * longest.size()), fewer = p.numbers(3 * shorter.size());
  const StencilData areas{{"area", p.numbers(300)}}, few_areas{{"area", p.numbers(200)}};
  const Parameters k{{"k", {1}}};
  Potential plain = Potential::on_stencils("law", kernel_of<HingeLaw>(1), longest, p.x, k, areas);
  Potential combined = Potential::on_combinations("law", kernel_of<HingeLaw>(1), 4, k);
  combined.set_combinations(longest, weights, areas);
  const long before = allocations();
  for (int i = 0; i < 3; ++i) {
    plain.set_stencils(i == 1 ? longest : shorter, p.x, i == 1 ? areas : few_areas);
    combined.set_combinations(i == 1 ? longest : shorter, i == 1 ? weights : fewer, i == 1 ? areas : few_areas);
  }
  EXPECT_EQ(allocations(), before);
}

}  // namespace
}  // namespace ergon
