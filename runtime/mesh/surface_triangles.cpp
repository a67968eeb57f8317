#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "runtime/error.h"
#include "runtime/mesh/mesh_tools.h"

namespace ergon {
namespace {

// The faces of one cell, corner nodes counter-clockwise seen from outside. For Tet10, `middles` are the nodes between
// corner i and corner i + 1.
struct Face {
  int corners;
  std::array<size_t, 4> corner;
  std::array<size_t, 3> middle;
};

constexpr std::array<Face, 4> kTetFaces{
    {{3, {1, 2, 3}, {5, 9, 8}}, {3, {0, 3, 2}, {7, 9, 6}}, {3, {0, 1, 3}, {4, 8, 7}}, {3, {0, 2, 1}, {6, 5, 4}}}};
constexpr std::array<Face, 6> kHexFaces{{{4, {0, 3, 2, 1}, {}},
                                         {4, {4, 5, 6, 7}, {}},
                                         {4, {0, 1, 5, 4}, {}},
                                         {4, {1, 2, 6, 5}, {}},
                                         {4, {2, 3, 7, 6}, {}},
                                         {4, {3, 0, 4, 7}, {}}}};

// A face of the mesh by its sorted corners; for a quadrilateral its three lowest corners are enough to tell it apart
// from any other face that could share a cell's boundary with it.
struct FaceKey {
  std::array<int, 3> corners;
  std::uint32_t cell;
  std::uint32_t face;
  bool operator<(const FaceKey& other) const { return corners < other.corners; }
};

void append(const Face& face, const int* nodes, Element element, std::vector<std::array<int, 3>>& triangles) {
  std::array<int, 4> v{};
  for (size_t i = 0; i < static_cast<size_t>(face.corners); ++i) v[i] = nodes[face.corner[i]];
  if (element == Element::hex8) {
    const size_t first = static_cast<size_t>(std::min_element(v.begin(), v.end()) - v.begin());
    const auto at = [&](size_t i) { return v[(first + i) % 4]; };
    triangles.push_back({at(0), at(1), at(2)});
    triangles.push_back({at(0), at(2), at(3)});
  } else if (element == Element::tet10) {
    const int a = nodes[face.middle[0]], b = nodes[face.middle[1]], c = nodes[face.middle[2]];
    triangles.push_back({v[0], a, c});
    triangles.push_back({a, v[1], b});
    triangles.push_back({c, b, v[2]});
    triangles.push_back({a, b, c});
  } else {
    triangles.push_back({v[0], v[1], v[2]});
  }
}

}  // namespace

std::vector<std::array<int, 3>> surface_triangles(const Mesh& mesh) {
  std::vector<std::array<int, 3>> triangles;
  const size_t nodes = static_cast<size_t>(nodes_of(mesh.element));
  const size_t cells = mesh.cells.size() / nodes;
  if (mesh.element == Element::tri3) {
    for (size_t c = 0; c < cells; ++c)
      triangles.push_back({mesh.cells[3 * c], mesh.cells[3 * c + 1], mesh.cells[3 * c + 2]});
    return triangles;
  }
  if (dimension_of(mesh.element) != 3) {
    throw InputError(fmt::format("{}: a {} mesh has no surface", mesh.source, name_of(mesh.element)));
  }
  const bool hex = mesh.element == Element::hex8;
  const Face* faces = hex ? kHexFaces.data() : kTetFaces.data();
  const std::uint32_t face_count = hex ? 6 : 4;
  std::vector<FaceKey> keys;
  keys.reserve(cells * face_count);
  for (size_t c = 0; c < cells; ++c) {
    for (std::uint32_t f = 0; f < face_count; ++f) {
      std::array<int, 4> corners;
      corners.fill(std::numeric_limits<int>::max());  // a triangle's missing corner sorts last
      for (size_t i = 0; i < static_cast<size_t>(faces[f].corners); ++i) {
        corners[i] = mesh.cells[c * nodes + faces[f].corner[i]];
      }
      std::sort(corners.begin(), corners.end());
      keys.push_back({{corners[0], corners[1], corners[2]}, static_cast<std::uint32_t>(c), f});
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
  for (const auto& [cell, face] : boundary) append(faces[face], &mesh.cells[cell * nodes], mesh.element, triangles);
  return triangles;
}

}  // namespace ergon
