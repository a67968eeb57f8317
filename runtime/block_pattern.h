#pragma once
// Which 3x3 blocks a symmetric matrix has: those of its lower triangle, column by column. It establishes that patterns
// are made from lists of blocks with repetitions, and from other patterns, in one pass and in room that is kept.

#include <cstddef>
#include <vector>

namespace ergon {

class BlockPattern {
 public:
  int block_rows = 0;
  unsigned long id = 0;              // increases whenever a pattern is made; 0 is that of no matrix
  std::vector<int> block_start{0};   // per block column, into block_row
  std::vector<int> block_row;        // ascending within a column, so that the diagonal is first
  std::vector<int> column_start{0};  // of scalar columns, in values

  size_t blocks() const { return block_row.size(); }
  // The number of block (i, j), i >= j, or -1.
  int index_of(int i, int j) const;
  // Where a block of column j starts in the values.
  ptrdiff_t start_of(int index, int j) const {
    const auto column = static_cast<size_t>(j);
    return column_start[3 * column] + 3 * static_cast<ptrdiff_t>(index - block_start[column]);
  }
  int column_stride(int j) const {
    return 3 * (block_start[static_cast<size_t>(j) + 1] - block_start[static_cast<size_t>(j)]);
  }
  // Finds the numbers of `count` blocks that are sorted by column and then row; -1 for those not there. Returns how
  // many are not.
  int find(const int* row, const int* column, int count, int* index) const;
  // Scalar rows of all values; made when first asked for.
  const std::vector<int>& row_index() const;

 private:
  friend class PatternBuilder;
  mutable std::vector<int> row_index_;
};

class PatternBuilder {
 public:
  // A block (i, j), i >= j, that the next pattern is to have.
  void add(int i, int j) {
    row_.push_back(i);
    column_.push_back(j);
  }
  // Makes `made` of the diagonal, all added blocks and those of `old` (may be null) that `kept` is not 0 for; forgets
  // what was added.
  void build(int block_rows, const BlockPattern* old, const std::vector<char>& kept, BlockPattern& made);

 private:
  std::vector<int> row_, column_;
  std::vector<int> start_, bucket_;  // of rows, by column
};

}  // namespace ergon
