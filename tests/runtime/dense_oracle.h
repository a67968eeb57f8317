#pragma once
// Value, gradient and Hessian of a sum of laws by the shortest way: dense matrices, one stencil at a time, Eigen's
// eigen-decomposition.

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <vector>

#include "runtime/block_matrix.h"
#include "runtime/mesh/mesh.h"
#include "runtime/mesh/quadrature.h"
#include "runtime/potential.h"
#include "tests/runtime/jet_kernels.h"

namespace ergon::testing {

struct Dense {
  double value = 0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
  long indefinite = 0;

  explicit Dense(int vertices)
      : gradient(Eigen::VectorXd::Zero(3 * vertices)), hessian(Eigen::MatrixXd::Zero(3 * vertices, 3 * vertices)) {}

  // weights: vectors x points.
  template <class Law>
  void add(const Eigen::Matrix3Xd& x, const int* vertices, const Eigen::MatrixXd& weights, double volume,
           const double* data, const double* params, Projection projection) {
    constexpr int kSize = 3 * Law::kVectors;
    using J = Jet<kSize>;
    const auto points = weights.cols();
    Eigen::MatrixXd B = Eigen::MatrixXd::Zero(kSize, 3 * points);
    Eigen::VectorXd local(3 * points);
    std::vector<int> rows;
    for (Eigen::Index a = 0; a < points; ++a) {
      for (int k = 0; k < Law::kVectors; ++k) B.block<3, 3>(3 * k, 3 * a) = weights(k, a) * Eigen::Matrix3d::Identity();
      local.segment<3>(3 * a) = x.col(vertices[a]);
      for (int c = 0; c < 3; ++c) rows.push_back(3 * vertices[a] + c);
    }
    const Eigen::VectorXd q = B * local;
    J variables[kSize];
    for (int i = 0; i < kSize; ++i) variables[i] = J::variable(q(i), i);
    const J psi = Law::psi(variables, data, params);
    Eigen::MatrixXd H = psi.h;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(H);
    if (projection != Projection::none && eigen.eigenvalues()(0) < -1e-12 * H.norm()) {
      ++indefinite;
      const Eigen::VectorXd l = eigen.eigenvalues();
      const Eigen::VectorXd kept = projection == Projection::clamp ? l.cwiseMax(0).eval() : l.cwiseAbs().eval();
      H = eigen.eigenvectors() * kept.asDiagonal() * eigen.eigenvectors().transpose();
    }
    value += volume * psi.v;
    gradient(rows) += volume * (B.transpose() * psi.g);
    hessian(rows, rows) += volume * (B.transpose() * H * B);
  }

  // A stencil energy; data: Law::kRaw values per stencil.
  template <class Law>
  void add_stencils(const Eigen::Matrix3Xd& x, const std::vector<int>& stencils, const std::vector<double>& data,
                    const std::vector<double>& params, Projection projection) {
    Eigen::MatrixXd weights(Law::kVectors, Law::kPoints);
    for (int k = 0; k < Law::kVectors; ++k) {
      for (int a = 0; a < Law::kPoints; ++a) weights(k, a) = Law::kWeights[static_cast<size_t>(k * Law::kPoints + a)];
    }
    for (size_t s = 0; s < stencils.size() / Law::kPoints; ++s) {
      add<Law>(x, stencils.data() + s * Law::kPoints, weights, 1, data.data() + s * Law::kRaw, params.data(),
               projection);
    }
  }

  // A density on a solid mesh.
  template <class Law>
  void add_solid(const Eigen::Matrix3Xd& x, const Mesh& mesh, int first_vertex, const std::vector<double>& params,
                 Projection projection) {
    const QuadratureRule rule = default_quadrature(mesh.element);
    const int n = nodes_of(mesh.element);
    for (int cell = 0; cell < mesh.cell_count(); ++cell) {
      std::vector<int> vertices(mesh.cells.begin() + cell * n, mesh.cells.begin() + (cell + 1) * n);
      Eigen::MatrixXd X(3, n);
      for (int a = 0; a < n; ++a) X.col(a) = mesh.X.col(vertices[static_cast<size_t>(a)]);
      for (int& v : vertices) v += first_vertex;
      for (size_t p = 0; p < rule.points.size(); ++p) {
        const Eigen::MatrixXd dN = shape_gradients(mesh.element, rule.points[p]);
        const Eigen::Matrix3d map = X * dN;
        add<Law>(x, vertices.data(), (dN * map.inverse()).transpose(), map.determinant() * rule.weights[p], nullptr,
                 params.data(), projection);
      }
    }
  }

  // Without the rows and columns of fixed vertices.
  Eigen::MatrixXd free_hessian(const std::vector<char>& fixed) const {
    std::vector<int> rows;
    for (size_t v = 0; v < fixed.size(); ++v) {
      for (int c = 0; c < 3 && fixed[v] == 0; ++c) rows.push_back(3 * static_cast<int>(v) + c);
    }
    return hessian(rows, rows);
  }
};

inline Eigen::MatrixXd to_dense(const BlockMatrix& matrix) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(matrix.rows(), matrix.rows());
  for (int column = 0; column < matrix.rows(); ++column) {
    for (int k = matrix.column_start()[static_cast<size_t>(column)];
         k < matrix.column_start()[static_cast<size_t>(column) + 1]; ++k) {
      const int row = matrix.row_index()[static_cast<size_t>(k)];
      if (row >= column) dense(row, column) = dense(column, row) = matrix.values()[static_cast<size_t>(k)];
    }
  }
  return dense;
}

// Relative to the largest entry of b.
inline double difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols()) return std::numeric_limits<double>::infinity();
  return b.size() == 0 ? 0 : (a - b).cwiseAbs().maxCoeff() / std::max(b.cwiseAbs().maxCoeff(), 1e-300);
}

}  // namespace ergon::testing
