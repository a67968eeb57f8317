#include "runtime/mesh/element_faces.h"

#include <algorithm>

namespace ergon {
namespace {

// The plane of a face: origin + s*u + t*v, with u x v pointing outwards; s and t as on a triangle or a square.
struct FacePlane {
  Element full;  // has every node that a face of this shape may have
  Eigen::Vector3d origin, u, v;
};

std::vector<FacePlane> planes_of(ReferenceShape shape) {
  const Eigen::Vector3d o = Eigen::Vector3d::Zero(), x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  constexpr Element tri = Element::tri6, quad = Element::quad9;
  switch (shape) {
    case ReferenceShape::triangle:
      return {{tri, o, x, y}};
    case ReferenceShape::quadrilateral:
      return {{quad, o, x, y}};
    case ReferenceShape::tetrahedron:
      return {{tri, x, y - x, z - x}, {tri, o, z, y}, {tri, o, x, z}, {tri, o, y, x}};
    case ReferenceShape::hexahedron:
      return {{quad, o, y, x}, {quad, z, x, y},      {quad, o, x, z},
              {quad, x, y, z}, {quad, x + y, -x, z}, {quad, y, -y, z}};
    case ReferenceShape::prism:
      return {{tri, o, y, x}, {tri, z, x, y}, {quad, o, x, z}, {quad, x, y - x, z}, {quad, y, -y, z}};
    default:
      return {};
  }
}

// The node at a reference position, or -1.
int node_at(Element element, const Eigen::Vector3d& position) {
  const std::vector<Eigen::Vector3d>& nodes = reference_nodes(element);
  const auto found = std::find(nodes.begin(), nodes.end(), position);
  return found == nodes.end() ? -1 : static_cast<int>(found - nodes.begin());
}

std::vector<ElementFace> make_faces(Element element) {
  std::vector<ElementFace> faces;
  for (const FacePlane& plane : planes_of(shape_of(element))) {
    ElementFace face;
    face.corners = plane.full == Element::tri6 ? 3 : 4;
    for (const Eigen::Vector3d& p : reference_nodes(plane.full)) {
      const int node = node_at(element, plane.origin + p.x() * plane.u + p.y() * plane.v);
      if (node >= 0) face.nodes.push_back(node);
    }
    faces.push_back(face);
  }
  return faces;
}

}  // namespace

std::vector<std::array<int, 2>> corner_edges(Element element) {
  if (dimension_of(element) == 1) return {{0, 1}};
  std::vector<std::array<int, 2>> edges;
  for (const ElementFace& face : faces_of(element)) {
    for (int i = 0; i < face.corners; ++i) {
      const int a = face.nodes[static_cast<size_t>(i)], b = face.nodes[static_cast<size_t>((i + 1) % face.corners)];
      edges.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

const std::vector<ElementFace>& faces_of(Element element) {
  static const std::vector<std::vector<ElementFace>> all = [] {
    std::vector<std::vector<ElementFace>> made;
    for (const Element each : all_elements()) made.push_back(make_faces(each));
    return made;
  }();
  return all[static_cast<size_t>(element)];
}

void append_triangles(const ElementFace& face, const std::vector<int>& vertices,
                      std::vector<std::array<int, 3>>& triangles) {
  const auto corners = static_cast<size_t>(face.corners);
  const bool middles = vertices.size() >= 2 * corners, centre = vertices.size() % 2 == 1 && corners == 4;
  const auto corner = [&](size_t i) { return vertices[i % corners]; };
  const auto middle = [&](size_t i) { return vertices[corners + i % corners]; };
  // What is left inside once each corner with its two middles is cut off.
  std::vector<int> inner(corners);
  for (size_t i = 0; i < corners; ++i) inner[i] = middles ? middle(i) : corner(i);
  for (size_t i = 0; middles && i < corners; ++i) {
    if (centre) {
      triangles.push_back({corner(i), middle(i), vertices.back()});
      triangles.push_back({corner(i), vertices.back(), middle(i + corners - 1)});
    } else {
      triangles.push_back({corner(i), middle(i), middle(i + corners - 1)});
    }
  }
  if (centre) return;
  if (corners == 3) {
    triangles.push_back({inner[0], inner[1], inner[2]});
    return;
  }
  const auto first = static_cast<size_t>(std::min_element(inner.begin(), inner.end()) - inner.begin());
  const auto at = [&](size_t i) { return inner[(first + i) % 4]; };
  triangles.push_back({at(0), at(1), at(2)});
  triangles.push_back({at(0), at(2), at(3)});
}

}  // namespace ergon
