#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "runtime/error.h"
#include "runtime/mesh/element_faces.h"
#include "runtime/mesh/mesh_tools.h"

namespace ergon {
namespace {

// A face of the mesh by its sorted corners; the fourth of a triangle sorts last.
struct FaceKey {
  std::array<int, 4> corners;
  std::uint32_t cell;
  std::uint32_t face;
  bool operator<(const FaceKey& other) const { return corners < other.corners; }
};

std::vector<int> vertices_of(const ElementFace& face, const int* cell) {
  std::vector<int> vertices;
  for (const int node : face.nodes) vertices.push_back(cell[node]);
  return vertices;
}

}  // namespace

std::vector<std::array<int, 3>> surface_triangles(const Mesh& mesh) {
  std::vector<std::array<int, 3>> triangles;
  const std::vector<ElementFace>& faces = faces_of(mesh.element);
  if (faces.empty()) {
    throw InputError(fmt::format("{}: a {} mesh has no surface", mesh.source, name_of(mesh.element)));
  }
  const size_t nodes = static_cast<size_t>(nodes_of(mesh.element));
  const size_t cells = mesh.cells.size() / nodes;
  if (dimension_of(mesh.element) == 2) {
    for (size_t c = 0; c < cells; ++c) {
      append_triangles(faces[0], vertices_of(faces[0], &mesh.cells[c * nodes]), triangles);
    }
    return triangles;
  }
  std::vector<FaceKey> keys;
  keys.reserve(cells * faces.size());
  for (size_t c = 0; c < cells; ++c) {
    for (size_t f = 0; f < faces.size(); ++f) {
      std::array<int, 4> corners;
      corners.fill(std::numeric_limits<int>::max());
      for (size_t i = 0; i < static_cast<size_t>(faces[f].corners); ++i) {
        corners[i] = mesh.cells[c * nodes + static_cast<size_t>(faces[f].nodes[i])];
      }
      std::sort(corners.begin(), corners.end());
      keys.push_back({corners, static_cast<std::uint32_t>(c), static_cast<std::uint32_t>(f)});
    }
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::array<std::uint32_t, 2>> boundary;
  for (size_t i = 0; i < keys.size();) {
    size_t next = i + 1;
    while (next < keys.size() && keys[next].corners == keys[i].corners) ++next;
    if (next == i + 1) boundary.push_back({keys[i].cell, keys[i].face});
    i = next;
  }
  std::sort(boundary.begin(), boundary.end());
  for (const auto& [cell, face] : boundary) {
    append_triangles(faces[face], vertices_of(faces[face], &mesh.cells[cell * nodes]), triangles);
  }
  return triangles;
}

}  // namespace ergon
