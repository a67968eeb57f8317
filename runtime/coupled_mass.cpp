#include "runtime/coupled_mass.h"

namespace ergon {
namespace {

constexpr long worth_threads = 1 << 16;  // entries

}  // namespace

void add_product(const CoupledMass::Matrix& matrix, const Eigen::Matrix3Xd& field, double factor,
                 Eigen::Matrix3Xd& sum) {
  if (matrix.nonZeros() == 0) return;
#pragma omp parallel for schedule(static) if (matrix.nonZeros() > worth_threads)
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Eigen::Vector3d row = Eigen::Vector3d::Zero();
    for (CoupledMass::Matrix::InnerIterator entry(matrix, i); entry; ++entry)
      row += entry.value() * field.col(entry.col());
    sum.col(i) += factor * row;
  }
}

}  // namespace ergon
