#include "runtime/mesh/mesh_stencils.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <set>

#include "runtime/error.h"
#include "runtime/mesh/curve.h"
#include "runtime/mesh/edge_normals.h"
#include "runtime/mesh/mesh_build.h"
#include "runtime/mesh/rod_frames.h"

namespace ergon {
namespace {

Mesh box(Element element, int cells) { return box_mesh(element, {1, 1, 1}, {cells, cells, cells}); }

std::string error_of(std::string_view kind, const Mesh& mesh) {
  try {
    stencils_on_mesh(kind, mesh);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(mesh_stencils, edges_are_found_once_each) {
  // Euler's formula on the brick cut in six: 8 vertices, 19 edges (12 of the brick, 6 face diagonals, 1 inside).
  EXPECT_EQ(stencils_on_mesh("edge", box(Element::tet4, 1)).size(), 2u * 19u);
  EXPECT_EQ(stencils_on_mesh("edge", box(Element::hex8, 1)).size(), 2u * 12u);
  EXPECT_EQ(stencils_on_mesh("point", box(Element::tet4, 1)).size(), 8u);
}

TEST(mesh_stencils, cells_must_be_of_their_element) {
  EXPECT_EQ(stencils_on_mesh("tetrahedron", box(Element::tet4, 2)).size(), 4u * 6u * 8u);
  EXPECT_EQ(stencils_on_mesh("triangle", box(Element::tri3, 2)).size(), 3u * 8u);
  EXPECT_EQ(error_of("hinge", box(Element::quad4, 1)),
            "'hinge' stencils are made from a mesh of Tri3 elements; this one has Quad4");
  EXPECT_EQ(error_of("body_pair", box(Element::tet4, 1)),
            "no stencils 'body_pair' can be made from a mesh; it has point, edge, corner, triangle, tetrahedron, "
            "hinge, patch, shell_triangle, rod_corner");
}

TEST(mesh_stencils, kinds_follow_from_the_element) {
  using Kinds = std::vector<std::string>;
  EXPECT_EQ(stencil_kinds(Element::point), (Kinds{"point"}));
  EXPECT_EQ(stencil_kinds(Element::edge2), (Kinds{"point", "edge", "corner", "rod_corner"}));
  EXPECT_EQ(stencil_kinds(Element::tri3), (Kinds{"point", "edge", "triangle", "hinge", "patch", "shell_triangle"}));
  EXPECT_EQ(stencil_kinds(Element::quad4), (Kinds{"point", "edge"}));
  EXPECT_EQ(stencil_kinds(Element::tet4), (Kinds{"point", "edge", "tetrahedron"}));
}

TEST(mesh_stencils, hinges_are_flat_on_a_flat_sheet_and_folded_upwards_by_their_last_point) {
  for (const Mesh& mesh : {box(Element::tri3, 2), alternating_triangles(Element::tri3, {1, 1, 1}, {2, 2, 1})}) {
    const std::vector<int> hinges = stencils_on_mesh("hinge", mesh);
    ASSERT_EQ(hinges.size(), 4u * 8u);  // 16 edges, 8 of them on the border
    for (size_t h = 0; h < hinges.size(); h += 4) {
      auto at = [&](size_t i) -> Eigen::Vector3d { return mesh.X.col(hinges[h + i]); };
      const Eigen::Vector3d e = at(1) - at(0), a = at(2) - at(0), b = at(3) - at(0);
      EXPECT_GT(e.cross(a).z(), 0);
      EXPECT_GT(b.cross(e).z(), 0);
    }
  }
}

TEST(mesh_stencils, an_edge_of_three_triangles_makes_three_hinges) {
  Mesh mesh;
  mesh.element = Element::tri3;
  mesh.X.resize(3, 5);
  mesh.X << 0, 1, 0, 0, 0,  //
      0, 0, 1, -1, 0,       //
      0, 0, 0, 0, 1;
  mesh.cells = {0, 1, 2, 1, 0, 3, 0, 1, 4};
  EXPECT_EQ(stencils_on_mesh("hinge", mesh), (std::vector<int>{0, 1, 2, 3, 0, 1, 2, 4, 0, 1, 4, 3}));
}

TEST(mesh_stencils, corners_follow_a_line_and_close_with_it) {
  const std::vector<Eigen::Vector3d> square = {{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0}};
  EXPECT_EQ(stencils_on_mesh("corner", line_mesh(square, false)), (std::vector<int>{0, 1, 2, 1, 2, 3}));
  EXPECT_EQ(stencils_on_mesh("corner", line_mesh(square, true)),
            (std::vector<int>{3, 0, 1, 0, 1, 2, 1, 2, 3, 2, 3, 0}));
  Mesh star = line_mesh(square, false);  // three edges from vertex 1
  star.cells = {0, 1, 1, 2, 1, 3};
  EXPECT_EQ(stencils_on_mesh("corner", star), (std::vector<int>{0, 1, 2, 0, 1, 3, 2, 1, 3}));
}

TEST(mesh_stencils, rod_corners_name_the_twists_of_their_edges) {
  const std::vector<Eigen::Vector3d> square = {{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0}};
  EXPECT_EQ(stencils_on_mesh("rod_corner", line_mesh(square, false)), (std::vector<int>{0, 1, 2, 4, 5, 1, 2, 3, 5, 6}));
  EXPECT_EQ(stencils_on_mesh("rod_corner", line_mesh(square, true)),
            (std::vector<int>{3, 0, 1, 7, 4, 0, 1, 2, 4, 5, 1, 2, 3, 5, 6, 2, 3, 0, 6, 7}));
  Mesh star = line_mesh(square, false);
  star.cells = {0, 1, 1, 2, 1, 3};
  EXPECT_EQ(
      error_of("rod_corner", star),
      "edges 1 and 2 of this line both begin at vertex 1; a rod that twists does not branch, and its edges run in "
      "one direction");
  star.cells = {0, 1, 2, 1, 2, 3};
  EXPECT_EQ(error_of("rod_corner", star),
            "edges 0 and 1 of this line both end at vertex 1; a rod that twists does not branch, and its edges run in "
            "one direction");
}

// Around a closed line that is not plane the frame turns by the solid angle of its tangents.
TEST(mesh_stencils, axes_of_cross_sections_are_carried_along_without_turning) {
  const std::vector<Eigen::Vector3d> bent = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}};
  const Mesh open = line_mesh(bent, false);
  const std::vector<Eigen::Vector3d> axes = cross_section_axes(open, Eigen::Vector3d(5, 2, 0));
  EXPECT_LT((axes[0] - Eigen::Vector3d::UnitY()).norm(), 1e-15);
  EXPECT_LT((axes[1] + Eigen::Vector3d::UnitX()).norm(), 1e-15);
  EXPECT_LT((axes[2] + Eigen::Vector3d::UnitX()).norm(), 1e-15);
  for (const double turn : frame_turns(open, stencils_on_mesh("rod_corner", open), axes)) EXPECT_NEAR(turn, 0, 1e-15);
  EXPECT_EQ(cross_section_axes(open, std::nullopt)[0], Eigen::Vector3d::UnitZ());
  const Mesh closed = line_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0.5}}, true);
  const std::vector<int> corners = stencils_on_mesh("rod_corner", closed);
  const std::vector<double> turns = frame_turns(closed, corners, cross_section_axes(closed, std::nullopt));
  const std::vector<double> others = frame_turns(closed, corners, cross_section_axes(closed, Eigen::Vector3d(0, 1, 1)));
  EXPECT_GT(std::abs(turns[0]), 0.1);  // where edge 0 follows the last
  for (size_t i = 1; i < turns.size(); ++i) EXPECT_NEAR(turns[i], 0, 1e-15);
  EXPECT_NEAR(turns[0], others[0], 1e-14) << "whatever the axis";
  try {
    cross_section_axes(open, Eigen::Vector3d(2, 0, 0));
    FAIL();
  } catch (const InputError& bad) {
    EXPECT_STREQ(bad.what(),
                 "the axis of the cross-section, [2, 0, 0], runs along the first edge; it must point across");
  }
}

TEST(mesh_stencils, a_patch_is_a_triangle_and_what_lies_across_its_edges) {
  const Mesh sheet = box_mesh(Element::tri3, {3, 3, 1}, {3, 3, 1});
  const std::vector<int> patches = stencils_on_mesh("patch", sheet);
  ASSERT_EQ(patches.size(), 2 * sheet.cells.size());
  const std::vector<RestSize> sizes = rest_sizes("patch");
  int inner = 0;
  for (size_t p = 0; p < patches.size(); p += 6) {
    const int* patch = &patches[p];
    EXPECT_TRUE(std::equal(patch, patch + 3, &sheet.cells[p / 2]));
    EXPECT_EQ(std::set<int>(patch, patch + 6).size(), 6u);
    for (size_t i = 0; i < 3; ++i) {
      const bool across = rest_size_of(sizes[1 + i], "patch", patches, sheet)[p / 6] == 1;
      const std::set<int> wanted = {patch[(i + 1) % 3], patch[(i + 2) % 3], patch[3 + i]};
      int found = 0;
      for (size_t c = 0; c < sheet.cells.size(); c += 3)
        found += wanted == std::set<int>(&sheet.cells[c], &sheet.cells[c] + 3);
      EXPECT_EQ(found, across ? 1 : 0);
      inner += found;
    }
  }
  EXPECT_EQ(inner, 3 * 18 - 12);  // all edges of 18 triangles but those of the border
  EXPECT_EQ(error_of("patch", box_mesh(Element::tri3, {1, 1, 1}, {1, 1, 1})),
            "a patch names 6 vertices; the triangle of vertices 0, 1, 3 is connected to fewer: refine the mesh");
  Mesh branching = sheet;
  branching.cells = {0, 1, 4, 1, 0, 5, 0, 1, 6};
  EXPECT_EQ(error_of("patch", branching),
            "the edge of vertices 0 and 1 has 3 triangles; patches are made of surfaces that do not branch");
  branching.cells = {0, 1, 2, 1, 0, 3, 2, 1, 3};
  EXPECT_EQ(error_of("patch", branching),
            "vertex 3 lies across two edges of the triangle of vertices 0, 1, 2: patches need a finer mesh");
}

// The normal of an edge halves the angle between its triangles, at a border it is that of the only one.
TEST(mesh_stencils, shell_triangles_name_the_tips_of_the_normals_amid_their_edges) {
  Mesh roof = box_mesh(Element::tri3, {2, 2, 1}, {2, 2, 1});
  for (int v = 0; v < roof.vertices(); ++v) roof.X(2, v) = std::abs(roof.X(0, v) - 1);
  const std::vector<int> edges = stencils_on_mesh("edge", roof), shells = stencils_on_mesh("shell_triangle", roof);
  const Eigen::Matrix3Xd tips = edge_normal_tips(roof);
  ASSERT_EQ(static_cast<size_t>(tips.cols()), edges.size() / 2);
  ASSERT_EQ(shells.size(), 2 * roof.cells.size());
  for (size_t s = 0; s < shells.size(); s += 6) {
    EXPECT_TRUE(std::equal(&shells[s], &shells[s] + 3, &roof.cells[s / 2]));
    for (size_t i = 0; i < 3; ++i) {
      const auto e = static_cast<size_t>(shells[s + 3 + i] - roof.vertices());
      const std::set<int> across = {shells[s + (i + 1) % 3], shells[s + (i + 2) % 3]};
      EXPECT_EQ(across, (std::set<int>{edges[2 * e], edges[2 * e + 1]}));
    }
  }
  double area = 0;
  for (size_t e = 0; e < edges.size() / 2; ++e) {
    const Eigen::Vector3d a = roof.X.col(edges[2 * e]), b = roof.X.col(edges[2 * e + 1]);
    const double to_the_left = (a[0] + b[0]) / 2 - 1;  // of the valley at x = 1
    const Eigen::Vector3d normal = to_the_left == 0  ? Eigen::Vector3d(0, 0, 1)
                                   : to_the_left < 0 ? Eigen::Vector3d(1, 0, 1).normalized()
                                                     : Eigen::Vector3d(-1, 0, 1).normalized();
    EXPECT_LT((tips.col(static_cast<int>(e)) - (a + b) / 2 - (b - a).norm() * normal).norm(), 1e-15) << e;
    area += edge_areas(roof)[static_cast<int>(e)];
  }
  EXPECT_NEAR(area, 4 * std::sqrt(2), 1e-14);
  const std::vector<int>& t = roof.cells;
  EXPECT_EQ(edges_of_triangles_within(roof, {t[0], t[1], t[2]}).size(), 3u);
  EXPECT_TRUE(edges_of_triangles_within(roof, {t[0], t[1]}).empty());
}

TEST(mesh_stencils, sizes_are_those_of_the_rest_shape) {
  const auto sizes_of = [](std::string_view kind, const Mesh& mesh) {
    const std::vector<int> stencils = stencils_on_mesh(kind, mesh);
    std::map<std::string, std::vector<double>> out;
    for (const RestSize& size : rest_sizes(kind)) out[size.name] = rest_size_of(size, kind, stencils, mesh);
    return out;
  };
  using Sizes = std::map<std::string, std::vector<double>>;
  EXPECT_EQ(sizes_of("corner", line_mesh({{0, 0, 0}, {3, 4, 0}, {3, 4, 2}}, false)), (Sizes{{"L0", {5}}, {"L1", {2}}}));
  EXPECT_EQ(sizes_of("edge", line_mesh({{0, 0, 0}, {3, 4, 0}, {3, 4, 2}}, false)), (Sizes{{"L", {5, 2}}}));
  const Mesh sheet = box_mesh(Element::tri3, {3, 4, 1}, {1, 1, 1});
  EXPECT_EQ(sizes_of("triangle", sheet), (Sizes{{"A", {6, 6}}}));
  EXPECT_EQ(sizes_of("hinge", sheet), (Sizes{{"L", {5}}, {"A0", {6}}, {"A1", {6}}}));
  EXPECT_TRUE(sizes_of("point", sheet).empty());
  const Sizes solid = sizes_of("tetrahedron", box(Element::tet4, 1));
  for (const double volume : solid.at("V")) EXPECT_NEAR(volume, 1.0 / 6, 1e-15);
}

}  // namespace
}  // namespace ergon
