#include "tools/stencils.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "runtime/error.h"
#include "tools/sample.h"

namespace ergon {
namespace {

TEST(Stencils, EdgesAreFoundOnceEach) {
  // Euler's formula on the brick cut in six: 8 vertices, 19 edges (12 of the brick, 6 face diagonals, 1 inside).
  EXPECT_EQ(stencils_on_mesh("edge", sample_mesh(Element::tet4, 1)).size(), 2u * 19u);
  EXPECT_EQ(stencils_on_mesh("edge", sample_mesh(Element::hex8, 1)).size(), 2u * 12u);
  EXPECT_EQ(stencils_on_mesh("point", sample_mesh(Element::tet4, 1)).size(), 8u);
}

TEST(Stencils, AGeometryThatAMeshDoesNotHaveIsBadInput) {
  try {
    stencils_on_mesh("body_pair", sample_mesh(Element::tet4, 1));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "no stencils 'body_pair' can be made from a mesh; 'point', 'edge', 'triangle', 'hinge' and 'tetrahedron' can");
  }
}

TEST(Stencils, CellsMustBeOfTheirElement) {
  EXPECT_EQ(stencils_on_mesh("tetrahedron", sample_mesh(Element::tet4, 2)).size(), 4u * 6u * 8u);
  EXPECT_EQ(stencils_on_mesh("triangle", sample_mesh(Element::tri3, 2)).size(), 3u * 8u);
  try {
    stencils_on_mesh("hinge", sample_mesh(Element::tet4, 1));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "'hinge' stencils are made from a mesh of Tri3 elements; this one has Tet4");
  }
}

TEST(Stencils, HingesAreFlatOnAFlatSheetAndFoldedUpwardsByTheirLastPoint) {
  const Mesh mesh = sample_mesh(Element::tri3, 2);
  const std::vector<int> hinges = stencils_on_mesh("hinge", mesh);
  ASSERT_EQ(hinges.size(), 4u * 8u);  // 16 edges, 8 of them on the border
  for (size_t h = 0; h < hinges.size(); h += 4) {
    auto at = [&](size_t i) -> Eigen::Vector3d { return mesh.X.col(hinges[h + i]); };
    const Eigen::Vector3d e = at(1) - at(0), a = at(2) - at(0), b = at(3) - at(0);
    EXPECT_GT(e.cross(a).z(), 0);
    EXPECT_GT(b.cross(e).z(), 0);
  }
}

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
  for (const char* geometry : {"point", "edge", "point_point", "triangle", "point_edge", "tetrahedron", "hinge",
                               "point_triangle", "edge_edge"}) {
    EXPECT_FALSE(sample_stencils(geometry, 2).stencils.empty()) << geometry;
  }
}

}  // namespace
}  // namespace ergon
