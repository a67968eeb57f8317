#pragma once
// Elements: node counts, shape functions and quadrature, in one table.

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace ergon {

// Node order is that of VTK. The reference element is the unit simplex or, for Hex8, the unit cube [0, 1]^3.
enum class Element { point, edge2, tri3, tet4, tet10, hex8 };

int nodes_of(Element element);
int dimension_of(Element element);             // of the reference element: 0 to 3
std::string name_of(Element element);          // "Tet4"
Element element_named(std::string_view name);  // any capitalisation; throws InputError naming the nearest
int vtk_cell_type(Element element);

struct QuadratureRule {
  std::vector<Eigen::Vector3d> points;  // in the reference element
  std::vector<double> weights;          // sum is the reference volume
  int exactness = 0;                    // degree of polynomials integrated exactly
};

// The rule used for energies on this element unless another is asked for: the centroid (degree 1) for Edge2, Tri3 and
// Tet4; for Tet10 the four points of Hammer and Stroud 1956, Numerical Integration Over Simplices, MTAC 10 (degree 2);
// for Hex8 2x2x2 Gauss points (degree 3).
QuadratureRule default_quadrature(Element element);

// nodes x dimension: gradients of the shape functions at a reference point; and their values.
Eigen::MatrixXd shape_gradients(Element element, const Eigen::Vector3d& point);
Eigen::VectorXd shape_values(Element element, const Eigen::Vector3d& point);

}  // namespace ergon
