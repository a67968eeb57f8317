#include "runtime/mesh/mesh_build.h"

#include <fmt/format.h>

#include <climits>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "runtime/error.h"

namespace ergon {
namespace {

void check_box(const Eigen::Vector3d& size, const std::array<int, 3>& cells) {
  const char axes[] = "xyz";
  double bricks = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const int count = cells[static_cast<size_t>(axis)];
    if (!(size(axis) > 0) || !std::isfinite(size(axis))) {
      throw InputError(
          fmt::format("box: size along {} is {} m; it must be positive and finite", axes[axis], size(axis)));
    }
    if (count < 1) {
      throw InputError(fmt::format("box: {} cells along {}; at least 1 is needed", count, axes[axis]));
    }
    bricks *= count;
  }
  // Ten nodes for each of six tetrahedra must still be counted by an int.
  if (bricks * 60 > INT_MAX) {
    throw InputError(fmt::format("box: {} x {} x {} cells are too many; at most {} bricks can be numbered", cells[0],
                                 cells[1], cells[2], INT_MAX / 60));
  }
}

Mesh box_vertices(const Eigen::Vector3d& size, const std::array<int, 3>& cells) {
  check_box(size, cells);
  Mesh mesh;
  mesh.source = "box";
  mesh.X.resize(3, static_cast<Eigen::Index>(cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1));
  Eigen::Index vertex = 0;
  for (int k = 0; k <= cells[2]; ++k) {
    for (int j = 0; j <= cells[1]; ++j) {
      for (int i = 0; i <= cells[0]; ++i) {
        mesh.X.col(vertex++) << size.x() * i / cells[0], size.y() * j / cells[1], size.z() * k / cells[2];
      }
    }
  }
  return mesh;
}

// Calls visit(corners) for each brick; corner c is displaced by bit 0 of c along x, bit 1 along y, bit 2 along z.
template <class Visit>
void for_each_brick(const std::array<int, 3>& cells, Visit visit) {
  const int row = cells[0] + 1;
  const int layer = row * (cells[1] + 1);
  for (int k = 0; k < cells[2]; ++k) {
    for (int j = 0; j < cells[1]; ++j) {
      for (int i = 0; i < cells[0]; ++i) {
        const int base = i + row * j + layer * k;
        std::array<int, 8> corners;
        for (int c = 0; c < 8; ++c) {
          corners[static_cast<size_t>(c)] = base + (c & 1) + row * ((c >> 1) & 1) + layer * (c >> 2);
        }
        visit(corners);
      }
    }
  }
}

}  // namespace

Mesh box_tets(const Eigen::Vector3d& size, const std::array<int, 3>& cells) {
  Mesh mesh = box_vertices(size, cells);
  mesh.element = Element::tet4;
  // Each tetrahedron follows one order of the axes from corner 0 to corner 7; odd orders are listed mirrored.
  constexpr int kTets[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
  for_each_brick(cells, [&](const std::array<int, 8>& corners) {
    for (const auto& tet : kTets) {
      for (const int corner : tet) mesh.cells.push_back(corners[static_cast<size_t>(corner)]);
    }
  });
  return mesh;
}

Mesh box_hexes(const Eigen::Vector3d& size, const std::array<int, 3>& cells) {
  Mesh mesh = box_vertices(size, cells);
  mesh.element = Element::hex8;
  constexpr size_t kVtkOrder[8] = {0, 1, 3, 2, 4, 5, 7, 6};
  for_each_brick(cells, [&](const std::array<int, 8>& corners) {
    for (const size_t corner : kVtkOrder) mesh.cells.push_back(corners[corner]);
  });
  return mesh;
}

Mesh to_tet10(const Mesh& mesh) {
  if (mesh.element != Element::tet4) {
    throw InputError(
        fmt::format("{}: only Tet4 meshes become Tet10, this one is {}", mesh.source, name_of(mesh.element)));
  }
  constexpr size_t kEdges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  Mesh quadratic;
  quadratic.element = Element::tet10;
  quadratic.source = mesh.source;
  quadratic.cells.reserve(static_cast<size_t>(mesh.cell_count()) * 10);
  std::unordered_map<std::uint64_t, int> middle_of;
  std::vector<std::array<int, 2>> edges;
  for (size_t cell = 0; cell < mesh.cells.size(); cell += 4) {
    const int* corners = &mesh.cells[cell];
    quadratic.cells.insert(quadratic.cells.end(), corners, corners + 4);
    for (const auto& edge : kEdges) {
      const int low = std::min(corners[edge[0]], corners[edge[1]]);
      const int high = std::max(corners[edge[0]], corners[edge[1]]);
      const std::uint64_t key = (static_cast<std::uint64_t>(low) << 32) | static_cast<std::uint32_t>(high);
      const auto [place, is_new] = middle_of.try_emplace(key, mesh.vertices() + static_cast<int>(edges.size()));
      if (is_new) edges.push_back({low, high});
      quadratic.cells.push_back(place->second);
    }
  }
  quadratic.X.resize(3, mesh.vertices() + static_cast<Eigen::Index>(edges.size()));
  quadratic.X.leftCols(mesh.vertices()) = mesh.X;
  for (size_t e = 0; e < edges.size(); ++e) {
    quadratic.X.col(mesh.vertices() + static_cast<Eigen::Index>(e)) =
        (mesh.X.col(edges[e][0]) + mesh.X.col(edges[e][1])) / 2;
  }
  return quadratic;
}

}  // namespace ergon
