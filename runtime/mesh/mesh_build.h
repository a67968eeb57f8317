#pragma once
// Meshes made from numbers: every cell is positively oriented, and neighbours share their faces.

#include <array>

#include "runtime/mesh/mesh.h"

namespace ergon {

// A box from the origin to `size` (m), cut into cells[0] x cells[1] x cells[2] bricks, and these into elements: one
// hexahedron, two prisms, or six tetrahedra around the diagonal from the lowest to the highest corner (Kuhn's
// subdivision). Triangles (two to a cell) and quadrilaterals fill the rectangle z = 0 seen from above, edges the x
// axis; sizes and cells beyond the element's dimension are not used. Vertices run fastest along x, then y. Throws
// InputError when a size is not positive and finite, a cell count is below 1, or the element is a point.
Mesh box_mesh(Element element, const Eigen::Vector3d& size, const std::array<int, 3>& cells);
int elements_per_brick(Element element);  // 0 for a point

// A rectangle of triangles, as above but for its diagonals: they turn from brick to brick, so that no direction is
// preferred. For Tri3 and Tri6.
Mesh alternating_triangles(Element element, const Eigen::Vector3d& size, const std::array<int, 3>& cells);

inline Mesh box_tets(const Eigen::Vector3d& size, const std::array<int, 3>& cells) {
  return box_mesh(Element::tet4, size, cells);
}
inline Mesh box_hexes(const Eigen::Vector3d& size, const std::array<int, 3>& cells) {
  return box_mesh(Element::hex8, size, cells);
}

// The element of degree 1 on the same reference shape.
Element linear_element(Element element);

// The same cells with the nodes of an element of degree 2: those added lie amid edges, faces and cells as they are, and
// follow the corners, which keep their numbers. Throws InputError unless the mesh is of linear_element(element).
Mesh to_quadratic(const Mesh& mesh, Element element);

}  // namespace ergon
