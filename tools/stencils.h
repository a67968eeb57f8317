#pragma once
// Stencils of every geometry to measure kernels on. Deterministic.

#include <string_view>
#include <vector>

#include "runtime/mesh/mesh.h"

namespace ergon {

struct StencilSample {
  Mesh mesh;  // where the points are
  std::vector<int> stencils;
};

// About 3*cells^3 stencils of the geometry in a cube of 1 m. Those of pairs (contact) lie between neighbours among
// cells + 1 sheets of triangles, 1/cells apart: "point_triangle": each vertex with the triangles that it projects into,
// below and above; "point_edge" and "point_point": with an edge and a corner of these; "edge_edge": edges that cross in
// projection. "hinge", "patch", "shell_triangle" (tips of normals are vertices of the next sheet), "rod_corner" (five
// points of a patch), "triangle" and "corner" (three points of a triangle): of the sheets; "point", "edge" and
// "tetrahedron": of the cube cut into tetrahedra. Throws InputError for cells < 1 and other geometries.
StencilSample sample_stencils(std::string_view geometry, int cells);

}  // namespace ergon
