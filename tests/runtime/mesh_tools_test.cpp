#include "runtime/mesh/mesh_tools.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "runtime/error.h"
#include "runtime/mesh/mesh_build.h"
#include "tests/runtime/mesh_helpers.h"

namespace ergon {
namespace {

Mesh unit_tet() {
  Mesh mesh;
  mesh.source = "one.msh";
  mesh.X.resize(3, 4);
  mesh.X << 0, 1, 0, 0,  //
      0, 0, 1, 0,        //
      0, 0, 0, 1;
  mesh.cells = {0, 1, 2, 3};
  return mesh;
}

// A box whose inner vertices are moved about, so that cells differ.
Mesh shaken(Mesh mesh) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> shift(-0.05, 0.05);
  for (int v = 0; v < mesh.vertices(); ++v) {
    for (int axis = 0; axis < 3; ++axis) mesh.X(axis, v) += shift(generator);
  }
  return mesh;
}

TEST(mesh_tools, inverted_and_flat_cells_are_named_with_their_volume) {
  Mesh mesh = unit_tet();
  EXPECT_EQ(message_of([&] { check_mesh(mesh); }), "no error");
  std::swap(mesh.cells[0], mesh.cells[1]);
  EXPECT_EQ(
      message_of([&] { check_mesh(mesh); }),
      "one.msh: cell 0 (Tet4, vertices 1 0 2 3) is inverted: volume -0.166667 m^3; 1 of 1 cells inverted or flat; "
      "reverse the order of its vertices or repair the mesh");
  mesh = unit_tet();
  mesh.X.col(3) << 0.5, 0.25, 0;
  EXPECT_EQ(
      message_of([&] { check_mesh(mesh); }),
      "one.msh: cell 0 (Tet4, vertices 0 1 2 3) is flat: volume 0 m^3; 1 of 1 cells inverted or flat; remove it or "
      "repair the mesh");
}

TEST(mesh_tools, a_flat_triangle_has_no_area) {
  Mesh mesh = unit_tet();
  mesh.element = Element::tri3;
  mesh.cells = {0, 1, 2, 0, 1, 3};
  mesh.X.col(3) << 2, 0, 0;
  EXPECT_EQ(
      message_of([&] { check_mesh(mesh); }),
      "one.msh: cell 1 (Tri3, vertices 0 1 3) is flat: area 0 m^2; 1 of 2 cells inverted or flat; remove it or repair "
      "the mesh");
}

TEST(mesh_tools, a_hexahedron_inverted_at_one_corner_only_is_found) {
  Mesh mesh = box_hexes({1, 1, 1}, {1, 1, 1});
  check_mesh(mesh);
  mesh.X.col(7) << 0.2, 0.2, 0.2;  // the corner at (1, 1, 1), pushed through its neighbours' plane
  EXPECT_EQ(
      message_of([&] { check_mesh(mesh); }),
      "box: cell 0 (Hex8, vertices 0 1 3 2 4 5 7 6) is inverted: volume 0.4 m^3, but -1.4 m^3 per unit at one of its "
      "points; 1 of 1 cells inverted or flat; reverse the order of its vertices or repair the mesh");
}

TEST(mesh_tools, numbers_that_are_not_finite_and_names_that_do_not_exist_are_named) {
  Mesh mesh = unit_tet();
  mesh.X(1, 2) = std::nan("");
  EXPECT_EQ(message_of([&] { check_mesh(mesh); }), "one.msh: vertex 2 is not finite: (0, nan, 0)");
  mesh = unit_tet();
  mesh.cells[2] = 4;
  EXPECT_EQ(message_of([&] { check_mesh(mesh); }),
            "one.msh: cell 0 names vertex 4, but there are only 4 (counted from 0)");
  mesh.cells[2] = 1;
  EXPECT_EQ(message_of([&] { check_mesh(mesh); }), "one.msh: cell 0 names vertex 1 twice");
  mesh.cells.pop_back();
  EXPECT_EQ(message_of([&] { check_mesh(mesh); }), "one.msh: 3 node numbers do not divide into Tet4 cells of 4 nodes");
}

TEST(mesh_tools, masses_are_positive_and_add_up) {
  const Eigen::Vector3d size(2, 3, 0.5);
  for (const Mesh& mesh : {shaken(box_tets(size, {3, 3, 2})), shaken(box_hexes(size, {3, 3, 2})),
                           to_quadratic(shaken(box_tets(size, {3, 3, 2})), Element::tet10)}) {
    const Eigen::VectorXd masses = lumped_masses(mesh, 1000);
    const auto volumes = rest_volumes(mesh);
    EXPECT_GT(masses.minCoeff(), 0) << name_of(mesh.element);
    EXPECT_NEAR(masses.sum(), 1000 * std::accumulate(volumes.begin(), volumes.end(), 0.0), 1e-9);
  }
}

TEST(mesh_tools, quadratic_lumping_follows_the_consistent_diagonal) {
  // The diagonal of the consistent mass matrix by an independent route: products of barycentric coordinates integrate
  // to 6 V a! b! c! d!/(a + b + c + d + 3)!. Corner: L^2 (2 L - 1)^2; mid-edge: 16 La^2 Lb^2.
  const double corner = 6 * (4 * 24.0 / 5040 - 4 * 6.0 / 720 + 2.0 / 120);
  const double middle = 6 * 16 * 4.0 / 5040;
  const double scale = 4 * corner + 6 * middle;
  const Eigen::VectorXd masses = lumped_masses(to_quadratic(unit_tet(), Element::tet10), 6);  // 1 kg
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(masses(i), (i < 4 ? corner : middle) / scale, 1e-15);
}

TEST(mesh_tools, hexahedral_row_sums_share_a_brick_equally) {
  // Two bricks of unequal length: each gives an eighth of its mass to each of its corners.
  Mesh mesh = box_hexes({2, 1, 1}, {2, 1, 1});
  for (int v = 0; v < mesh.vertices(); ++v) {
    if (mesh.X(0, v) == 1) mesh.X(0, v) = 0.5;
  }
  const Eigen::VectorXd masses = lumped_masses(mesh, 8);
  for (int v = 0; v < mesh.vertices(); ++v) {
    const double x = mesh.X(0, v);
    EXPECT_NEAR(masses(v), x == 0 ? 0.5 : x == 2 ? 1.5 : 2.0, 1e-14);
  }
}

TEST(mesh_tools, lower_dimensional_cells_have_masses_too) {
  Mesh mesh = unit_tet();
  mesh.element = Element::tri3;
  mesh.cells = {0, 1, 2};
  EXPECT_TRUE(lumped_masses(mesh, 6).isApprox(Eigen::Vector4d(1, 1, 1, 0), 1e-15));
  mesh.element = Element::edge2;
  mesh.cells = {0, 1};
  EXPECT_TRUE(lumped_masses(mesh, 2).isApprox(Eigen::Vector4d(1, 1, 0, 0), 1e-15));
  mesh.element = Element::point;
  mesh.cells = {2};
  EXPECT_TRUE(lumped_masses(mesh, 3).isApprox(Eigen::Vector4d(0, 0, 3, 0), 1e-15));
  EXPECT_EQ(message_of([&] { lumped_masses(mesh, 0); }), "one.msh: density is 0; it must be positive and finite");
}

TEST(mesh_tools, cells_along_the_curve_are_neighbours) {
  // On a grid of 2^n cubes, a Hilbert curve steps from each cell to one that shares a face with it.
  const Mesh mesh = box_hexes({8, 8, 8}, {8, 8, 8});
  const ReorderedMesh ordered = spatial_order(mesh);
  const auto centre = [&](int cell) -> Eigen::Vector3d {
    Eigen::Vector3d total = Eigen::Vector3d::Zero();
    for (size_t i = 0; i < 8; ++i) total += ordered.mesh.X.col(ordered.mesh.cells[static_cast<size_t>(cell) * 8 + i]);
    return total / 8;
  };
  for (int c = 1; c < mesh.cell_count(); ++c) EXPECT_NEAR((centre(c) - centre(c - 1)).norm(), 1.0, 1e-12) << c;
}

TEST(mesh_tools, reordering_keeps_the_mesh) {
  Mesh mesh = shaken(box_tets({1, 2, 3}, {3, 4, 5}));
  mesh.X.conservativeResize(3, mesh.vertices() + 1);  // a vertex of no cell
  mesh.X.rightCols(1).setConstant(9);
  const ReorderedMesh ordered = spatial_order(mesh);
  ASSERT_EQ(ordered.mesh.vertices(), mesh.vertices());
  ASSERT_EQ(ordered.mesh.cell_count(), mesh.cell_count());
  EXPECT_EQ(ordered.vertex_from.back(), mesh.vertices() - 1);
  auto sorted = ordered.cell_from;
  std::sort(sorted.begin(), sorted.end());
  for (int c = 0; c < mesh.cell_count(); ++c) EXPECT_EQ(sorted[static_cast<size_t>(c)], c);
  for (int v = 0; v < mesh.vertices(); ++v) {
    EXPECT_EQ(ordered.mesh.X.col(v), mesh.X.col(ordered.vertex_from[static_cast<size_t>(v)]));
  }
  for (int c = 0; c < mesh.cell_count(); ++c) {
    for (int i = 0; i < 4; ++i) {
      const int now = ordered.mesh.cells[static_cast<size_t>(4 * c + i)];
      const int before = mesh.cells[static_cast<size_t>(4 * ordered.cell_from[static_cast<size_t>(c)] + i)];
      EXPECT_EQ(ordered.vertex_from[static_cast<size_t>(now)], before);
    }
  }
}

TEST(mesh_tools, transforms_scale_then_rotate_then_translate) {
  Mesh mesh = unit_tet();
  const Mesh moved = transformed(mesh, {2, {0, 0, 5}, std::numbers::pi / 2, {10, 0, 1}});
  EXPECT_LT((moved.X.col(1) - Eigen::Vector3d(10, 2, 1)).norm(), 1e-14);
  EXPECT_LT((moved.X.col(3) - Eigen::Vector3d(10, 0, 3)).norm(), 1e-14);
  EXPECT_NEAR(rest_volumes(moved)[0], 8.0 / 6, 1e-14);
  EXPECT_EQ(message_of([&] {
              transformed(mesh, {-1, {0, 0, 1}, 0, {0, 0, 0}});
            }),
            "one.msh: scale is -1; it must be positive and finite");
  EXPECT_EQ(message_of([&] {
              transformed(mesh, {1, {0, 0, 0}, 1, {0, 0, 0}});
            }),
            "one.msh: rotation axis must be finite and not zero");
}

TEST(mesh_tools, vertices_are_picked_by_a_closed_box) {
  const Mesh mesh = box_tets({2, 1, 1}, {2, 1, 1});
  EXPECT_EQ(vertices_in_box(mesh, {0, 0, 0}, {0, 1, 1}), (std::vector<int>{0, 3, 6, 9}));
  EXPECT_TRUE(vertices_in_box(mesh, {3, 0, 0}, {4, 1, 1}).empty());
}

}  // namespace
}  // namespace ergon
