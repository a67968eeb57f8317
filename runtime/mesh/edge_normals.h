#pragma once
// Normals amid the edges of a surface: further points of a shell, of which laws over a "shell_triangle" know.

#include <Eigen/Core>
#include <vector>

#include "runtime/mesh/mesh.h"

namespace ergon {

// m, 3 x edges: the tips of the normals at rest, in the order of the "edge" stencils. A normal is as long as its edge,
// begins amid it, and halves the angle between the triangles on its two sides. Where triangles are turned over, or an
// edge has more than two, it is that of the triangle named first. Throws InputError for cells that are no Tri3.
Eigen::Matrix3Xd edge_normal_tips(const Mesh& mesh);

// The edges, by their place among the "edge" stencils, that have a triangle of which all vertices are chosen.
std::vector<int> edges_of_triangles_within(const Mesh& mesh, const std::vector<int>& vertices);

// The share of the rest area that is an edge's: a third of each of its triangles; m^2, by edge.
Eigen::VectorXd edge_areas(const Mesh& mesh);

}  // namespace ergon
