#pragma once
// Mass that vertices share, and damping in proportion to it: matrices of one number for each pair of vertices, the
// same for all axes. It establishes their products with fields over vertices, on all cores and the same on any number
// of them.

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace ergon {

struct CoupledMass {
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  Matrix mass;            // kg, vertices x vertices, symmetric; rows of vertices whose mass is their own are empty
  Matrix drag;            // kg/s, of the same shape, or without entries
  Eigen::VectorXd bound;  // kg, per vertex: mass - diag(bound) is positive semi-definite; above 0 where a row is

  bool empty() const { return mass.nonZeros() == 0; }
  bool couples(int vertex) const { return !empty() && bound[vertex] > 0; }
};

// Adds factor * matrix * field, column i of which is sum_j m_ij field_j; 3 x vertices.
void add_product(const CoupledMass::Matrix& matrix, const Eigen::Matrix3Xd& field, double factor,
                 Eigen::Matrix3Xd& sum);

}  // namespace ergon
