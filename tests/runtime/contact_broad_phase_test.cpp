#include "runtime/contact/broad_phase.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Geometry>
#include <set>

#include "tests/runtime/contact_oracle.h"
#include "tests/runtime/contact_soup.h"
#include "tests/runtime/count_allocations.h"
#include "tests/runtime/mesh_helpers.h"

namespace ergon {
namespace {

using Eigen::Matrix3Xd;
// The sizes of the lists, after checking that each pair is in `allowed`, once, and that all of `needed` are.
std::array<size_t, 4> expect_lists(const Candidates& candidates, const std::array<Pairs, 4>& needed,
                                   const std::array<Pairs, 4>& allowed) {
  const std::vector<std::array<int, 2>>* lists[] = {&candidates.point_triangle, &candidates.edge_edge,
                                                    &candidates.point_edge, &candidates.point_point};
  std::array<size_t, 4> sizes{};
  for (size_t kind = 0; kind < 4; ++kind) {
    const Pairs listed(lists[kind]->begin(), lists[kind]->end());
    sizes[kind] = listed.size();
    EXPECT_EQ(listed.size(), lists[kind]->size()) << "listed twice, kind " << kind;
    EXPECT_TRUE(std::includes(listed.begin(), listed.end(), needed[kind].begin(), needed[kind].end()))
        << "kind " << kind;
    EXPECT_TRUE(std::includes(allowed[kind].begin(), allowed[kind].end(), listed.begin(), listed.end()))
        << "kind " << kind;
  }
  return sizes;
}

void expect_covered(const Soup& soup, double reach, double motion) {
  const PairOracle oracle(soup.surface);
  const auto all = oracle.all();
  BroadPhase broad(soup.surface);
  const Matrix3Xd x1 = noise(soup.x, motion, 7);
  EXPECT_TRUE(broad.cover(soup.x, x1, reach));
  const auto sizes = expect_lists(broad.candidates(), oracle.near(soup.x, x1, reach), all);
  for (size_t kind = 0; kind < 4; ++kind) {
    EXPECT_LE(sizes[kind], all[kind].size());
  }
}

TEST(BroadPhase, FindsEveryPairWithinReachAtRest) {
  for (unsigned seed = 1; seed < 6; ++seed) expect_covered(make_soup({.seed = seed}), 0.05, 0);
}

TEST(BroadPhase, FindsEveryPairWithinReachOfAMotion) {
  for (unsigned seed = 1; seed < 4; ++seed) expect_covered(make_soup({.seed = seed}), 0.01, 0.3);
}

TEST(BroadPhase, AddsTheThicknessOfBoth) { expect_covered(make_soup({.radius = {0.02, 0, 0.05, 0.01}}), 0.01, 0.05); }

TEST(BroadPhase, LeavesOutPairsOfWhichNothingMoves) {
  for (const double resting : {0.5, 0.9, 1.0}) expect_covered(make_soup({.resting = resting}), 0.05, 0.02);
}

TEST(BroadPhase, LeavesOutObjectsThatMayNotMeet) {
  for (const auto& [a, b] : {std::array{0, 0}, {0, 1}, {0, 2}, {2, 3}, {3, 3}, {1, 3}}) {
    Soup soup = make_soup({});
    const auto i = static_cast<size_t>(a), j = static_cast<size_t>(b);
    soup.surface.meet[i][j] = soup.surface.meet[j][i] = 0;
    expect_covered(soup, 0.05, 0.02);
  }
}

TEST(BroadPhase, FindsEveryPairFarFromTheOrigin) { expect_covered(make_soup({.offset = 1e6}), 0.05, 0.1); }

// A body that flies through others, turning: pairs of its own are no more than at rest.
TEST(BroadPhase, FollowsObjectsInFlight) {
  const Soup soup = make_soup({});
  const PairOracle oracle(soup.surface);
  Matrix3Xd x1 = soup.x;
  const auto of = [&](int v) { return soup.surface.object[static_cast<size_t>(v)]; };
  const Eigen::AngleAxisd turn(0.05, Eigen::Vector3d(1, 2, 3).normalized());
  for (int v = 0; v < x1.cols(); ++v) {
    if (of(v) == 1) x1.col(v) = turn * x1.col(v) + Eigen::Vector3d(4, 3, 2);
    if (of(v) == 2) x1.col(v) += Eigen::Vector3d(0, 0, -5);
  }
  BroadPhase broad(soup.surface), resting(soup.surface);
  broad.cover(soup.x, x1, 0.05);
  resting.cover(soup.x, soup.x, 0.05);
  expect_lists(broad.candidates(), oracle.near(soup.x, x1, 0.05), oracle.all());
  const auto own = [&](const BroadPhase& phase, int object) {
    return std::count_if(phase.candidates().edge_edge.begin(), phase.candidates().edge_edge.end(),
                         [&](const auto& pair) {
                           return of(soup.surface.edges[static_cast<size_t>(pair[0])][0]) == object &&
                                  of(soup.surface.edges[static_cast<size_t>(pair[1])][0]) == object;
                         });
  };
  EXPECT_LT(own(broad, 1), 2 * own(resting, 1) + 20);
  EXPECT_LT(own(broad, 2), 2 * own(resting, 2) + 20);
  // States and motions along the way are covered already.
  for (const double s : {0.0, 0.3, 1.0}) {
    const Matrix3Xd x = soup.x + s * (x1 - soup.x);
    EXPECT_FALSE(broad.cover(x, x, 0.05)) << s;
    EXPECT_FALSE(broad.cover(x, x1, 0.05)) << s;
  }
  const Matrix3Xd beyond = soup.x + 1.5 * (x1 - soup.x);
  EXPECT_TRUE(broad.cover(beyond, beyond, 0.05));
}

TEST(BroadPhase, KeepsAListForAsLongAsItIsGood) {
  const Soup soup = make_soup({.noise = 0.1, .resting = 0.2, .radius = {0, 0.01, 0.02, 0}});
  const PairOracle oracle(soup.surface);
  const auto all = oracle.all();
  BroadPhase broad(soup.surface);
  Matrix3Xd x = soup.x;
  int kept = 0;
  for (unsigned n = 0; n < 24; ++n) {
    // Steps of contact become smaller until the next begins.
    const Matrix3Xd next = noise(x, 0.02 / (1 + n % 6), n);
    const double reach = n % 2 == 0 ? 0.02 : 0.001;
    if (!broad.cover(x, next, reach)) ++kept;
    expect_lists(broad.candidates(), oracle.near(x, next, reach), all);
    x = next;
  }
  EXPECT_GT(kept, 10);
  EXPECT_LT(kept, 24);
  EXPECT_FALSE(broad.cover(x, x, 0.001));
  x(1, soup.surface.points[7]) += 3;
  EXPECT_TRUE(broad.cover(x, x, 0.001));
}

// Of points alone boxes are all there is between the list and the distance.
TEST(BroadPhase, MissesNoPointThatDriftsIntoReach) {
  Mesh grains;
  grains.element = Element::point;
  grains.X = 0.5 * noise(Matrix3Xd::Zero(3, 400), 0.5, 1);
  grains.X.bottomRows(2) *= 1e-3;  // nearly along a line, so that distances are those along an axis of the boxes
  Matrix3Xd step = noise(Matrix3Xd::Zero(3, 400), 0.0005, 2);
  step.bottomRows(2).setZero();
  for (int v = 0; v < 400; ++v) grains.cells.push_back(v);
  const CollisionSurface surface = make_surface({{"grains", &grains, 0, 0.002}}, std::vector<char>(400, 1));
  BroadPhase broad(surface);
  const double reach = 0.02, touching = reach + surface.offset(0, 0);
  Matrix3Xd x = grains.X;
  int kept = 0, near = 0;
  for (int n = 0; n < 150; ++n) {
    const Matrix3Xd next = x + step;
    kept += !broad.cover(x, next, reach);
    x = next;
    const Pairs listed(broad.candidates().point_point.begin(), broad.candidates().point_point.end());
    for (int p = 0; p < 400; ++p) {
      for (int q = p + 1; q < 400; ++q) {
        if ((x.col(p) - x.col(q)).norm() >= touching) continue;
        ++near;
        EXPECT_TRUE(listed.contains({p, q})) << p << " " << q;
      }
    }
    EXPECT_LT(listed.size(), 20000u);
  }
  EXPECT_GT(kept, 50);
  EXPECT_LT(kept, 150);
  EXPECT_GT(near, 1000);
}

TEST(BroadPhase, SkipsObjectsThatAreApart) {
  Soup soup = make_soup({.resting = 0.1});
  const PairOracle oracle(soup.surface);
  for (int v = 0; v < soup.x.cols(); ++v) soup.x(2, v) += 3 * soup.surface.object[static_cast<size_t>(v)];
  BroadPhase broad(soup.surface);
  broad.cover(soup.x, soup.x, 0.05);
  const auto sizes = expect_lists(broad.candidates(), oracle.near(soup.x, soup.x, 0.05), oracle.all());
  EXPECT_EQ(sizes[2], 0u);
  for (const auto& [p, t] : broad.candidates().point_triangle) {
    EXPECT_EQ(soup.surface.object[static_cast<size_t>(soup.surface.points[static_cast<size_t>(p)])],
              soup.surface.object[static_cast<size_t>(soup.surface.triangles[static_cast<size_t>(t)][0])]);
  }
}

// The tree is made anew when neighbours have gone apart.
TEST(BroadPhase, KeepsItsListsShortHoweverObjectsDeform) {
  const Soup soup = make_soup({.cells = 12, .noise = 0.1});
  BroadPhase broad(soup.surface), fresh(soup.surface);
  broad.cover(soup.x, soup.x, 0.01);
  Matrix3Xd x = soup.x;
  for (int v = 0; v < x.cols(); ++v)
    x.col(v) = Eigen::Vector3d(std::fmod(7 * x(0, v), 1), x(2, v), std::fmod(5 * x(1, v), 1));
  broad.cover(x, x, 0.01);
  fresh.cover(x, x, 0.01);
  const PairOracle oracle(soup.surface);
  const auto needed = oracle.near(x, x, 0.01), all = oracle.all();
  const auto sizes = expect_lists(broad.candidates(), needed, all),
             of_fresh = expect_lists(fresh.candidates(), needed, all);
  for (size_t kind = 0; kind < 4; ++kind) EXPECT_LE(sizes[kind], 1.5 * static_cast<double>(of_fresh[kind]) + 10);
}

TEST(BroadPhase, GivesTheSameListForAnyNumberOfThreads) {
  const Soup soup = make_soup({.cells = 70});
  const Matrix3Xd x1 = noise(soup.x, 0.005, 3);
  const int threads = omp_get_max_threads();
  std::vector<Candidates> lists;
  for (const int n : {1, 2, 5}) {
    omp_set_num_threads(n);
    BroadPhase broad(soup.surface);
    broad.cover(soup.x, x1, 0.002);
    lists.push_back(broad.candidates());
  }
  omp_set_num_threads(threads);
  for (const Candidates& list : lists) {
    EXPECT_EQ(list.point_triangle, lists[0].point_triangle);
    EXPECT_EQ(list.edge_edge, lists[0].edge_edge);
    EXPECT_EQ(list.point_edge, lists[0].point_edge);
    EXPECT_EQ(list.point_point, lists[0].point_point);
    EXPECT_GT(list.edge_edge.size(), 10000u);
  }
}

TEST(BroadPhase, AsksForNoMemoryOnceItHasRun) {
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const Soup soup = make_soup({});
  const Matrix3Xd states[] = {soup.x, noise(soup.x, 0.1, 4)};
  BroadPhase broad(soup.surface);
  // Slack settles at its largest within a few lists.
  for (int n = 0; n < 20; ++n) EXPECT_TRUE(broad.cover(states[n % 2], states[n % 2], 0.02));
  const long before = testing::allocations();
  for (int n = 0; n < 20; ++n) EXPECT_TRUE(broad.cover(states[n % 2], states[n % 2], 0.02));
  EXPECT_EQ(testing::allocations(), before);
  omp_set_num_threads(threads);
}

TEST(BroadPhase, NamesAVertexWithoutPosition) {
  Soup soup = make_soup({});
  soup.x(1, 17) = std::numeric_limits<double>::quiet_NaN();
  BroadPhase broad(soup.surface);
  EXPECT_EQ(message_of([&] { broad.cover(soup.x, soup.x, 0.02); }), "vertex 17 has no finite position");
}

}  // namespace
}  // namespace ergon
