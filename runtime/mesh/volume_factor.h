#pragma once
// The map from a reference element to the rest shape of a cell, at a point.

#include <Eigen/Geometry>
#include <vector>

#include "runtime/mesh/mesh.h"

namespace ergon {

using CellJacobian = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3>;

// At a point with the given shape gradients. `nodes`: of the cell, in the mesh.
inline CellJacobian jacobian_at(const Mesh& mesh, const int* nodes, const Eigen::MatrixXd& gradients) {
  CellJacobian jacobian = CellJacobian::Zero(3, gradients.cols());
  for (Eigen::Index i = 0; i < gradients.rows(); ++i) jacobian += mesh.X.col(nodes[i]) * gradients.row(i);
  return jacobian;
}

// Ratio of rest to reference volume; signed for solids.
inline double volume_factor(const CellJacobian& jacobian) {
  switch (jacobian.cols()) {
    case 3:
      return jacobian.determinant();
    case 2:
      return Eigen::Vector3d(jacobian.col(0)).cross(Eigen::Vector3d(jacobian.col(1))).norm();
    case 1:
      return jacobian.col(0).norm();
    default:
      return 1;
  }
}

inline double volume_factor(const Mesh& mesh, const int* nodes, const Eigen::MatrixXd& gradients) {
  return volume_factor(jacobian_at(mesh, nodes, gradients));
}

inline std::vector<Eigen::MatrixXd> gradients_at(Element element, const std::vector<Eigen::Vector3d>& points) {
  std::vector<Eigen::MatrixXd> gradients;
  gradients.reserve(points.size());
  for (const Eigen::Vector3d& point : points) gradients.push_back(shape_gradients(element, point));
  return gradients;
}

}  // namespace ergon
