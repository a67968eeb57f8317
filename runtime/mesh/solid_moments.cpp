#include "runtime/mesh/solid_moments.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "runtime/mesh/closed_surface.h"
#include "runtime/mesh/mesh_tools.h"

namespace ergon {

SolidMoments solid_moments(const Mesh& surface) {
  const auto bounds = bounding_box(surface);
  const Eigen::Vector3d middle = (bounds.col(0) + bounds.col(1)) / 2;  // near the matter, so that little cancels
  SolidMoments out{0, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()};
  for (const SurfacePart& part : closed_parts(surface)) {
    const double sign = part.depth % 2 == 0 ? 1 : -1;
    for (const auto& t : part.triangles) {
      Eigen::Matrix3d corners;
      for (int i = 0; i < 3; ++i) corners.col(i) = surface.X.col(t[static_cast<size_t>(i)]) - middle;
      const double volume = sign * corners.determinant() / 6;
      const Eigen::Vector3d sum = corners.rowwise().sum();
      out.volume += volume;
      out.center += volume / 4 * sum;
      // Of a tetrahedron: volume/20 (sum of x x' over its corners + the same of the sum of its corners).
      out.second += volume / 20 * (corners * corners.transpose() + sum * sum.transpose());
    }
  }
  out.center /= out.volume;
  out.second -= out.volume * out.center * out.center.transpose();
  out.center += middle;
  return out;
}

Eigen::Matrix<double, 3, 4> equimomental_points(const SolidMoments& moments) {
  Eigen::Matrix<double, 3, 4> corners;
  corners << 1, 1, -1, -1, 1, -1, -1, 1, 1, -1, 1, -1;  // of a cube: sqrt(3) e_k
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(moments.second / moments.volume);
  return (axes.operatorSqrt() * corners).colwise() + moments.center;
}

std::array<double, 4> barycentric(const Eigen::Matrix<double, 3, 4>& points, const Eigen::Vector3d& X) {
  Eigen::Matrix3d edges;
  for (int k = 0; k < 3; ++k) edges.col(k) = points.col(k + 1) - points.col(0);
  const Eigen::Vector3d w = edges.inverse() * (X - points.col(0));
  return {1 - w.sum(), w[0], w[1], w[2]};
}

}  // namespace ergon
