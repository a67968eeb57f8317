#pragma once
// Meshes made from numbers: every cell is positively oriented, and neighbours share their faces.

#include <array>

#include "runtime/mesh/mesh.h"

namespace ergon {

// A box from the origin to `size` (m), cut into cells[0] x cells[1] x cells[2] bricks, each of six tetrahedra around
// the brick's diagonal from its lowest to its highest corner (Kuhn's subdivision). Vertices run fastest along x, then
// y. Throws InputError when a size is not positive and finite or a cell count is below 1.
Mesh box_tets(const Eigen::Vector3d& size, const std::array<int, 3>& cells);

// The same bricks as hexahedra, with the same vertices.
Mesh box_hexes(const Eigen::Vector3d& size, const std::array<int, 3>& cells);

// Adds a node in the middle of each edge of a Tet4 mesh. The corners keep their numbers.
Mesh to_tet10(const Mesh& mesh);

}  // namespace ergon
