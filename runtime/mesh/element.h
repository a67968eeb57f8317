#pragma once
// Elements: reference shapes, nodes and shape functions. Everything is derived from one table of node coordinates.

#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace ergon {

// Node order is that of VTK: corners, then the nodes amid edges, faces and the cell. Prism6 is oriented as VTK's
// parametric coordinates of a wedge are (as Gmsh's prism): from its last triangle the first is seen counter-clockwise.
enum class Element { point, edge2, edge3, tri3, tri6, quad4, quad9, tet4, tet10, hex8, hex20, hex27, prism6 };

// Products of unit simplices: [0, 1], the triangle x + y <= 1, the square [0, 1]^2, the tetrahedron x + y + z <= 1, the
// cube [0, 1]^3, triangle times [0, 1].
enum class ReferenceShape { point, edge, triangle, quadrilateral, tetrahedron, hexahedron, prism };

const std::vector<Element>& all_elements();
int nodes_of(Element element);
int dimension_of(Element element);  // of the reference element: 0 to 3
int degree_of(Element element);     // 1 or 2: of the polynomials along an edge; 0 for a point
ReferenceShape shape_of(Element element);
std::string name_of(Element element);          // "Tet4"
Element element_named(std::string_view name);  // any capitalisation; throws InputError naming the nearest
int vtk_cell_type(Element element);            // vtkCellType.h

// Whether gradients of the shape functions are the same at all points: the map to the rest shape is affine.
bool has_constant_gradients(Element element);

// Nodes in the reference element.
const std::vector<Eigen::Vector3d>& reference_nodes(Element element);

// nodes x dimension: gradients of the shape functions at a reference point; and their values. The shape functions span
// all polynomials of total degree k (simplices) or of degree k along each axis (squares and cubes), k = degree_of; a
// prism's are products of both. Those of Hex20 span the polynomials of superlinear degree 2 (Arnold, Awanou 2011, The
// serendipity family of finite elements, Foundations of Computational Mathematics 11).
Eigen::MatrixXd shape_gradients(Element element, const Eigen::Vector3d& point);
Eigen::VectorXd shape_values(Element element, const Eigen::Vector3d& point);

}  // namespace ergon
