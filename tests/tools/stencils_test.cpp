#include "tools/stencils.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

namespace ergon {
namespace {

// Where p lies over its triangle, in barycentric coordinates of the projection along z.
TEST(Stencils, SamplePointsProjectIntoTheirTriangles) {
  const auto [mesh, stencils] = sample_stencils("point_triangle", 4);
  EXPECT_EQ(stencils.size() / 4, 2u * 4u * 16u);  // cells*cells of each neighbour in both directions
  for (size_t s = 0; s < stencils.size(); s += 4) {
    auto at = [&](size_t i) -> Eigen::Vector2d { return mesh.X.col(stencils[s + i]).head<2>(); };
    Eigen::Matrix2d edges;
    edges << at(2) - at(1), at(3) - at(1);
    EXPECT_GT(edges.determinant(), 0);
    const Eigen::Vector2d beta = edges.inverse() * (at(0) - at(1));
    EXPECT_GT(beta.minCoeff(), 0.1);
    EXPECT_LT(beta.sum(), 0.9);
    EXPECT_NEAR(std::abs(mesh.X(2, stencils[s]) - mesh.X(2, stencils[s + 1])), 0.25, 1e-12);
  }
}

TEST(Stencils, SampleEdgesCross) {
  const auto [mesh, stencils] = sample_stencils("edge_edge", 4);
  EXPECT_EQ(stencils.size() / 4, 2u * 4u * 16u);
  for (size_t s = 0; s < stencils.size(); s += 4) {
    auto at = [&](size_t i) -> Eigen::Vector2d { return mesh.X.col(stencils[s + i]).head<2>(); };
    Eigen::Matrix2d edges;
    edges << at(1) - at(0), at(2) - at(3);
    const Eigen::Vector2d along = edges.inverse() * (at(2) - at(0));
    EXPECT_GT(along.minCoeff(), 0.1);
    EXPECT_LT(along.maxCoeff(), 0.9);
  }
}

TEST(Stencils, EveryGeometryHasASample) {
  for (const char* geometry : {"point", "edge", "corner", "point_point", "triangle", "point_edge", "tetrahedron",
                               "hinge", "shell_triangle", "rod_corner", "point_triangle", "edge_edge"}) {
    EXPECT_FALSE(sample_stencils(geometry, 2).stencils.empty()) << geometry;
  }
}

}  // namespace
}  // namespace ergon
