#include "runtime/mesh/mesh_build.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "runtime/error.h"
#include "runtime/mesh/mesh_tools.h"
#include "tests/runtime/mesh_helpers.h"

namespace ergon {
namespace {

const Eigen::Vector3d kSize(2, 3, 0.5);
const std::array<int, 3> kCells{3, 4, 2};

// Area vectors of a closed surface add up to zero; the volume follows from the divergence theorem.
double volume_inside(const Mesh& mesh) {
  double volume = 0;
  for (const auto& t : surface_triangles(mesh)) {
    volume += mesh.X.col(t[0]).dot(Eigen::Vector3d(mesh.X.col(t[1])).cross(Eigen::Vector3d(mesh.X.col(t[2])))) / 6;
  }
  return volume;
}

TEST(mesh_build, box_of_tetrahedra_fills_the_box_with_equal_positive_cells) {
  const Mesh mesh = box_tets(kSize, kCells);
  EXPECT_EQ(mesh.vertices(), 4 * 5 * 3);
  EXPECT_EQ(mesh.cell_count(), 3 * 4 * 2 * 6);
  check_mesh(mesh);
  for (const double volume : rest_volumes(mesh)) EXPECT_NEAR(volume, 3.0 / (24 * 6), 1e-15);
  EXPECT_NEAR(sum(rest_volumes(mesh)), 3.0, 1e-13);
  EXPECT_EQ(bounding_box(mesh).col(0), Eigen::Vector3d::Zero());
  EXPECT_EQ(bounding_box(mesh).col(1), kSize);
}

TEST(mesh_build, neighbouring_tetrahedra_share_their_faces) {
  // Two triangles per brick face on the box, and no other face without a partner.
  EXPECT_EQ(surface_triangles(box_tets(kSize, kCells)).size(), 2U * 2 * (3 * 4 + 4 * 2 + 3 * 2));
}

TEST(mesh_build, box_of_hexahedra_has_the_same_vertices) {
  const Mesh mesh = box_hexes(kSize, kCells);
  EXPECT_EQ(mesh.cell_count(), 24);
  EXPECT_EQ(mesh.X, box_tets(kSize, kCells).X);
  check_mesh(mesh);
  EXPECT_NEAR(sum(rest_volumes(mesh)), 3.0, 1e-14);
  EXPECT_EQ(surface_triangles(mesh).size(), 2U * 2 * (3 * 4 + 4 * 2 + 3 * 2));
}

TEST(mesh_build, quadratic_tetrahedra_share_mid_edge_nodes) {
  const Mesh linear = box_tets(kSize, {1, 1, 1});
  const Mesh mesh = to_quadratic(linear, Element::tet10);
  // A brick of six tetrahedra has 12 outer edges, 6 face diagonals and the inner diagonal.
  EXPECT_EQ(mesh.vertices(), 8 + 19);
  EXPECT_EQ(mesh.cell_count(), 6);
  check_mesh(mesh);
  EXPECT_NEAR(sum(rest_volumes(mesh)), 3.0, 1e-14);
  EXPECT_EQ(surface_triangles(mesh).size(), 4U * 12);
  for (int c = 0; c < 6; ++c) {
    for (int i = 0; i < 4; ++i)
      EXPECT_EQ(mesh.cells[static_cast<size_t>(10 * c + i)], linear.cells[static_cast<size_t>(4 * c + i)]);
    // Node 9 is between corners 2 and 3 in VTK's order.
    const auto node = [&](int i) { return mesh.X.col(mesh.cells[static_cast<size_t>(10 * c + i)]); };
    EXPECT_LT((node(9) - (node(2) + node(3)) / 2).norm(), 1e-15);
    EXPECT_LT((node(8) - (node(1) + node(3)) / 2).norm(), 1e-15);
  }
}

TEST(mesh_build, surfaces_are_seen_counter_clockwise_from_outside) {
  for (const Mesh& mesh :
       {box_tets(kSize, kCells), box_hexes(kSize, kCells), to_quadratic(box_tets(kSize, kCells), Element::tet10)}) {
    EXPECT_NEAR(volume_inside(mesh), 3.0, 1e-13) << name_of(mesh.element);
  }
}

TEST(mesh_build, alternating_triangles_meet_eight_and_four_at_a_time) {
  const Mesh mesh = alternating_triangles(Element::tri3, {2, 3, 1}, {4, 6, 1});
  check_mesh(mesh);
  EXPECT_EQ(mesh.X, box_mesh(Element::tri3, {2, 3, 1}, {4, 6, 1}).X);
  EXPECT_NEAR(sum(rest_volumes(mesh)), 6, 1e-13);
  std::vector<int> around(static_cast<size_t>(mesh.vertices()), 0);
  for (size_t t = 0; t < mesh.cells.size(); t += 3) {
    const auto at = [&](size_t i) -> Eigen::Vector3d { return mesh.X.col(mesh.cells[t + i]); };
    const Eigen::Vector3d first = at(1) - at(0);
    EXPECT_EQ(first.y(), 0);  // along x, as the axes of anisotropic laws are
    EXPECT_GT(first.cross(at(2) - at(0)).z(), 0);
    for (size_t i = 0; i < 3; ++i) ++around[static_cast<size_t>(mesh.cells[t + i])];
  }
  for (int j = 1; j < 6; ++j)
    for (int i = 1; i < 4; ++i) EXPECT_EQ(around[static_cast<size_t>(5 * j + i)], (i + j) % 2 == 0 ? 8 : 4);
  check_mesh(alternating_triangles(Element::tri6, {2, 3, 1}, {4, 6, 1}));
  EXPECT_THROW(alternating_triangles(Element::quad4, {2, 3, 1}, {4, 6, 1}), InputError);
}

TEST(mesh_build, the_first_side_of_every_triangle_lies_along_x) {
  const Mesh mesh = box_mesh(Element::tri3, {2, 3, 1}, {4, 6, 1});
  for (size_t t = 0; t < mesh.cells.size(); t += 3) EXPECT_EQ(mesh.X(1, mesh.cells[t]), mesh.X(1, mesh.cells[t + 1]));
}

TEST(mesh_build, bad_numbers_are_named) {
  const auto message = [](auto build) -> std::string {
    try {
      build();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message([] {
              box_tets({1, -2, 1}, {1, 1, 1});
            }),
            "box: size along y is -2 m; it must be positive and finite");
  EXPECT_EQ(message([] {
              box_hexes({1, 1, std::nan("")}, {1, 1, 1});
            }),
            "box: size along z is nan m; it must be positive and finite");
  EXPECT_EQ(message([] { box_tets({1, 1, 1}, {0, 1, 1}); }), "box: 0 cells along x; at least 1 is needed");
  EXPECT_EQ(message([] {
              box_tets({1, 1, 1}, {1000, 1000, 1000});
            }),
            "box: 1000 x 1000 x 1000 cells are too many; at most 89478485 bricks can be numbered");
  EXPECT_EQ(message([] {
              to_quadratic(box_hexes({1, 1, 1}, {1, 1, 1}), Element::tet10);
            }),
            "box: only Tet4 meshes become Tet10, this one is Hex8");
}

}  // namespace
}  // namespace ergon
