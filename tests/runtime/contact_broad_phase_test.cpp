#include "runtime/contact/broad_phase.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <set>

#include "tests/runtime/contact_oracle.h"
#include "tests/runtime/contact_soup.h"
#include "tests/runtime/count_allocations.h"

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

}  // namespace
}  // namespace ergon
