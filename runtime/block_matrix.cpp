#include "runtime/block_matrix.h"

#include <algorithm>
#include <atomic>
#include <numeric>

namespace ergon {
namespace {

// Number of the next pattern; 0 is the empty matrix.
std::atomic<unsigned long> next_pattern{1};

}  // namespace

BlockMatrix::BlockMatrix(int block_rows, const std::vector<std::pair<int, int>>& pairs)
    : block_rows_(block_rows), pattern_id_(next_pattern++) {
  const auto n = static_cast<size_t>(block_rows);
  // Bucket the rows by column, the diagonal first.
  std::vector<size_t> start(n + 1, 0);
  for (const auto& [i, j] : pairs) start[static_cast<size_t>(std::min(i, j)) + 1] += i != j;
  for (size_t j = 0; j < n; ++j) start[j + 1] += start[j] + 1;
  std::vector<int> rows(start[n]);
  std::vector<size_t> fill(start.begin(), start.end() - 1);
  for (size_t j = 0; j < n; ++j) rows[fill[j]++] = static_cast<int>(j);
  for (const auto& [i, j] : pairs) {
    if (i != j) rows[fill[static_cast<size_t>(std::min(i, j))]++] = std::max(i, j);
  }
  block_start_.resize(n + 1, 0);
  block_row_.reserve(rows.size());
  for (size_t j = 0; j < n; ++j) {
    const auto first = rows.begin() + static_cast<ptrdiff_t>(start[j]);
    const auto last = rows.begin() + static_cast<ptrdiff_t>(start[j + 1]);
    std::sort(first, last);
    block_row_.insert(block_row_.end(), first, std::unique(first, last));
    block_start_[j + 1] = static_cast<int>(block_row_.size());
  }
  block_row_.shrink_to_fit();

  column_start_.reserve(3 * n + 1);
  row_index_.reserve(9 * block_row_.size());
  column_start_.push_back(0);
  for (size_t j = 0; j < n; ++j) {
    for (int c = 0; c < 3; ++c) {
      for (int k = block_start_[j]; k < block_start_[j + 1]; ++k) {
        for (int r = 0; r < 3; ++r) row_index_.push_back(3 * block_row_[static_cast<size_t>(k)] + r);
      }
      column_start_.push_back(static_cast<int>(row_index_.size()));
    }
  }
  values_.resize(row_index_.size(), 0.0);
}

int BlockMatrix::index_of(int i, int j) const {
  const auto column = static_cast<size_t>(j);
  const auto first = block_row_.begin() + block_start_[column];
  const auto last = block_row_.begin() + block_start_[column + 1];
  const auto found = std::lower_bound(first, last, i);
  return found == last || *found != i ? -1 : static_cast<int>(found - block_row_.begin());
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
  for (int j = 0; j < block_rows_; ++j) {
    const double* a0 = values_.data() + column_start_[3 * static_cast<size_t>(j)];
    const int stride = column_stride(j);
    const double* a1 = a0 + stride;
    const double* a2 = a1 + stride;
    const double x0 = X[3 * j], x1 = X[3 * j + 1], x2 = X[3 * j + 2];
    double y0 = a0[0] * x0 + a0[1] * x1 + a0[2] * x2;
    double y1 = a0[1] * x0 + a1[1] * x1 + a1[2] * x2;
    double y2 = a0[2] * x0 + a1[2] * x1 + a2[2] * x2;
    const int* row = block_row_.data() + block_start_[static_cast<size_t>(j)];
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
