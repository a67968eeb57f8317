#pragma once
// What a mesh at rest tells: its boundary, whether it is sound, volumes and masses; and copies of it that are moved or
// reordered. All functions leave their argument as it is.

#include <array>
#include <vector>

#include "runtime/mesh/mesh.h"

namespace ergon {

// The boundary of a solid mesh as triangles of its own vertices, seen counter-clockwise from outside: faces that belong
// to one cell only, in the order of their cells, cut through all their nodes (append_triangles). Of a mesh of triangles
// or quadrilaterals, all its cells. Throws InputError for points and edges.
std::vector<std::array<int, 3>> surface_triangles(const Mesh& mesh);

// Throws InputError unless every coordinate is finite, every cell names existing and different vertices, and every cell
// is positively oriented and not flat: its volume factor at the points of quadrature and nodes exceeds 1e-12 of the
// cube (square, length) of its extent. A membrane or line must not be turned back against its centre. The message names
// the first such cell, its volume and the number of them.
void check_mesh(const Mesh& mesh, int exactness);  // of the quadrature
void check_mesh(const Mesh& mesh);                 // the default one

// Volume of each cell: m^3 for solids (exact, also where curved), m^2 for membranes, m for lines, 1 for points. Solids
// are signed: negative when inverted.
std::vector<double> rest_volumes(const Mesh& mesh);

// Mass of each vertex, kg. `density` is in kg/m^3 for solids, kg/m^2 for membranes, kg/m for lines, kg for points.
// Positive on every sound cell: row sums of the consistent mass matrix where shape functions are nowhere negative
// (degree 1); its diagonal, scaled to keep the cell's mass, on elements of degree 2, whose row sums may be negative
// (Hinton, Rock, Zienkiewicz 1976, A note on mass lumping and related processes in the finite element method,
// Earthquake Engineering and Structural Dynamics 4; a straight Tet10: corners 1/36, mid-edges 4/27). Throws InputError
// unless the density is positive and finite.
Eigen::VectorXd lumped_masses(const Mesh& mesh, double density);

// The same mesh with its cells along a Hilbert curve through their centres and its vertices in order of first use
// (vertices of no cell last), so that what is near in space is near in memory.
struct ReorderedMesh {
  Mesh mesh;
  std::vector<int> cell_from;    // new cell i was cell_from[i]
  std::vector<int> vertex_from;  // new vertex i was vertex_from[i]
};
ReorderedMesh spatial_order(const Mesh& mesh);

// X -> rotation * (scale * X) + translation.
struct Transform {
  double scale = 1;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();        // of any length but zero
  double angle = 0;                                       // rad
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  // m
};
// Throws InputError unless scale is positive, the axis is not zero and all numbers are finite.
Mesh transformed(const Mesh& mesh, const Transform& transform);

// Vertices with lower <= X <= upper in every coordinate, in ascending order.
std::vector<int> vertices_in_box(const Mesh& mesh, const Eigen::Vector3d& lower, const Eigen::Vector3d& upper);

// Smallest and largest coordinates, as columns 0 and 1. The mesh must have a vertex.
Eigen::Matrix<double, 3, 2> bounding_box(const Mesh& mesh);

}  // namespace ergon
