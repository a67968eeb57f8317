#pragma once
// The stencils that a mesh has, by kind, and their sizes at rest. It establishes the one table of both: a law names a
// kind and the data it needs, and knows of no mesh.

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/mesh/mesh.h"

namespace ergon {

// The points of the stencils of a kind, one stencil after the other: "point": each vertex that a cell names; "edge":
// each edge between corners of cells, once, lower vertex first; "corner": two edges of a line that share the middle
// point, in the order of the cells where a line passes through; "triangle" and "tetrahedron": the cells; "hinge": an
// edge and the corners opposite to it of two triangles, in the order of `dihedral`: an edge of more triangles makes a
// hinge of every two; "patch": each triangle and what lies across its edges, x3, x4, x5 opposite to x0, x1, x2, with
// any near vertex where nothing does; "shell_triangle": each triangle and the tips of the normals amid the edges
// opposite to x0, x1, x2 (runtime/mesh/edge_normals.h); "rod_corner": a corner and the twists of its edges
// (runtime/mesh/rod_frames.h). Throws InputError for other kinds, and for cells of an element that has none of the
// kind.
std::vector<int> stencils_on_mesh(std::string_view kind, const Mesh& mesh);

// The kinds of all stencils, in the order above, and those that cells of an element have.
std::vector<std::string> stencil_kinds();
std::vector<std::string> stencil_kinds(Element element);
// "Tri3", "any": the elements whose cells have stencils of a kind.
std::string elements_with(std::string_view kind);

// A size of a stencil at rest, by the name that rest data has: the length, area or volume of the simplex of some of its
// points, or whether they are the corners of a cell (1 or 0). Lengths are L of an edge, L0 and L1 of the edges of a
// corner or rod_corner, L of the edge of a hinge; areas are A of a triangle or shell_triangle, A0 and A1 of the
// triangles of a hinge with x2 and x3; V is the volume of a tetrahedron; inner0, inner1, inner2 tell of a patch whether
// a triangle lies across the edge opposite to x0, x1, x2.
struct RestSize {
  std::string name;
  std::vector<int> points;  // places in the stencil
  bool is_cell = false;     // not a size, but whether there is such a cell
  int dimension() const { return is_cell ? 0 : static_cast<int>(points.size()) - 1; }
};
std::vector<RestSize> rest_sizes(std::string_view kind);

// In m^dimension, one per stencil of the mesh.
std::vector<double> rest_size_of(const RestSize& size, std::string_view kind, const std::vector<int>& stencils,
                                 const Mesh& mesh);

}  // namespace ergon
