#pragma once
// A symmetric matrix of 3x3 blocks over the free vertices, stored as the lower triangle in compressed scalar columns:
// the layout that CHOLMOD reads, so that assembly writes and the factorisation reads the same memory. Diagonal blocks
// are stored whole; what lies above the diagonal in them is ignored by readers (CHOLMOD stype = -1).

#include <Eigen/Core>
#include <memory>
#include <utility>
#include <vector>

#include "runtime/block_pattern.h"

namespace ergon {

class BlockMatrix {
 public:
  BlockMatrix();
  // `pairs` are the couplings (i, j) of block rows in any order, with repetitions; diagonal blocks are always present.
  BlockMatrix(int block_rows, const std::vector<std::pair<int, int>>& pairs);

  // Takes another pattern over, which is not to change while this has it. The values are whatever they are.
  void set_pattern(std::shared_ptr<const BlockPattern> pattern);

  int block_rows() const { return pattern_->block_rows; }
  int rows() const { return 3 * block_rows(); }
  size_t blocks() const { return pattern_->blocks(); }

  // Where block (i, j), i >= j, starts in values(), or -1 when it is not in the pattern. Its column c starts
  // column_stride(j) * c doubles later; within a column the three rows are adjacent.
  ptrdiff_t find(int i, int j) const;
  // The number of block (i, j), i >= j, in the order of the matrix, or -1; and where a block of column j starts.
  int index_of(int i, int j) const { return pattern_->index_of(i, j); }
  ptrdiff_t start_of(int index, int j) const { return pattern_->start_of(index, j); }
  int column_stride(int j) const { return pattern_->column_stride(j); }

  std::vector<double>& values() { return values_; }
  const std::vector<double>& values() const { return values_; }
  // Compressed scalar columns: starts (rows()+1) and row indices.
  const std::vector<int>& column_start() const { return pattern_->column_start; }
  const std::vector<int>& row_index() const { return pattern_->row_index(); }

  void set_zero();
  // y = A x over 3*block_rows() components.
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;

  // Equal numbers mean equal patterns; a pattern made later has a larger one.
  unsigned long pattern_id() const { return pattern_->id; }

 private:
  std::shared_ptr<const BlockPattern> pattern_;
  std::vector<double> values_;
};

}  // namespace ergon
