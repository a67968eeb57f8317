#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <random>

#include "runtime/contact/ccd.h"
#include "runtime/contact/step_bound.h"
#include "tests/runtime/count_allocations.h"

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

TEST(ContactStepBound, WithoutCandidatesNothingBoundsTheStep) {
  const Layers l = random_layers(1, 1);
  EXPECT_EQ(largest_step(l.surface, {}, l.x, l.direction), 1);
}

}  // namespace
}  // namespace ergon
