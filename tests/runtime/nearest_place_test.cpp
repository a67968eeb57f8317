#include "runtime/mesh/nearest_place.h"

#include <gtest/gtest.h>

#include <random>

#include "runtime/contact/distance.h"
#include "runtime/mesh/mesh_tools.h"
#include "runtime/mesh/shapes.h"

namespace ergon {
namespace {

// Every answer against all triangles, and against all points.
TEST(NearestPlace, IsTheNearestOfAll) {
  const Mesh ball = sphere_surface(1.0, 6);
  const std::vector<std::array<int, 3>> triangles = surface_triangles(ball);
  std::vector<std::array<int, 3>> points;
  for (int v = 0; v < ball.vertices(); ++v) points.push_back({v, v, v});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-1.5, 1.5);
  for (const auto& parts : {triangles, points}) {
    const PlaceSearch search(ball.X, parts);
    for (int i = 0; i < 300; ++i) {
      const Eigen::Vector3d x(coordinate(random), coordinate(random), coordinate(random));
      double least = 1e9;
      for (const auto& t : parts)
        least = std::min(
            least, std::sqrt(point_triangle_distance(x, ball.X.col(t[0]), ball.X.col(t[1]), ball.X.col(t[2])).gap2));
      const NearPlace found = search.nearest(x);
      EXPECT_EQ(found.distance, least);
      EXPECT_NEAR((search.position(found) - x).norm(), least, 1e-14);
      EXPECT_NEAR(found.weights[0] + found.weights[1] + found.weights[2], 1, 1e-14);
    }
  }
  EXPECT_EQ(PlaceSearch(ball.X, {}).nearest({0, 0, 0}).part, -1);
}

// A vertex of the ball belongs to five or six triangles: the first of them is taken.
TEST(NearestPlace, OfSeveralIsTheFirst) {
  const Mesh ball = sphere_surface(1.0, 3);
  const std::vector<std::array<int, 3>> triangles = surface_triangles(ball);
  const PlaceSearch search(ball.X, triangles);
  for (int v = 0; v < ball.vertices(); ++v) {
    const NearPlace found = search.nearest(ball.X.col(v));
    int first = 0;
    while (std::find(triangles[static_cast<size_t>(first)].begin(), triangles[static_cast<size_t>(first)].end(), v) ==
           triangles[static_cast<size_t>(first)].end())
      ++first;
    EXPECT_EQ(found.distance, 0);
    EXPECT_EQ(found.part, first);
  }
}

}  // namespace
}  // namespace ergon
