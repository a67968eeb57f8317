#pragma once
// A symmetric matrix of 3x3 blocks over the free vertices, stored as the lower triangle in compressed scalar columns:
// the layout that CHOLMOD reads, so that assembly writes and the factorisation reads the same memory. Diagonal blocks
// are stored whole; what lies above the diagonal in them is ignored by readers (CHOLMOD stype = -1).

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace ergon {

class BlockMatrix {
 public:
  BlockMatrix() = default;
  // `pairs` are the couplings (i, j) of block rows in any order, with repetitions; diagonal blocks are always present.
  BlockMatrix(int block_rows, const std::vector<std::pair<int, int>>& pairs);

  int block_rows() const { return block_rows_; }
  int rows() const { return 3 * block_rows_; }
  size_t blocks() const { return block_row_.size(); }

  // Where block (i, j), i >= j, starts in values(), or -1 when it is not in the pattern. Its column c starts
  // column_stride(j) * c doubles later; within a column the three rows are adjacent.
  ptrdiff_t find(int i, int j) const;
  // The number of block (i, j), i >= j, in the order of the matrix, or -1; and where a block of column j starts.
  int index_of(int i, int j) const;
  ptrdiff_t start_of(int index, int j) const {
    const auto column = static_cast<size_t>(j);
    return column_start_[3 * column] + 3 * static_cast<ptrdiff_t>(index - block_start_[column]);
  }
  int column_stride(int j) const {
    return 3 * (block_start_[static_cast<size_t>(j) + 1] - block_start_[static_cast<size_t>(j)]);
  }

  std::vector<double>& values() { return values_; }
  const std::vector<double>& values() const { return values_; }
  // Compressed scalar columns: starts (rows()+1) and row indices.
  const std::vector<int>& column_start() const { return column_start_; }
  const std::vector<int>& row_index() const { return row_index_; }

  void set_zero();
  // y = A x over 3*block_rows() components.
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;

  // Increases whenever a matrix with another pattern is built; equal numbers mean equal patterns.
  unsigned long pattern_id() const { return pattern_id_; }

 private:
  int block_rows_ = 0;
  unsigned long pattern_id_ = 0;
  std::vector<int> block_start_;  // per block column
  std::vector<int> block_row_;    // sorted within a column, diagonal first
  std::vector<int> column_start_;
  std::vector<int> row_index_;
  std::vector<double> values_;
};

}  // namespace ergon
