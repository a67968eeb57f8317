#include "runtime/block_pattern.h"

#include <algorithm>
#include <atomic>
#include <numeric>

namespace ergon {
namespace {

std::atomic<unsigned long> next_pattern{1};

}  // namespace

int BlockPattern::index_of(int i, int j) const {
  const auto first = block_row.begin() + block_start[static_cast<size_t>(j)];
  const auto last = block_row.begin() + block_start[static_cast<size_t>(j) + 1];
  const auto found = std::lower_bound(first, last, i);
  return found == last || *found != i ? -1 : static_cast<int>(found - block_row.begin());
}

int BlockPattern::find(const int* row, const int* column, int count, int* index) const {
  int missing = 0;
  for (int k = 0; k < count;) {
    const int j = column[k];
    int at = block_start[static_cast<size_t>(j)];
    const int last = block_start[static_cast<size_t>(j) + 1];
    for (; k < count && column[k] == j; ++k) {
      while (at < last && block_row[static_cast<size_t>(at)] < row[k]) ++at;
      const bool found = at < last && block_row[static_cast<size_t>(at)] == row[k];
      index[k] = found ? at : -1;
      missing += !found;
    }
  }
  return missing;
}

const std::vector<int>& BlockPattern::row_index() const {
  if (!row_index_.empty() || block_row.empty()) return row_index_;
  row_index_.resize(9 * block_row.size());
  int* out = row_index_.data();
  for (size_t j = 0; j < static_cast<size_t>(block_rows); ++j) {
    const int* const column = out;
    for (int k = block_start[j]; k < block_start[j + 1]; ++k) {
      for (int r = 0; r < 3; ++r) *out++ = 3 * block_row[static_cast<size_t>(k)] + r;
    }
    const ptrdiff_t length = out - column;
    for (int c = 1; c < 3; ++c) out = std::copy_n(column, length, out);
  }
  return row_index_;
}

void PatternBuilder::build(int block_rows, const BlockPattern* old, const std::vector<char>& kept, BlockPattern& made) {
  const auto n = static_cast<size_t>(block_rows);
  start_.assign(n + 2, 0);
  for (const int j : column_) ++start_[static_cast<size_t>(j) + 2];
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  bucket_.resize(row_.size());
  for (size_t k = 0; k < row_.size(); ++k) {
    bucket_[static_cast<size_t>(start_[static_cast<size_t>(column_[k]) + 1]++)] = row_[k];
  }
  row_.clear();
  column_.clear();

  made.block_rows = block_rows;
  made.id = next_pattern++;
  made.row_index_.clear();
  made.block_start.assign(1, 0);
  made.block_row.clear();
  made.column_start.assign(1, 0);
  for (size_t j = 0; j < n; ++j) {
    const auto first = bucket_.begin() + start_[j], last = bucket_.begin() + start_[j + 1];
    std::sort(first, last);
    made.block_row.push_back(static_cast<int>(j));
    const auto take = [&](int row) {
      if (made.block_row.back() != row) made.block_row.push_back(row);
    };
    auto added = first;
    const int old_last = old != nullptr ? old->block_start[j + 1] : 0;
    for (int k = old != nullptr ? old->block_start[j] + 1 : 0; k < old_last; ++k) {
      if (kept[static_cast<size_t>(k)] == 0) continue;
      const int row = old->block_row[static_cast<size_t>(k)];
      for (; added != last && *added < row; ++added) take(*added);
      take(row);
    }
    for (; added != last; ++added) take(*added);
    made.block_start.push_back(static_cast<int>(made.block_row.size()));
    const int entries = 3 * (made.block_start[j + 1] - made.block_start[j]);
    for (int c = 0; c < 3; ++c) made.column_start.push_back(made.column_start.back() + entries);
  }
}

}  // namespace ergon
