#include "runtime/mesh/element_faces.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>
#include <set>

#include "runtime/mesh/mesh_build.h"
#include "runtime/mesh/mesh_tools.h"

namespace ergon {
namespace {

std::vector<Element> elements_of(int dimension) {
  std::vector<Element> elements;
  for (const Element element : all_elements()) {
    if (dimension_of(element) == dimension) elements.push_back(element);
  }
  return elements;
}

const Eigen::Vector3d kSize(2, 3, 0.5);
const std::array<int, 3> kCells{3, 4, 2};

class EverySolid : public ::testing::TestWithParam<Element> {};
class EveryMembrane : public ::testing::TestWithParam<Element> {};
INSTANTIATE_TEST_SUITE_P(mesh_faces, EverySolid, ::testing::ValuesIn(elements_of(3)),
                         [](const auto& info) { return name_of(info.param); });
INSTANTIATE_TEST_SUITE_P(mesh_faces, EveryMembrane, ::testing::ValuesIn(elements_of(2)),
                         [](const auto& info) { return name_of(info.param); });

TEST_P(EverySolid, faces_turn_outwards_and_close_the_cell) {
  const auto& nodes = reference_nodes(GetParam());
  double volume = 0;
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  std::vector<std::array<int, 3>> triangles;
  for (const ElementFace& face : faces_of(GetParam())) append_triangles(face, face.nodes, triangles);
  for (const auto& t : triangles) {
    const Eigen::Vector3d a = nodes[static_cast<size_t>(t[0])], b = nodes[static_cast<size_t>(t[1])],
                          c = nodes[static_cast<size_t>(t[2])];
    const Eigen::Vector3d normal = (b - a).cross(c - a) / 2;
    EXPECT_GT(normal.norm(), 0.1);
    area += normal;
    volume += normal.dot(a) / 3;
  }
  EXPECT_LT(area.norm(), 1e-15);
  const ReferenceShape shape = shape_of(GetParam());
  const double expected = shape == ReferenceShape::tetrahedron ? 1.0 / 6 : shape == ReferenceShape::prism ? 0.5 : 1;
  EXPECT_NEAR(volume, expected, 1e-15);
}

TEST_P(EverySolid, every_node_on_the_boundary_is_on_a_face) {
  std::set<int> on_faces;
  for (const ElementFace& face : faces_of(GetParam())) on_faces.insert(face.nodes.begin(), face.nodes.end());
  const int inside = GetParam() == Element::hex27 ? 1 : 0;
  EXPECT_EQ(static_cast<int>(on_faces.size()), nodes_of(GetParam()) - inside);
}

TEST_P(EverySolid, a_box_is_filled_by_positive_cells_that_share_their_faces) {
  const Mesh mesh = box_mesh(GetParam(), kSize, kCells);
  check_mesh(mesh);
  const std::vector<double> volumes = rest_volumes(mesh);
  const int parts = mesh.cell_count() / 24;
  for (const double volume : volumes) EXPECT_NEAR(volume, 3.0 / (24 * parts), 1e-14);
  double volume = 0, area = 0;
  for (const auto& t : surface_triangles(mesh)) {
    const Eigen::Vector3d a = mesh.X.col(t[0]), b = mesh.X.col(t[1]), c = mesh.X.col(t[2]);
    volume += a.dot(b.cross(c)) / 6;
    area += (b - a).cross(c - a).norm() / 2;
  }
  EXPECT_NEAR(volume, 3.0, 1e-13);
  EXPECT_NEAR(area, 2 * (2 * 3 + 3 * 0.5 + 2 * 0.5), 1e-12);
  EXPECT_EQ(bounding_box(mesh).col(0), Eigen::Vector3d::Zero());
  EXPECT_EQ(bounding_box(mesh).col(1), kSize);
}

TEST_P(EverySolid, a_box_has_the_nodes_that_quadratic_cells_add) {
  const Element element = GetParam();
  const Mesh mesh = box_mesh(element, kSize, kCells);
  if (degree_of(element) == 1) {
    EXPECT_EQ(mesh.vertices(), 4 * 5 * 3);
    return;
  }
  const Mesh same = to_quadratic(box_mesh(linear_element(element), kSize, kCells), element);
  ASSERT_EQ(same.vertices(), mesh.vertices());
  ASSERT_EQ(same.cells.size(), mesh.cells.size());
  for (size_t i = 0; i < mesh.cells.size(); ++i) {
    EXPECT_LT((mesh.X.col(mesh.cells[i]) - same.X.col(same.cells[i])).norm(), 1e-14);
  }
}

TEST_P(EveryMembrane, a_rectangle_is_filled) {
  const Mesh mesh = box_mesh(GetParam(), kSize, kCells);
  check_mesh(mesh);
  const std::vector<double> areas = rest_volumes(mesh);
  EXPECT_NEAR(std::accumulate(areas.begin(), areas.end(), 0.0), 6.0, 1e-13);
  double area = 0;
  std::set<int> used;
  for (const auto& t : surface_triangles(mesh)) {
    const Eigen::Vector3d a = mesh.X.col(t[0]), b = mesh.X.col(t[1]), c = mesh.X.col(t[2]);
    area += (b - a).cross(c - a).z() / 2;
    used.insert(t.begin(), t.end());
  }
  EXPECT_NEAR(area, 6.0, 1e-13);
  EXPECT_EQ(static_cast<int>(used.size()), mesh.vertices());
}

TEST(mesh_faces, lines_lie_on_the_x_axis) {
  for (const Element element : {Element::edge2, Element::edge3}) {
    const Mesh mesh = box_mesh(element, kSize, kCells);
    check_mesh(mesh);
    EXPECT_EQ(mesh.vertices(), 3 * degree_of(element) + 1);
    const std::vector<double> lengths = rest_volumes(mesh);
    EXPECT_NEAR(std::accumulate(lengths.begin(), lengths.end(), 0.0), 2.0, 1e-15);
  }
}

// Euler: corners - edges + faces = 2 for a solid, 1 for a membrane.
TEST(mesh_faces, corner_edges_are_counted_by_euler) {
  for (const int dimension : {2, 3}) {
    for (const Element element : elements_of(dimension)) {
      const int corners = nodes_of(linear_element(element));
      const int edges = static_cast<int>(corner_edges(element).size());
      EXPECT_EQ(corners - edges + static_cast<int>(faces_of(element).size()), dimension - 1) << name_of(element);
    }
  }
  EXPECT_EQ(corner_edges(Element::edge3), (std::vector<std::array<int, 2>>{{0, 1}}));
  EXPECT_TRUE(corner_edges(Element::point).empty());
}

TEST(mesh_faces, diagonals_start_at_the_lowest_vertex) {
  const ElementFace& face = faces_of(Element::quad4)[0];
  std::vector<std::array<int, 3>> triangles;
  append_triangles(face, {7, 3, 5, 9}, triangles);
  EXPECT_EQ(triangles, (std::vector<std::array<int, 3>>{{3, 5, 9}, {3, 9, 7}}));
}

}  // namespace
}  // namespace ergon
