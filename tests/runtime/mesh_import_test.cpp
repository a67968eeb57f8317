// Filling surfaces with tetrahedra.

#include "runtime/mesh/mesh_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <thread>

#include "runtime/error.h"
#include "runtime/mesh/closed_surface.h"
#include "runtime/mesh/mesh_build.h"
#include "runtime/mesh/mesh_tools.h"
#include "tests/paths.h"
#include "tests/runtime/mesh_helpers.h"

#ifdef __SANITIZE_ADDRESS__
// Gmsh 4.8 keeps some memory of its own when it is closed.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libgmsh\n";
}  // NOLINT(bugprone-reserved-identifier)
#endif

namespace ergon {
namespace {

// The surface of a box with its lowest corner at `corner`, as a mesh of its own.
Mesh box_surface(const Eigen::Vector3d& corner, const Eigen::Vector3d& size, int cells) {
  const Mesh box = box_tets(size, {cells, cells, cells});
  Mesh surface;
  surface.element = Element::tri3;
  surface.source = "box.obj";
  std::vector<int> number(static_cast<size_t>(box.vertices()), -1);
  std::vector<Eigen::Vector3d> points;
  for (const auto& t : surface_triangles(box)) {
    for (const int v : t) {
      int& n = number[static_cast<size_t>(v)];
      if (n < 0) {
        n = static_cast<int>(points.size());
        points.push_back(box.X.col(v) + corner);
      }
      surface.cells.push_back(n);
    }
  }
  surface.X.resize(3, static_cast<Eigen::Index>(points.size()));
  for (size_t i = 0; i < points.size(); ++i) surface.X.col(static_cast<Eigen::Index>(i)) = points[i];
  return surface;
}

Mesh together(const Mesh& a, const Mesh& b) {
  Mesh both = a;
  both.X.resize(3, a.vertices() + b.vertices());
  both.X << a.X, b.X;
  for (const int v : b.cells) both.cells.push_back(v + a.vertices());
  return both;
}

// The smallest and largest dihedral angle of a Tet4 mesh, in degrees.
std::array<double, 2> dihedral_angles(const Mesh& mesh) {
  std::array<double, 2> range{180, 0};
  for (size_t c = 0; c < mesh.cells.size(); c += 4) {
    for (size_t i = 0; i < 4; ++i) {
      for (size_t j = i + 1; j < 4; ++j) {
        // The edge between the two corners other than i and j.
        std::array<size_t, 2> edge{};
        for (size_t k = 0, n = 0; k < 4; ++k) {
          if (k != i && k != j) edge[n++] = k;
        }
        const auto at = [&](size_t k) -> Eigen::Vector3d { return mesh.X.col(mesh.cells[c + k]); };
        const Eigen::Vector3d along = (at(edge[1]) - at(edge[0])).normalized();
        const auto across = [&](size_t k) -> Eigen::Vector3d {
          const Eigen::Vector3d d = at(k) - at(edge[0]);
          return (d - along * along.dot(d)).normalized();
        };
        const double angle = std::acos(std::clamp(across(i).dot(across(j)), -1.0, 1.0)) * 180 / std::numbers::pi;
        range = {std::min(range[0], angle), std::max(range[1], angle)};
      }
    }
  }
  return range;
}

TEST(mesh_import, the_bunny_is_filled_with_sound_tetrahedra) {
  const Mesh surface = read_surface(test::source("/scenes/meshes/bunny.obj"));
  const Mesh solid = fill_surface(surface, {.max_edge_length = 0.4});
  EXPECT_GT(solid.cell_count(), 12000);
  EXPECT_LT(solid.cell_count(), 18000);
  EXPECT_EQ(solid.X.leftCols(surface.vertices()), surface.X);
  EXPECT_EQ(surface_triangles(solid).size(), 3674U);
  EXPECT_NEAR(sum(rest_volumes(solid)), 194.28837, 1e-5);
  const auto [smallest, largest] = dihedral_angles(solid);
  EXPECT_GT(smallest, 2);
  EXPECT_LT(largest, 178);
}

TEST(mesh_import, the_same_surface_gives_the_same_mesh) {
  const Mesh surface = read_surface(test::source("/scenes/meshes/bunny.obj"));
  const Mesh first = fill_surface(surface);
  const Mesh second = fill_surface(surface);
  EXPECT_EQ(first.X, second.X);
  EXPECT_EQ(first.cells, second.cells);
}

TEST(mesh_import, smaller_edges_give_more_tetrahedra) {
  const Mesh surface = box_surface({0, 0, 0}, {1, 1, 1}, 4);
  const int coarse = fill_surface(surface).cell_count();
  const int fine = fill_surface(surface, {.max_edge_length = 0.1}).cell_count();
  EXPECT_GT(fine, 4 * coarse);
}

TEST(mesh_import, triangles_may_be_turned_over) {
  Mesh surface = box_surface({0, 0, 0}, {1, 1, 1}, 2);
  for (size_t t = 0; t < surface.cells.size(); t += 9) std::swap(surface.cells[t], surface.cells[t + 1]);
  const Mesh solid = fill_surface(surface);
  EXPECT_NEAR(sum(rest_volumes(solid)), 1, 1e-12);
}

TEST(mesh_import, parts_beside_and_inside_one_another_are_told_apart) {
  const Mesh outer = box_surface({0, 0, 0}, {1, 1, 1}, 3);
  const Mesh cavity = box_surface({0.2, 0.2, 0.2}, {0.6, 0.6, 0.6}, 2);
  const Mesh core = box_surface({0.4, 0.4, 0.4}, {0.2, 0.2, 0.2}, 1);
  const Mesh beside = box_surface({2, 0, 0}, {1, 0.5, 1}, 2);
  EXPECT_NEAR(sum(rest_volumes(fill_surface(together(outer, cavity)))), 1 - 0.216, 1e-12);
  EXPECT_NEAR(sum(rest_volumes(fill_surface(together(together(core, cavity), together(beside, outer))))),
              1 - 0.216 + 0.008 + 0.5, 1e-12);
}

TEST(mesh_import, open_surfaces_say_where) {
  Mesh surface = box_surface({0, 0, 0}, {1, 1, 1}, 1);
  surface.cells.resize(surface.cells.size() - 3);
  EXPECT_EQ(
      message_of([&] { fill_surface(surface); }),
      "box.obj: the surface is open: 3 edges have only one triangle, such as the edge from (1, 0, 0) to (0, 0, 0); "
      "close its holes");
  surface.cells.clear();
  EXPECT_EQ(message_of([&] { fill_surface(surface); }), "box.obj: the surface has no triangles");
}

TEST(mesh_import, branching_and_one_sided_surfaces_are_told) {
  Mesh surface = box_surface({0, 0, 0}, {1, 1, 1}, 1);
  const std::vector<int> cells = surface.cells;
  for (int i = 0; i < 3; ++i) surface.cells.push_back(cells[static_cast<size_t>(i)]);
  EXPECT_THAT(
      message_of([&] { fill_surface(surface); }),
      ::testing::MatchesRegex("box.obj: the surface branches: 3 edges have more than two triangles, such as the "
                              "edge from \\(.*\\) to \\(.*\\); remove inner walls and doubled triangles"));
  // The projective plane with six vertices.
  surface.cells = {0, 1, 4, 0, 4, 3, 0, 3, 2, 0, 2, 5, 0, 5, 1, 1, 2, 3, 1, 3, 5, 1, 2, 4, 2, 4, 5, 3, 4, 5};
  EXPECT_THAT(message_of([&] { fill_surface(surface); }),
              ::testing::StartsWith("box.obj: the surface has only one side: its triangles cannot be oriented, as is "
                                    "seen at the triangle with a corner at ("));
}

TEST(mesh_import, surfaces_that_cut_themselves_are_told) {
  const Mesh surface = together(box_surface({0, 0, 0}, {1, 1, 1}, 1), box_surface({0.5, 0.3, 0.2}, {1, 1.1, 1.2}, 1));
  EXPECT_THAT(
      message_of([&] { fill_surface(surface); }),
      ::testing::MatchesRegex("box.obj: the surface cuts itself: triangles [0-9]+ and [0-9]+ \\(counted from 0\\) "
                              "cross or overlap near \\(.*\\)"));
}

TEST(mesh_import, parts_that_overlap_in_a_plane_are_told) {
  const Mesh box = box_surface({0, 0, 0}, {1, 1, 1}, 1);
  for (const Eigen::Vector3d& corner : {Eigen::Vector3d(1, 0.25, 0.25), Eigen::Vector3d(0.5, 0, 0)}) {
    EXPECT_THAT(message_of([&] {
                  fill_surface(together(box, box_surface(corner, {1, 1, 1}, 1)));
                }),
                ::testing::StartsWith("box.obj: the surface cuts itself: triangles "));
  }
  EXPECT_NEAR(sum(rest_volumes(fill_surface(together(box, box_surface({1.001, 0, 0}, {1, 1, 1}, 1))))), 2, 1e-12);
}

TEST(mesh_import, crossings_are_found_wherever_they_are) {
  // Many boxes in a row, of which only two meet; and the same without them.
  Mesh row = box_surface({0, 0, 0}, {0.9, 0.9, 0.9}, 3);
  for (int i = 1; i < 40; ++i) row = together(row, box_surface({1.0 * i, 0, 0}, {0.9, 0.9, 0.9}, 3));
  EXPECT_EQ(closed_parts(row).size(), 40U);
  const int first = row.cell_count();
  const Mesh meeting = together(row, box_surface({17.5, 0.5, 0.5}, {0.3, 3, 0.2}, 1));
  std::vector<std::array<int, 3>> triangles;
  for (size_t i = 0; i < meeting.cells.size(); i += 3) {
    triangles.push_back({meeting.cells[i], meeting.cells[i + 1], meeting.cells[i + 2]});
  }
  const auto [a, b] = crossing_triangles(meeting.X, triangles);
  EXPECT_EQ(a / 108, 17);
  EXPECT_GE(b, first);
}

TEST(mesh_import, a_surface_without_volume_is_told) {
  Mesh surface = box_surface({0, 0, 0}, {1, 1, 1}, 1);
  const std::vector<int> twice{surface.cells[0], surface.cells[1], surface.cells[2]};
  surface.cells = {twice[0], twice[1], twice[2], twice[0], twice[2], twice[1]};
  EXPECT_THAT(message_of([&] { fill_surface(surface); }),
              ::testing::MatchesRegex("box.obj: the part of the surface at \\(.*\\) encloses no volume"));
}

TEST(mesh_import, bad_options_and_bad_vertices_are_named) {
  Mesh surface = box_surface({0, 0, 0}, {1, 1, 1}, 1);
  EXPECT_EQ(message_of([&] { fill_surface(surface, {.max_edge_length = -1}); }),
            "box.obj: the maximum edge length is -1 m; it must be positive, or 0 for sizes continued from the surface");
  EXPECT_EQ(message_of([&] { fill_surface(surface, {.improve_below = 2}); }),
            "box.obj: tetrahedra are to be improved below a quality of 2; it must be between 0 and 1");
  surface.X(2, 3) = INFINITY;
  EXPECT_THAT(message_of([&] { fill_surface(surface); }), ::testing::StartsWith("box.obj: vertex 3 is not finite: ("));
  EXPECT_EQ(message_of([&] {
              fill_surface(box_tets({1, 1, 1}, {1, 1, 1}));
            }),
            "box: a surface is made of Tri3, this mesh is Tet4");
}

TEST(mesh_import, calls_from_several_threads_wait_for_one_another) {
  const Mesh surface = box_surface({0, 0, 0}, {1, 1, 1}, 2);
  std::vector<Mesh> solids(4);
  std::vector<std::thread> threads;
  for (Mesh& solid : solids) threads.emplace_back([&] { solid = fill_surface(surface); });
  for (std::thread& thread : threads) thread.join();
  for (const Mesh& solid : solids) EXPECT_EQ(solid.cells, solids[0].cells);
}

TEST(mesh_import, nothing_is_printed) {
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  fill_surface(box_surface({0, 0, 0}, {1, 1, 1}, 2));
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace ergon
