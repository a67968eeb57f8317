// The vector code of contact at every width that this machine has.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>
#include <set>

#include "runtime/contact/distance.h"
#include "runtime/lanes/distances.h"
#include "runtime/lanes/lanes.h"
#include "runtime/lanes/overlaps.h"

namespace ergon {
namespace {

using Eigen::Vector3d;

std::vector<int> widths() {
  std::vector<int> some;
  for (const int width : lanes::kWidths) {
    if (width <= lanes::best_lanes()) some.push_back(width);
  }
  return some;
}

class ContactLanes : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(contact, ContactLanes, ::testing::ValuesIn(widths()), ::testing::PrintToStringParamName());

// Four vertices for each of many pairs; on a coarse grid most of them are degenerate in some way.
Eigen::Matrix3Xd positions(int pairs, bool grid, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  Eigen::Matrix3Xd x(3, 4 * pairs);
  for (double& each : x.reshaped()) each = grid ? std::round(1.4 * unit(random)) : unit(random);
  return x;
}

// Far from the least of several distances that a part was chosen by.
double tolerance(const Eigen::Matrix3Xd& x, int first) { return 1e-14 * (1 + x.middleCols(first, 4).squaredNorm()); }

TEST_P(ContactLanes, PointTriangleDistancesAreThoseOfOnePair) {
  constexpr int count = 101;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const bool grid = seed % 2 == 1;
    const Eigen::Matrix3Xd x = positions(count, grid, seed);
    int points[count], triangles[count][3], pairs[count][2];
    for (int i = 0; i < count; ++i) {
      points[i] = 4 * i;
      for (int k = 0; k < 3; ++k) triangles[i][k] = 4 * i + 1 + k;
      pairs[i][0] = pairs[i][1] = i;
    }
    lanes::DistanceRoom room;
    lanes::distance_operations(GetParam()).point_triangle(x.data(), points, triangles, pairs, count, room);
    for (int i = 0; i < count; ++i) {
      const Vector3d p = x.col(4 * i), a = x.col(4 * i + 1), b = x.col(4 * i + 2), c = x.col(4 * i + 3);
      const PointTriangleDistance d = point_triangle_distance(p, a, b, c);
      const bool degenerate = a == b || b == c || c == a;
      if (!(room.gap2[i] >= 0)) {
        EXPECT_TRUE(degenerate || d.gap2 < 1e-10) << seed << " " << i;
        continue;
      }
      EXPECT_FALSE(degenerate) << seed << " " << i;
      EXPECT_NEAR(room.gap2[i], d.gap2, tolerance(x, 4 * i)) << seed << " " << i;
      if (!grid) {
        EXPECT_EQ(room.part[i], d.part) << seed << " " << i;
      }
    }
  }
}

TEST_P(ContactLanes, EdgeEdgeDistancesAreThoseOfOnePair) {
  constexpr int count = 127;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const bool grid = seed % 2 == 1;
    const Eigen::Matrix3Xd x = positions(count, grid, seed);
    int edges[2 * count][2], pairs[count][2];
    for (int i = 0; i < 2 * count; ++i) edges[i][0] = 2 * i, edges[i][1] = 2 * i + 1;
    for (int i = 0; i < count; ++i) pairs[i][0] = 2 * i, pairs[i][1] = 2 * i + 1;
    lanes::DistanceRoom room;
    lanes::distance_operations(GetParam()).edge_edge(x.data(), edges, pairs, count, room);
    for (int i = 0; i < count; ++i) {
      const Vector3d a0 = x.col(4 * i), a1 = x.col(4 * i + 1), b0 = x.col(4 * i + 2), b1 = x.col(4 * i + 3);
      const EdgeEdgeDistance d = edge_edge_distance(a0, a1, b0, b1);
      EXPECT_NEAR(room.sine2[i], (a1 - a0).cross(b1 - b0).squaredNorm(), tolerance(x, 4 * i));
      const bool degenerate = a0 == a1 || b0 == b1;
      if (!(room.gap2[i] >= 0)) {
        EXPECT_TRUE(degenerate || d.gap2 < 1e-10) << seed << " " << i;
        continue;
      }
      EXPECT_FALSE(degenerate) << seed << " " << i;
      EXPECT_NEAR(room.gap2[i], d.gap2, tolerance(x, 4 * i)) << seed << " " << i;
      if (!grid) {
        EXPECT_EQ(room.part[i], d.part_a + 4 * d.part_b) << seed << " " << i;
      }
    }
  }
}

std::vector<lanes::BoxLeaf> random_leaves(int corners, int count, std::mt19937& random) {
  std::uniform_int_distribution<int> position(0, 60), size(0, 12), vertex(0, 25), number(9, 16);
  std::vector<lanes::BoxLeaf> leaves(static_cast<size_t>(count));
  int id = 0;
  for (lanes::BoxLeaf& leaf : leaves) {
    leaf = {};
    leaf.count = number(random);
    for (int k = 0; k < 3; ++k) {
      leaf.lowest[k] = 1000, leaf.highest[k] = -1000;
      for (int i = 0; i < lanes::kLeaf; ++i) {
        const bool there = i < leaf.count;
        leaf.lower[k][i] = there ? position(random) : std::numeric_limits<int>::max();
        leaf.upper[k][i] = there ? leaf.lower[k][i] + size(random) : std::numeric_limits<int>::min();
        leaf.vertex[k][i] = there && k < corners ? vertex(random) : -1;
        if (!there) continue;
        leaf.lowest[k] = std::min(leaf.lowest[k], leaf.lower[k][i]);
        leaf.highest[k] = std::max(leaf.highest[k], leaf.upper[k][i]);
      }
    }
    for (int i = 0; i < leaf.count; ++i) {
      leaf.id[i] = id++;
      leaf.moving |= (random() % 3 != 0 ? 1u : 0u) << i;
    }
  }
  return leaves;
}

struct Kind {
  int corners_a, corners_b;
  bool same;
};

TEST_P(ContactLanes, OverlapsAreThoseOfAllPairsOneByOne) {
  std::mt19937 random(5);
  for (const Kind kind : {Kind{1, 3, false}, Kind{2, 2, true}, Kind{1, 2, false}, Kind{1, 1, true}}) {
    const auto a = random_leaves(kind.corners_a, 12, random);
    const auto b = kind.same ? a : random_leaves(kind.corners_b, 9, random);
    lanes::OverlapTask task{
        a.data(), kind.same ? a.data() : b.data(), kind.corners_a, kind.corners_b, kind.same, {-3, 0, 0}, {0, 0, 2}};
    if (kind.same) task.shift_lower[0] = task.shift_upper[2] = 0;
    const bool shares = (kind.corners_a == 1 && kind.corners_b == 3) || kind.corners_a == 2;
    std::vector<lanes::LeafPair> pairs;
    std::set<std::array<int, 2>> expected;
    for (int i = 0; i < static_cast<int>(a.size()); ++i) {
      for (int j = kind.same ? i : 0; j < static_cast<int>(b.size()); ++j) {
        pairs.push_back({i, j});
        const lanes::BoxLeaf &la = a[static_cast<size_t>(i)], &lb = b[static_cast<size_t>(j)];
        for (int p = 0; p < la.count; ++p) {
          for (int q = kind.same && i == j ? p + 1 : 0; q < lb.count; ++q) {
            bool meet = (la.moving >> p & 1u) != 0 || (lb.moving >> q & 1u) != 0;
            for (int k = 0; k < 3; ++k) {
              meet = meet && la.lower[k][p] <= lb.upper[k][q] + task.shift_upper[k] &&
                     lb.lower[k][q] + task.shift_lower[k] <= la.upper[k][p];
              for (int l = 0; l < 3 && shares; ++l) {
                meet = meet && (la.vertex[k][p] < 0 || la.vertex[k][p] != lb.vertex[l][q]);
              }
            }
            if (meet) expected.insert({la.id[p], lb.id[q]});
          }
        }
      }
    }
    // Room for a few leaves at a time.
    std::vector<lanes::IdPair> out(1000);
    std::set<std::array<int, 2>> found;
    long done = 0;
    size_t written = 0;
    while (done < static_cast<long>(pairs.size())) {
      long n = 0;
      const long now = lanes::overlap_operations(GetParam())
                           .overlaps(task, pairs.data() + done, static_cast<long>(pairs.size()) - done, out.data(),
                                     static_cast<long>(out.size()), &n);
      ASSERT_GT(now, 0);
      done += now;
      written += static_cast<size_t>(n);
      for (long i = 0; i < n; ++i) found.insert({out[static_cast<size_t>(i)].a, out[static_cast<size_t>(i)].b});
    }
    EXPECT_EQ(found, expected);
    EXPECT_EQ(found.size(), written);
    EXPECT_GT(found.size(), 50u);
  }
}

}  // namespace
}  // namespace ergon
