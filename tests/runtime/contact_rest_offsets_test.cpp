// Objects thicker than their edges are long.
#include "runtime/contact/rest_offsets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "runtime/contact/active_set.h"
#include "runtime/contact/broad_phase.h"
#include "runtime/contact/make_surface.h"
#include "runtime/contact/step_bound.h"
#include "runtime/mesh/curve.h"
#include "runtime/mesh/mesh_build.h"
#include "tests/runtime/contact_oracle.h"

namespace ergon {
namespace {

constexpr double dhat = 0.05;

// A sheet of edges of 0.25, a rod of edges of 0.2 that crosses above it, and loose points 0.3 apart, each of which is
// 0.8 thick.
struct Thick {
  Thick() {
    Mesh sheet = alternating_triangles(Element::tri3, {1.5, 1, 1}, {6, 4, 1}),
         rod = line_mesh(smooth_curve({{0, 0.5, 2}, {2, 0.4, 2}}, false, 10), false),
         loose = point_mesh({{0, 0, 4}, {0.3, 0, 4}, {0.6, 0.1, 4}, {5, 0, 4}});
    int first = 0;
    std::vector<CollisionObject> objects;
    for (auto [name, mesh] : {std::pair("sheet", &sheet), std::pair("rod", &rod), std::pair("loose", &loose)}) {
      X.conservativeResize(3, first + mesh->vertices());
      X.rightCols(mesh->vertices()) = mesh->X;
      objects.push_back({name, mesh, first, 0.4});
      first += mesh->vertices();
    }
    surface = make_surface(objects, std::vector<char>(static_cast<size_t>(first), 1));
    lower_offsets(surface, X, dhat);
  }
  double offset(int kind, int i, int j, const std::vector<int>& a, const std::vector<int>& b) const {
    return surface.offset(static_cast<RestOffsets::Kind>(kind), {i, j}, a[0], b[0]);
  }
  CollisionSurface surface;
  Eigen::Matrix3Xd X;
};

double distance(const PairOracle& oracle, const CollisionSurface& s, int kind, const std::vector<int>& a,
                const std::vector<int>& b, const Eigen::Matrix3Xd& x) {
  return oracle.gap(kind, a, b, x) + s.offset(s.object[static_cast<size_t>(a[0])], s.object[static_cast<size_t>(b[0])]);
}

TEST(ContactRestOffsets, PairsOfAnObjectMayComeHalfAsNearAsAtRest) {
  const Thick thick;
  const PairOracle oracle(thick.surface);
  int lowered[4] = {};
  oracle.each([&](int kind, int i, int j, const std::vector<int>& a, const std::vector<int>& b) {
    const double d = distance(oracle, thick.surface, kind, a, b, thick.X), found = thick.offset(kind, i, j, a, b);
    const bool same =
        thick.surface.object[static_cast<size_t>(a[0])] == thick.surface.object[static_cast<size_t>(b[0])];
    const double expected = same && d < 0.8 + dhat ? std::max(0.0, std::min(d / 2, d - dhat)) : 0.8;
    EXPECT_LE(found, expected + 1e-12);
    EXPECT_GE(found, expected - 0.8 / 1024 - 1e-12);
    lowered[kind] += found < 0.8;
  });
  for (const int kind : {0, 1, 3}) EXPECT_GT(lowered[kind], 2) << kind;  // a point and an edge are of two objects
}

TEST(ContactRestOffsets, NoBarrierActsAtRest) {
  const Thick thick;
  BroadPhase broad(thick.surface);
  broad.cover(thick.X, thick.X, dhat);
  ActiveSet active;
  find_active(thick.surface, broad.candidates(), thick.X, thick.X, dhat, active);
  EXPECT_GE(active.smallest_gap, dhat);
  for (const ActiveList* list : {&active.point_point, &active.point_edge, &active.point_triangle, &active.edge_edge})
    EXPECT_EQ(list->count(), 0u);
}

// The sheet rolled up, so that parts near and far at rest are near each other.
TEST(ContactRestOffsets, EveryPairIsFoundWithItsOwnOffset) {
  const Thick thick;
  Eigen::Matrix3Xd x = thick.X;
  for (int v = 0; v < x.cols(); ++v) {
    if (thick.surface.object[static_cast<size_t>(v)] != 0) continue;
    const double turn = x(0, v) / 0.25, radius = 0.25 + 0.01 * x(0, v);
    x.col(v) = Eigen::Vector3d(radius * std::sin(turn), x(1, v) * (1 + 0.1 * x(0, v)), 1 - radius * std::cos(turn));
  }
  const PairOracle oracle(thick.surface);
  double pairs = 0, smallest = 1;
  oracle.each([&](int kind, int i, int j, const std::vector<int>& a, const std::vector<int>& b) {
    const double gap = distance(oracle, thick.surface, kind, a, b, x) - thick.offset(kind, i, j, a, b);
    pairs += gap < dhat;
    smallest = std::min(smallest, gap);
  });
  ASSERT_GT(pairs, 50);
  BroadPhase broad(thick.surface);
  broad.cover(x, x, dhat);
  ActiveSet active;
  find_active(thick.surface, broad.candidates(), x, thick.X, dhat, active);
  double found = 0;
  int lowered = 0;
  for (const ActiveList* list : {&active.point_point, &active.point_edge, &active.point_triangle, &active.edge_edge,
                                 &active.parallel_point_edge, &active.parallel_point_point}) {
    ASSERT_EQ(list->offset.size(), list->count());
    found += std::accumulate(list->multiplicity.begin(), list->multiplicity.end(), 0.0);
    for (const double offset : list->offset) lowered += offset < 0.8;
  }
  EXPECT_EQ(found, pairs);
  EXPECT_GT(lowered, 10);
  EXPECT_NEAR(active.smallest_gap, smallest, 1e-12);
}

TEST(ContactRestOffsets, StepsStopBeforeALoweredOffset) {
  const Thick thick;
  Eigen::Matrix3Xd direction = -thick.X;  // all shrinks to one point
  BroadPhase broad(thick.surface);
  broad.cover(thick.X, thick.X + direction, 0);
  const double step = largest_step(thick.surface, broad.candidates(), thick.X, direction);
  EXPECT_GT(step, 0.01);
  EXPECT_LT(step, 0.5);  // pairs that are near may come half as near as at rest
  const PairOracle oracle(thick.surface);
  const Eigen::Matrix3Xd x = thick.X + step * direction;
  oracle.each([&](int kind, int i, int j, const std::vector<int>& a, const std::vector<int>& b) {
    EXPECT_GT(distance(oracle, thick.surface, kind, a, b, x), thick.offset(kind, i, j, a, b));
  });
}

TEST(ContactRestOffsets, ThinObjectsHaveNone) {
  Thick thick;
  thick.surface.radius = {0.0, 0.0, 0.0};
  lower_offsets(thick.surface, thick.X, dhat);
  EXPECT_TRUE(thick.surface.rest_offsets.empty());
  thick.surface.radius = {0.05, 0, 0};  // edges of 0.25 are longer than that and dhat
  lower_offsets(thick.surface, thick.X, dhat);
  EXPECT_TRUE(thick.surface.rest_offsets.empty());
}

}  // namespace
}  // namespace ergon
