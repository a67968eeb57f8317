#include "runtime/block_pattern.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace ergon {
namespace {

using Blocks = std::set<std::pair<int, int>>;  // column, row

Blocks blocks_of(const BlockPattern& pattern) {
  Blocks all;
  for (int j = 0; j < pattern.block_rows; ++j) {
    for (int k = pattern.block_start[static_cast<size_t>(j)]; k < pattern.block_start[static_cast<size_t>(j) + 1];
         ++k) {
      const int row = pattern.block_row[static_cast<size_t>(k)];
      EXPECT_EQ(pattern.index_of(row, j), k);
      EXPECT_TRUE(all.emplace(j, row).second);
    }
  }
  EXPECT_EQ(all.size(), pattern.blocks());
  return all;
}

TEST(BlockPattern, IsMadeOfWhatIsAddedAndWhatIsKept) {
  std::mt19937 random(3);
  constexpr int n = 25;
  PatternBuilder builder;
  BlockPattern old, made;
  Blocks expected;
  for (int round = 0; round < 20; ++round) {
    Blocks kept;
    std::vector<char> keep(old.blocks());
    for (const auto& [column, row] : expected) {
      const bool stays = random() % 3 != 0;
      keep[static_cast<size_t>(old.index_of(row, column))] = stays;
      if (stays) kept.emplace(column, row);
    }
    expected = kept;
    for (int i = 0; i < n; ++i) expected.emplace(i, i);
    for (int k = 0; k < 40; ++k) {
      const int a = static_cast<int>(random() % n), b = static_cast<int>(random() % n);
      builder.add(std::max(a, b), std::min(a, b));
      expected.emplace(std::min(a, b), std::max(a, b));
    }
    builder.build(n, round == 0 ? nullptr : &old, keep, made);
    EXPECT_EQ(blocks_of(made), expected);
    EXPECT_GT(made.id, old.id);
    EXPECT_EQ(made.column_start.back(), static_cast<int>(9 * made.blocks()));
    EXPECT_EQ(made.row_index().size(), 9 * made.blocks());
    EXPECT_EQ(made.row_index().back(), 3 * n - 1);
    std::swap(old, made);
  }
}

TEST(BlockPattern, FindsSortedBlocks) {
  PatternBuilder builder;
  BlockPattern pattern;
  builder.add(2, 0);
  builder.add(3, 2);
  builder.build(4, nullptr, {}, pattern);
  const std::vector<int> row{0, 1, 2, 1, 2, 3, 3}, column{0, 0, 0, 1, 1, 2, 3};
  std::vector<int> index(row.size());
  EXPECT_EQ(pattern.find(row.data(), column.data(), static_cast<int>(row.size()), index.data()), 2);
  EXPECT_EQ(index, (std::vector<int>{0, -1, 1, 2, -1, 4, 5}));
}

}  // namespace
}  // namespace ergon
