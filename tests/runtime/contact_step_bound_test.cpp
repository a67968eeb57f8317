#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <random>

#include "runtime/contact/ccd.h"
#include "runtime/contact/step_bound.h"
#include "runtime/lanes/lanes.h"
#include "runtime/lanes/steps.h"
#include "runtime/predicates.h"
#include "tests/runtime/count_allocations.h"
#include "tools/contact_cases.h"

namespace ergon {
namespace {

using Eigen::Vector3d;

// Triangles and points in layers, every point with every triangle of the next layer.
struct Layers {
  CollisionSurface surface;
  Candidates candidates;
  Eigen::Matrix3Xd x, direction;
};

Layers random_layers(unsigned seed, double speed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Layers l;
  constexpr int kTriangles = 400;
  const Eigen::Index count = 3 * kTriangles;
  l.x.resize(3, count);
  l.direction.resize(3, count);
  for (int t = 0; t < kTriangles; ++t) {
    const Vector3d at(uniform(random), uniform(random), 0.1 * t);
    for (int k = 0; k < 3; ++k) {
      const int v = 3 * t + k;
      l.x.col(v) = at + Vector3d(uniform(random), uniform(random), 0.01 * uniform(random));
      l.direction.col(v) = speed * Vector3d(uniform(random), uniform(random), uniform(random));
      l.surface.points.push_back(v);
      l.surface.edges.push_back({v, 3 * t + (k + 1) % 3});
      l.surface.object.push_back(t % 2);
      l.surface.moving.push_back(1);
    }
    l.surface.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  l.surface.radius = {0.002, 0.003};
  l.surface.meet = {{1, 1}, {1, 1}};
  l.surface.names = {"even", "odd"};
  for (int t = 0; t + 1 < kTriangles; ++t) {
    for (int i = 0; i < 3; ++i) {
      l.candidates.point_triangle.push_back({3 * t + i, t + 1});
      for (int j = 0; j < 3; ++j) l.candidates.edge_edge.push_back({3 * t + i, 3 * t + 3 + j});
      l.candidates.point_edge.push_back({3 * t + i, 3 * t + 3 + i});
      l.candidates.point_point.push_back({3 * t + i, 3 * t + 3 + i});
    }
  }
  return l;
}

double smallest_of_single(const Layers& l, double kept) {
  double step = 1;
  const auto bound = [&](const std::vector<int>& v, size_t second, double (*of)(const CcdQuery&)) {
    std::vector<Vector3d> at, motion;
    for (const int i : v) {
      at.push_back(l.x.col(i));
      motion.push_back(l.direction.col(i));
    }
    const auto object = [&](size_t k) { return l.surface.object[static_cast<size_t>(v[k])]; };
    step = std::min(step, of({at.data(), motion.data(), l.surface.offset(object(0), object(second)), kept}));
  };
  const auto edge = [&](int e) { return l.surface.edges[static_cast<size_t>(e)]; };
  for (const auto& [p, t] : l.candidates.point_triangle)
    bound({p, 3 * t, 3 * t + 1, 3 * t + 2}, 1, point_triangle_step);
  for (const auto& [a, b] : l.candidates.edge_edge) {
    bound({edge(a)[0], edge(a)[1], edge(b)[0], edge(b)[1]}, 2, edge_edge_step);
  }
  for (const auto& [p, e] : l.candidates.point_edge) bound({p, edge(e)[0], edge(e)[1]}, 1, point_edge_step);
  for (const auto& [p, q] : l.candidates.point_point) bound({p, q}, 1, point_point_step);
  return step;
}

TEST(ContactStepBound, IsTheSmallestStepOfAllPairs) {
  int free = 0, bounded = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Layers l = random_layers(seed, seed % 4 == 0 ? 1e-3 : 0.05 * (seed % 4));
    const double step = largest_step(l.surface, l.candidates, l.x, l.direction, 0.1);
    const double expected = smallest_of_single(l, 0.1);
    // A pair that is seen to be far off at once may go further than one that is followed.
    EXPECT_NEAR(step, expected, 1e-3 * expected) << seed;
    ++(step == 1 ? free : bounded);
  }
  EXPECT_GT(free, 0);
  EXPECT_GT(bounded, 5);
}

TEST(ContactStepBound, IsTheSameForAnyNumberOfThreads) {
  const int before = omp_get_max_threads();
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Layers l = random_layers(seed, 0.1);
    omp_set_num_threads(1);
    const double one = largest_step(l.surface, l.candidates, l.x, l.direction);
    for (const int threads : {2, 3, 7}) {
      omp_set_num_threads(threads);
      EXPECT_EQ(largest_step(l.surface, l.candidates, l.x, l.direction), one) << threads;
    }
  }
  omp_set_num_threads(before);
}

TEST(ContactStepBound, AllocatesNothing) {
  const Layers l = random_layers(1, 0.1);
  largest_step(l.surface, l.candidates, l.x, l.direction);
  const long before = testing::allocations();
  const double step = largest_step(l.surface, l.candidates, l.x, l.direction);
  EXPECT_EQ(testing::allocations(), before);
  EXPECT_LT(step, 1);
}

// A point that is driven into a triangle again and again: its gap falls to a tenth each time, until rounding the
// position would decide on which side it is.
TEST(ContactStepBound, EndsBeforeRoundedPositionsPassThrough) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const double size = std::pow(10.0, 3 * uniform(random));
    Layers l;
    l.x.resize(3, 4);
    l.x << 0, 1, -1, 0, 0, 0, 0, 1, 1, 0, 0, 0;
    for (Eigen::Index v = 0; v < 4; ++v)
      l.x.col(v) += Vector3d(3, 2, 1) + 0.2 * Vector3d(uniform(random), uniform(random), uniform(random));
    l.x *= size;
    const Vector3d inside = (l.x.col(1) + l.x.col(2) + l.x.col(3)) / 3;
    l.x.col(0) = inside + 1e-2 * (l.x.col(0) - inside);
    l.surface.points = {0, 1, 2, 3};
    l.surface.edges = {{1, 2}, {2, 3}, {1, 3}};
    l.surface.triangles = {{1, 2, 3}};
    l.surface.object = {0, 1, 1, 1};
    l.surface.moving = {1, 1, 1, 1};
    l.surface.radius = {0, 0};
    l.surface.meet = {{1, 1}, {1, 1}};
    l.candidates.point_triangle = {{0, 0}};
    const auto side = [&] { return orientation(l.x.col(1), l.x.col(2), l.x.col(3), l.x.col(0)); };
    const int before = side();
    ASSERT_NE(before, 0);
    int steps = 0;
    while (true) {
      l.direction = Eigen::Matrix3Xd::Zero(3, 4);
      for (Eigen::Index v = 0; v < 4; ++v)
        l.direction.col(v) = 1e-3 * size * Vector3d(uniform(random), uniform(random), uniform(random));
      l.direction.col(0) += 2 * (inside - l.x.col(0));
      const double step = largest_step(l.surface, l.candidates, l.x, l.direction);
      if (!(step > 0) || ++steps == 100) break;
      l.x += step * l.direction;
      ASSERT_EQ(side(), before) << trial << ", after step " << steps;
    }
    EXPECT_GT(steps, 3);
  }
}

TEST(ContactStepBound, WithoutCandidatesNothingBoundsTheStep) {
  const Layers l = random_layers(1, 1);
  EXPECT_EQ(largest_step(l.surface, {}, l.x, l.direction), 1);
}

// What one vector width says to be free is free: the step of each pair by itself is not below the bound.
class StepLanes : public ::testing::TestWithParam<int> {};

TEST_P(StepLanes, LeaveEveryPairThatIsNotFree) {
  const int lanes = GetParam();
  if (lanes > lanes::best_lanes()) GTEST_SKIP() << "this machine has no " << lanes << " lanes";
  const lanes::StepOperations& operations = lanes::step_operations(lanes);
  ContactCases cases(1);
  lanes::StepRoom room;
  int left_of_free = 0, free_pairs = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const bool edges = trial % 2 == 0;
    const int count = trial % 7 == 0 ? 3 : lanes::kSteps;
    const double kept = cases.uniform(0.05, 0.5), at_most = cases.uniform(0.1, 1);
    std::vector<FourPoints> x, m;
    Eigen::Matrix3Xd all_x(3, 4 * count), all_m(3, 4 * count);
    std::vector<int> points;
    std::vector<std::array<int, 2>> ends, pairs;
    std::vector<std::array<int, 3>> triangles;
    for (int i = 0; i < count; ++i) {
      const int kind =
          cases.integer(0, edges ? ContactCases::kEdgeEdgeKinds - 1 : ContactCases::kPointTriangleKinds - 1);
      x.push_back(edges ? cases.edge_edge(kind) : cases.point_triangle(kind));
      m.push_back(cases.motion(cases.integer(0, ContactCases::kMotionKinds - 1), x.back(), edges ? 2 : 1));
      if (trial % 4 < 2) {
        const ContactCases::Moving moving = cases.near_contact(edges);
        x.back() = moving.x;
        m.back() = moving.motion;
      }
      for (int k = 0; k < 4; ++k) {
        all_x.col(4 * i + k) = x.back()[static_cast<size_t>(k)];
        all_m.col(4 * i + k) = m.back()[static_cast<size_t>(k)];
      }
      points.push_back(4 * i);
      triangles.push_back({4 * i + 1, 4 * i + 2, 4 * i + 3});
      ends.push_back({4 * i, 4 * i + 1});
      ends.push_back({4 * i + 2, 4 * i + 3});
      if (edges) pairs.push_back({2 * i, 2 * i + 1});
      if (!edges) pairs.push_back({i, i});
      room.separation[i] = trial % 3 == 0 ? 1e-4 : 0;
    }
    const lanes::StepTask task{all_x.data(), all_m.data(), kept, at_most};
    const auto* list = reinterpret_cast<const int(*)[2]>(pairs.data());
    const int left =
        edges ? operations.edge_edge(task, reinterpret_cast<const int(*)[2]>(ends.data()), list, count, room)
              : operations.point_triangle(task, points.data(), reinterpret_cast<const int(*)[3]>(triangles.data()),
                                          list, count, room);
    for (int i = 0, next = 0; i < count; ++i) {
      const auto at = static_cast<size_t>(i);
      const CcdQuery query{x[at].data(), m[at].data(), room.separation[i], kept, at_most};
      const double step = edges ? edge_edge_step(query) : point_triangle_step(query);
      if (next < left && room.left[next] == i) {
        ++next;
        left_of_free += step == at_most ? 1 : 0;
        continue;
      }
      ++free_pairs;
      EXPECT_NEAR(step, at_most, 1e-3 * at_most) << trial << " " << i;
    }
  }
  EXPECT_GT(free_pairs, 5000);
  EXPECT_LT(left_of_free, 10000);
}

INSTANTIATE_TEST_SUITE_P(Widths, StepLanes, ::testing::Values(1, 2, 4, 8));

}  // namespace
}  // namespace ergon
