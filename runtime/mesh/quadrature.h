#pragma once
// Quadrature on reference elements, selected by exactness. All weights are positive and all points are inside.

#include <vector>

#include "runtime/mesh/element.h"

namespace ergon {

struct QuadratureRule {
  std::vector<Eigen::Vector3d> points;  // in the reference element
  std::vector<double> weights;          // sum is the reference volume
  int exactness = 0;                    // total degree of polynomials integrated exactly
};

constexpr int kMaxExactness = 11;  // six points along an axis

// The rule for an element with the fewest points whose exactness is at least the given one. Throws InputError unless
// that is 0 to kMaxExactness. Products of Gauss points on edges, squares, cubes and prisms (n points along an axis: 2n
// - 1). On simplices of degree 2 the three and four points of Hammer and Stroud 1956, Numerical Integration Over
// Simplices, MTAC 10; otherwise conical products of Gauss-Jacobi points (Karniadakis, Sherwin 2005, Spectral/hp Element
// Methods for Computational Fluid Dynamics).
QuadratureRule quadrature(Element element, int exactness);

// What integrates the stiffness of the element exactly where its map from the reference element is affine: products of
// two gradients of shape functions. No rule with fewer points is stable on all of them: one point on Hex8, 2x2x2 on
// Hex20 or Hex27, leave deformations without energy.
int default_exactness(Element element);
QuadratureRule default_quadrature(Element element);

// Gauss points on [0, 1] for the weight (1 - t)^power; exact to degree 2n - 1.
struct GaussPoints {
  std::vector<double> points;
  std::vector<double> weights;
};
GaussPoints gauss_points(int n, int power = 0);

}  // namespace ergon
