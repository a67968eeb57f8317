#include "runtime/contact/active_set.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <set>

#include "runtime/contact/area_weights.h"
#include "runtime/mesh/mesh_build.h"
#include "tests/runtime/contact_oracle.h"
#include "tests/runtime/contact_soup.h"
#include "tests/runtime/count_allocations.h"

namespace ergon {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr int kCases = 6;
using Counts = std::map<std::vector<int>, double>;

std::array<const ActiveList*, kCases> lists_of(const ActiveSet& active) {
  return {&active.point_point, &active.point_edge,          &active.point_triangle,
          &active.edge_edge,   &active.parallel_point_edge, &active.parallel_point_point};
}

std::vector<int> stencil_of(const ActiveList& list, size_t n) {
  const auto first = list.vertices.begin() + static_cast<std::ptrdiff_t>(n) * list.points;
  return {first, first + list.points};
}

std::array<Counts, kCases> counts_of(const ActiveSet& active) {
  std::array<Counts, kCases> counts;
  for (size_t k = 0; k < kCases; ++k) {
    const ActiveList& list = *lists_of(active)[k];
    EXPECT_EQ(list.vertices.size(), list.count() * static_cast<size_t>(list.points));
    EXPECT_EQ(list.offset.size(), list.count());
    for (size_t n = 0; n < list.count(); ++n) {
      EXPECT_TRUE(counts[k].emplace(stencil_of(list, n), list.multiplicity[n]).second) << "twice in case " << k;
    }
  }
  return counts;
}

bool nearly_parallel(const std::vector<int>& a, const std::vector<int>& b, const Matrix3Xd& x, const Matrix3Xd& X) {
  const auto along = [](const Matrix3Xd& at, const std::vector<int>& e) -> Vector3d {
    return at.col(e[1]) - at.col(e[0]);
  };
  return along(x, a).cross(along(x, b)).squaredNorm() < 1e-3 * along(X, a).squaredNorm() * along(X, b).squaredNorm();
}

// The same by looking at all pairs.
struct Expected {
  std::array<Counts, kCases> counts;
  double smallest_gap = std::numeric_limits<double>::infinity();

  void add_point(int p, std::vector<int> part) {
    std::sort(part.begin(), part.end());
    std::vector<int> stencil{p};
    stencil.insert(stencil.end(), part.begin(), part.end());
    if (part.size() == 1) std::sort(stencil.begin(), stencil.end());
    counts[part.size() - 1][stencil] += 1;
  }
};

Expected expected_of(const CollisionSurface& surface, const Matrix3Xd& x, const Matrix3Xd& X, double dhat) {
  const PairOracle oracle(surface);
  Expected expected;
  oracle.each([&](int kind, int, int, const std::vector<int>& a, const std::vector<int>& b) {
    const double gap = oracle.gap(kind, a, b, x);
    expected.smallest_gap = std::min(expected.smallest_gap, gap);
    if (gap >= dhat) return;
    const auto at = [&](int v) -> Vector3d { return x.col(v); };
    const auto parts = [](const std::vector<int>& of, unsigned mask) {
      std::vector<int> found;
      for (size_t i = 0; i < of.size(); ++i) {
        if ((mask >> i & 1u) != 0) found.push_back(of[i]);
      }
      return found;
    };
    if (kind == 3) return expected.add_point(a[0], b);
    if (kind == 2) return expected.add_point(a[0], parts(b, point_edge_distance(at(a[0]), at(b[0]), at(b[1])).part));
    if (kind == 0) {
      const unsigned part = point_triangle_distance(at(a[0]), at(b[0]), at(b[1]), at(b[2])).part;
      if (part == 7) {
        expected.counts[2][{a[0], b[0], b[1], b[2]}] += 1;
      } else {
        expected.add_point(a[0], parts(b, part));
      }
      return;
    }
    const EdgeEdgeDistance d = edge_edge_distance(at(a[0]), at(a[1]), at(b[0]), at(b[1]));
    const auto from = [](const std::vector<int>& e, unsigned part) {
      return part == 2 ? std::vector<int>{e[1], e[0]} : e;
    };
    std::vector<int> ea = from(a, d.part_a), eb = from(b, d.part_b);
    if (d.part_a == 3 && d.part_b != 3) ea.swap(eb);
    const std::vector<int> four{ea[0], ea[1], eb[0], eb[1]};
    const bool inside = d.part_a == 3 && d.part_b == 3, ends = d.part_a != 3 && d.part_b != 3;
    if (inside) {
      expected.counts[3][four] += 1;
    } else if (nearly_parallel(a, b, x, X)) {
      expected.counts[ends ? 5 : 4][four] += 1;
    } else {
      expected.add_point(ea[0], ends ? std::vector<int>{eb[0]} : std::vector<int>{eb[0], eb[1]});
    }
  });
  return expected;
}

ActiveSet active_at(const CollisionSurface& surface, const Matrix3Xd& x, const Matrix3Xd& X, double dhat) {
  BroadPhase broad(surface);
  broad.cover(x, x, dhat);
  ActiveSet active;
  find_active(surface, broad.candidates(), x, X, dhat, active);
  return active;
}

void expect_active(const Soup& soup, double dhat) {
  const ActiveSet active = active_at(soup.surface, soup.x, soup.x, dhat);
  const Expected expected = expected_of(soup.surface, soup.x, soup.x, dhat);
  const auto counts = counts_of(active);
  for (size_t k = 0; k < kCases; ++k) EXPECT_EQ(counts[k], expected.counts[k]) << "case " << k;
  if (expected.smallest_gap < dhat) {
    EXPECT_NEAR(active.smallest_gap, expected.smallest_gap, 1e-15);
  } else {
    EXPECT_GE(active.smallest_gap, dhat);
  }
}

TEST(ActiveSet, HoldsEveryPairWithinDhatOnceWithItsMultiplicity) {
  for (unsigned seed = 1; seed < 6; ++seed) {
    for (const double dhat : {0.01, 0.1}) expect_active(make_soup({.seed = seed}), dhat);
  }
}

// Without noise edges are parallel and vertices above vertices.
TEST(ActiveSet, HoldsEveryCaseOfAlignedObjects) {
  const Soup soup = make_soup({.noise = 0});
  expect_active(soup, 0.15);
  const ActiveSet active = active_at(soup.surface, soup.x, soup.x, 0.3);
  EXPECT_GT(active.parallel_point_edge.count() + active.parallel_point_point.count(), 0u);
}

TEST(ActiveSet, AddsTheThicknessOfBoth) {
  const Soup soup = make_soup({.radius = {0.02, 0, 0.05, 0.01}});
  expect_active(soup, 0.03);
  const ActiveSet active = active_at(soup.surface, soup.x, soup.x, 0.03);
  for (const ActiveList* list : lists_of(active)) {
    for (size_t n = 0; n < list->count(); ++n) {
      const std::vector<int> v = stencil_of(*list, n);
      const auto object = [&](int i) { return soup.surface.object[static_cast<size_t>(i)]; };
      EXPECT_EQ(list->offset[n], soup.surface.offset(object(v.front()), object(v.back())));
    }
  }
}

TEST(ActiveSet, LeavesOutWhatRestsAndWhatMayNotMeet) {
  Soup soup = make_soup({.resting = 0.7});
  soup.surface.meet[0][1] = soup.surface.meet[1][0] = 0;
  expect_active(soup, 0.1);
}

TEST(ActiveSet, DoesNotDependOnOtherCandidates) {
  const Soup soup = make_soup({.noise = 0.05});
  const ActiveSet few = active_at(soup.surface, soup.x, soup.x, 0.08);
  BroadPhase broad(soup.surface);
  broad.cover(soup.x, noise(soup.x, 0.5, 1), 0.3);
  ActiveSet many;
  find_active(soup.surface, broad.candidates(), soup.x, soup.x, 0.08, many);
  for (size_t k = 0; k < kCases; ++k) {
    EXPECT_EQ(lists_of(few)[k]->vertices, lists_of(many)[k]->vertices);
    EXPECT_EQ(lists_of(few)[k]->multiplicity, lists_of(many)[k]->multiplicity);
  }
  EXPECT_EQ(few.smallest_gap, many.smallest_gap);
}

TEST(ActiveSet, IsTheSameForAnyNumberOfThreads) {
  const Soup soup = make_soup({.cells = 70});
  const int threads = omp_get_max_threads();
  std::vector<ActiveSet> sets;
  for (const int n : {1, 2, 7}) {
    omp_set_num_threads(n);
    sets.push_back(active_at(soup.surface, soup.x, soup.x, 0.005));
  }
  omp_set_num_threads(threads);
  for (const ActiveSet& set : sets) {
    for (size_t k = 0; k < kCases; ++k) EXPECT_EQ(lists_of(set)[k]->vertices, lists_of(sets[0])[k]->vertices);
    EXPECT_EQ(set.smallest_gap, sets[0].smallest_gap);
    EXPECT_GT(set.edge_edge.count(), 500u);
  }
}

TEST(ActiveSet, AsksForNoMemoryOnceItHasRun) {
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const Soup soup = make_soup({});
  const Matrix3Xd other = noise(soup.x, 0.01, 4);
  BroadPhase broad(soup.surface);
  broad.cover(soup.x, other, 0.1);
  ActiveSet active;
  find_active(soup.surface, broad.candidates(), soup.x, soup.x, 0.1, active);
  find_active(soup.surface, broad.candidates(), other, soup.x, 0.05, active);
  const long before = testing::allocations();
  find_active(soup.surface, broad.candidates(), soup.x, soup.x, 0.1, active);
  EXPECT_EQ(testing::allocations(), before);
  EXPECT_GT(active.edge_edge.count(), 10u);
  omp_set_num_threads(threads);
}

TEST(ActiveSet, IsEmptyWithoutCandidates) {
  const Soup soup = make_soup({});
  ActiveSet active = active_at(soup.surface, soup.x, soup.x, 0.1);
  find_active(soup.surface, {}, soup.x, soup.x, 0.1, active);
  for (const ActiveList* list : lists_of(active)) EXPECT_EQ(list->count(), 0u);
  EXPECT_EQ(active.smallest_gap, std::numeric_limits<double>::infinity());
}

// The barrier summed over an active set by the formulas of its cases.
double energy_of(const ActiveSet& active, const Matrix3Xd& x, const Matrix3Xd& X, double dhat) {
  double sum = 0;
  for (size_t k = 0; k < kCases; ++k) {
    const ActiveList& list = *lists_of(active)[k];
    for (size_t n = 0; n < list.count(); ++n) {
      const std::vector<int> v = stencil_of(list, n);
      const auto at = [&](size_t i) -> Vector3d { return x.col(v[i]); };
      const auto to_line = [&](size_t p, size_t a, size_t b) {
        return (at(p) - at(a)).cross(at(b) - at(a)).squaredNorm() / (at(b) - at(a)).squaredNorm();
      };
      const auto along = [&](const Vector3d& from, const Vector3d& normal) {
        return std::pow(from.dot(normal), 2) / normal.squaredNorm();
      };
      double gap2 = 0, faded = 1;
      if (k == 0) gap2 = (at(0) - at(1)).squaredNorm();
      if (k == 1) gap2 = to_line(0, 1, 2);
      if (k == 2) gap2 = along(at(0) - at(1), (at(2) - at(1)).cross(at(3) - at(1)));
      if (k == 3) gap2 = along(at(0) - at(2), (at(1) - at(0)).cross(at(3) - at(2)));
      if (k == 4) gap2 = to_line(0, 2, 3);
      if (k == 5) gap2 = (at(0) - at(2)).squaredNorm();
      if (k >= 3) {
        const double lengths = (X.col(v[1]) - X.col(v[0])).squaredNorm() * (X.col(v[3]) - X.col(v[2])).squaredNorm();
        const double y = std::min(1000 * (at(1) - at(0)).cross(at(3) - at(2)).squaredNorm() / lengths, 1.0);
        faded = y * (2 - y);
      }
      const double d2 = dhat * dhat;
      sum -= list.multiplicity[n] * faded * (gap2 - d2) * (gap2 - d2) * std::log(gap2 / d2);
    }
  }
  return sum;
}

// Where the lists change on the way from state(0) to state(1), the energy on both sides is compared. Returns how often
// that was, and which cases occurred.
template <class State>
std::pair<int, std::set<size_t>> expect_continuous(const CollisionSurface& surface, const Matrix3Xd& X, double dhat,
                                                   int samples, const State& state) {
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);  // there is little to do, many times
  BroadPhase broad(surface);
  broad.cover(noise(X, 3, 1), noise(X, 3, 2), 1);  // nearly all pairs
  const auto active = [&](double s) {
    ActiveSet set;
    find_active(surface, broad.candidates(), state(s), X, dhat, set);
    return set;
  };
  const auto energy = [&](double s) { return energy_of(active(s), state(s), X, dhat); };
  std::set<size_t> seen;
  int changes = 0;
  for (int n = 0; n < samples; ++n) {
    double s = n / static_cast<double>(samples);
    const double end = (n + 1) / static_cast<double>(samples);
    const auto at_end = counts_of(active(end));
    for (auto now = counts_of(active(s)); now != at_end; now = counts_of(active(s))) {
      double low = s, high = end;
      while (high - low > 1e-13) {
        const double middle = low + (high - low) / 2;
        (counts_of(active(middle)) == now ? low : high) = middle;
      }
      EXPECT_NEAR(energy(low), energy(high), 1e-9 * energy(low) + 1e-12) << "at " << low;
      ++changes;
      s = high;
    }
    for (size_t k = 0; k < kCases; ++k) {
      if (!at_end[k].empty()) seen.insert(k);
    }
  }
  omp_set_num_threads(threads);
  return {changes, seen};
}

void expect_continuous_soup(bool weighted) {
  Soup soup = make_soup({.cells = 2, .loose = 6, .noise = 0.03});
  if (weighted) weight_by_area(soup.surface, soup.x, 0.1);
  const auto [changes, seen] = expect_continuous(soup.surface, soup.x, 0.1, 12, [&](double time) {
    const double s = 0.3 + 0.3 * time;
    Matrix3Xd x = soup.x;
    for (int v = 0; v < x.cols(); ++v) {
      const int object = soup.surface.object[static_cast<size_t>(v)];
      if (object == 0) continue;
      const Eigen::AngleAxisd turn(0.6 * (s - 0.5) * object, Vector3d(1, 0.3 * object, 0.2).normalized());
      x.col(v) = turn * x.col(v) + s * Vector3d(0.07 * object, 0.11, 0.13 - 0.05 * object);
    }
    return x;
  });
  EXPECT_GT(changes, 60);
  for (size_t k = 0; k < 4; ++k) EXPECT_TRUE(seen.contains(k)) << k;
}

TEST(ActiveSet, TheEnergyIsContinuousWhereNearestPartsChange) { expect_continuous_soup(false); }

TEST(ActiveSet, TheWeightedEnergyIsContinuousWhereNearestPartsChange) { expect_continuous_soup(true); }

// Two sheets of side 1 and n cells per side at half dhat, one turned over the other: the barrier's energy per unit of
// stiffness.
double energy_of_sheets(int n, bool weighted) {
  constexpr double dhat = 1e-3;
  const Mesh sheet = box_mesh(Element::tri3, {1, 1, 1}, {n, n, 1});
  const int count = sheet.vertices();
  CollisionSurface surface = make_surface({{"a", &sheet, 0, 0}, {"b", &sheet, count, 0}},
                                          std::vector<char>(2 * static_cast<size_t>(count), 1));
  Matrix3Xd x(3, 2 * count);
  const Eigen::AngleAxisd turn(0.3, Vector3d::UnitZ());
  x << sheet.X, (turn.toRotationMatrix() * sheet.X).colwise() + Vector3d(0.1, -0.2, dhat / 2);
  if (weighted) weight_by_area(surface, x, dhat);
  return energy_of(active_at(surface, x, x, dhat), x, x, dhat);
}

TEST(ActiveSet, WeightedByAreaTheEnergyDoesNotGrowWithTheMesh) {
  const double coarse = energy_of_sheets(8, true), fine = energy_of_sheets(24, true);
  EXPECT_NEAR(fine / coarse, 1, 0.1);
  EXPECT_GT(energy_of_sheets(24, false) / energy_of_sheets(8, false), 7);
}

TEST(ActiveSet, AreasAreThoseOfTheSurface) {
  const Mesh sheet = box_mesh(Element::tri3, {1, 1, 1}, {3, 2, 1}),
             rod = box_mesh(Element::edge2, {1, 1, 1}, {4, 1, 1});
  const int count = sheet.vertices();
  Matrix3Xd X(3, count + 5);
  X << sheet.X, rod.X;
  CollisionSurface surface = make_surface({{"sheet", &sheet, 0, 0}, {"rod", &rod, count, 0.01}},
                                          std::vector<char>(static_cast<size_t>(X.cols()), 1));
  EXPECT_EQ(mean_weights(surface), (std::vector<double>{1, 1}));
  weight_by_area(surface, X, 1e-3);
  double points = 0, edges = 0;
  for (const double w : surface.point_weight) points += w;
  for (const double w : surface.edge_weight) edges += w;
  EXPECT_NEAR(points, (1 + 0.02) / 4, 1e-12);  // the sheet's area and that of a strip of 20 mm
  EXPECT_NEAR(edges, (1 + 0.02) / 2, 1e-12);
  EXPECT_NEAR(mean_weights(surface)[0], 1.0 / 4 / count, 1e-12);
}

// Two rods slide along each other and swing through parallel.
TEST(ActiveSet, TheEnergyIsContinuousWhereEdgesBecomeParallel) {
  const Mesh rod = box_mesh(Element::edge2, {1, 1, 1}, {3, 1, 1});
  const CollisionSurface surface = make_surface({{"a", &rod, 0, 0}, {"b", &rod, 4, 0}}, std::vector<char>(8, 1));
  Matrix3Xd X(3, 8);
  X << rod.X, rod.X;
  const auto [changes, seen] = expect_continuous(surface, X, 0.1, 100, [&](double s) {
    Matrix3Xd x = X;
    const Eigen::AngleAxisd swing(0.06 * std::sin(25 * s), Vector3d(0, 0.8, 0.6));
    x.rightCols(4) = (swing.toRotationMatrix() * X.rightCols(4)).colwise() + Vector3d(2 * s - 1, 0.02, 0.06);
    return x;
  });
  EXPECT_GT(changes, 50);
  EXPECT_TRUE(seen.contains(4));
  EXPECT_TRUE(seen.contains(5));
  EXPECT_TRUE(seen.contains(3));
}

}  // namespace
}  // namespace ergon
