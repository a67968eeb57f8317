#include "runtime/contact/active_set.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>

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

}  // namespace
}  // namespace ergon
