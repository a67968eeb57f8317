#pragma once
// Principal frames by Eigen, against which those of the runtime and the blocks of the compiler are tested.

#include <Eigen/Dense>
#include <vector>

namespace ergon::testing {

// F = U diag(s) V' with rotations; F of 3x3, 3x2 or 3x1 column by column.
struct DiagonalFrame {
  explicit DiagonalFrame(const std::vector<double>& f) : columns(static_cast<int>(f.size()) / 3) {
    const Eigen::Map<const Eigen::MatrixXd> F(f.data(), 3, columns);
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
    U = svd.matrixU(), V = svd.matrixV();
    s.assign(svd.singularValues().data(), svd.singularValues().data() + columns);
    if (columns == 3 && V.determinant() < 0) V.col(2) *= -1, s[2] = -s[2];
    if (U.determinant() < 0) {
      U.col(2) *= -1;
      if (columns == 3) s[2] = -s[2];
    }
  }

  // From the blocks of codegen/principal.h; column by column.
  std::vector<double> hessian(const std::vector<double>& blocks) const {
    const int n = 3 * columns, stretch = columns * (columns + 1) / 2, twists = columns * (columns - 1) / 2;
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(n, n);
    // u_i v_j' as a vector of the components of F.
    const auto e = [&](int i, int j) {
      const Eigen::MatrixXd m = U.col(i) * V.col(j).transpose();
      return Eigen::VectorXd(m.reshaped());
    };
    const auto block = [&](int at) { return blocks[static_cast<size_t>(at)]; };
    for (int i = 0, at = 0; i < columns; ++i)
      for (int j = 0; j <= i; ++j, ++at) {
        H += block(at) * e(i, i) * e(j, j).transpose();
        if (i != j) H += block(at) * e(j, j) * e(i, i).transpose();
      }
    for (int k = 0; k < twists; ++k) {
      const int i = columns == 3 ? (k + 1) % 3 : 0, j = columns == 3 ? (k + 2) % 3 : 1;
      const Eigen::VectorXd twist = (e(i, j) - e(j, i)) / std::sqrt(2.0), flip = (e(i, j) + e(j, i)) / std::sqrt(2.0);
      H += block(stretch + k) * twist * twist.transpose() + block(stretch + twists + k) * flip * flip.transpose();
    }
    for (int i = 0; columns < 3 && i < columns; ++i)
      for (int normal = columns; normal < 3; ++normal)
        H += block(stretch + 2 * twists + i) * e(normal, i) * e(normal, i).transpose();
    return {H.data(), H.data() + H.size()};
  }

  int columns;
  Eigen::MatrixXd U, V;
  std::vector<double> s;
};

}  // namespace ergon::testing
