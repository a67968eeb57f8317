#include "runtime/block_matrix.h"

#include <algorithm>

namespace ergon {

BlockMatrix::BlockMatrix() {
  static const auto empty = std::make_shared<const BlockPattern>();
  pattern_ = empty;
}

BlockMatrix::BlockMatrix(int block_rows, const std::vector<std::pair<int, int>>& pairs) {
  PatternBuilder builder;
  for (const auto& [i, j] : pairs) builder.add(std::max(i, j), std::min(i, j));
  const auto made = std::make_shared<BlockPattern>();
  builder.build(block_rows, nullptr, {}, *made);
  set_pattern(made);
  set_zero();
}

void BlockMatrix::set_pattern(std::shared_ptr<const BlockPattern> pattern) {
  pattern_ = std::move(pattern);
  const size_t size = 9 * pattern_->blocks();
  if (size > values_.capacity()) {
    values_.clear();
    values_.reserve(size + size / 8);  // patterns that grow do so again and again
  }
  values_.resize(size);
}

ptrdiff_t BlockMatrix::find(int i, int j) const {
  const int index = index_of(i, j);
  return index < 0 ? -1 : start_of(index, j);
}

void BlockMatrix::set_zero() { std::fill(values_.begin(), values_.end(), 0.0); }

void BlockMatrix::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  y.setZero(rows());
  const double* X = x.data();
  double* Y = y.data();
  for (int j = 0; j < block_rows(); ++j) {
    const double* a0 = values_.data() + column_start()[3 * static_cast<size_t>(j)];
    const int stride = column_stride(j);
    const double* a1 = a0 + stride;
    const double* a2 = a1 + stride;
    const double x0 = X[3 * j], x1 = X[3 * j + 1], x2 = X[3 * j + 2];
    double y0 = a0[0] * x0 + a0[1] * x1 + a0[2] * x2;
    double y1 = a0[1] * x0 + a1[1] * x1 + a1[2] * x2;
    double y2 = a0[2] * x0 + a1[2] * x1 + a2[2] * x2;
    const int* row = pattern_->block_row.data() + pattern_->block_start[static_cast<size_t>(j)];
    for (int k = 3; k < stride; k += 3) {
      const int i = 3 * *++row;
      const double z0 = X[i], z1 = X[i + 1], z2 = X[i + 2];
      Y[i] += a0[k] * x0 + a1[k] * x1 + a2[k] * x2;
      Y[i + 1] += a0[k + 1] * x0 + a1[k + 1] * x1 + a2[k + 1] * x2;
      Y[i + 2] += a0[k + 2] * x0 + a1[k + 2] * x1 + a2[k + 2] * x2;
      y0 += a0[k] * z0 + a0[k + 1] * z1 + a0[k + 2] * z2;
      y1 += a1[k] * z0 + a1[k + 1] * z1 + a1[k + 2] * z2;
      y2 += a2[k] * z0 + a2[k + 1] * z1 + a2[k + 2] * z2;
    }
    Y[3 * j] += y0;
    Y[3 * j + 1] += y1;
    Y[3 * j + 2] += y2;
  }
}

}  // namespace ergon
