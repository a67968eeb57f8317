#include "runtime/block_matrix.h"

#include <gtest/gtest.h>

#include <random>

namespace ergon {
namespace {

// Blocks (0,0) (1,1) (2,2) (3,3), (2,0), (3,0), (3,2).
BlockMatrix small_matrix() { return BlockMatrix(4, {{0, 2}, {3, 2}, {2, 0}, {3, 0}, {1, 1}, {2, 3}}); }

TEST(BlockMatrix, HasDiagonalAndEveryPairOnce) {
  const BlockMatrix matrix = small_matrix();
  EXPECT_EQ(matrix.block_rows(), 4);
  EXPECT_EQ(matrix.rows(), 12);
  EXPECT_EQ(matrix.blocks(), 7u);
  EXPECT_EQ(matrix.values().size(), 63u);
  EXPECT_EQ(matrix.column_start(), (std::vector<int>{0, 9, 18, 27, 30, 33, 36, 42, 48, 54, 57, 60, 63}));
  const std::vector<int>& rows = matrix.row_index();
  EXPECT_EQ(std::vector<int>(rows.begin(), rows.begin() + 9), (std::vector<int>{0, 1, 2, 6, 7, 8, 9, 10, 11}));
  EXPECT_EQ(std::vector<int>(rows.begin() + 36, rows.begin() + 42), (std::vector<int>{6, 7, 8, 9, 10, 11}));
}

TEST(BlockMatrix, FindsBlocks) {
  const BlockMatrix matrix = small_matrix();
  EXPECT_EQ(matrix.find(0, 0), 0);
  EXPECT_EQ(matrix.find(2, 0), 3);
  EXPECT_EQ(matrix.find(3, 0), 6);
  EXPECT_EQ(matrix.find(1, 0), -1);
  EXPECT_EQ(matrix.find(1, 1), 27);
  EXPECT_EQ(matrix.find(3, 2), 39);
  EXPECT_EQ(matrix.column_stride(0), 9);
  EXPECT_EQ(matrix.column_stride(1), 3);
  EXPECT_EQ(matrix.column_stride(2), 6);
}

TEST(BlockMatrix, PatternsAreNumbered) {
  const BlockMatrix first = small_matrix(), second = small_matrix(), copy = first;
  EXPECT_LT(first.pattern_id(), second.pattern_id());
  EXPECT_EQ(copy.pattern_id(), first.pattern_id());
  EXPECT_EQ(BlockMatrix().pattern_id(), 0u);
}

TEST(BlockMatrix, MultipliesAsItsSymmetricDenseMatrix) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const int n : {1, 2, 7, 40}) {
    std::vector<std::pair<int, int>> pairs;
    std::uniform_int_distribution<int> row(0, n - 1);
    for (int k = 0; k < 3 * n; ++k) pairs.emplace_back(row(random), row(random));
    BlockMatrix matrix(n, pairs);
    for (double& v : matrix.values()) v = uniform(random);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    for (int column = 0; column < 3 * n; ++column) {
      for (int k = matrix.column_start()[static_cast<size_t>(column)];
           k < matrix.column_start()[static_cast<size_t>(column) + 1]; ++k) {
        const int i = matrix.row_index()[static_cast<size_t>(k)];
        if (i < column) continue;
        dense(i, column) = dense(column, i) = matrix.values()[static_cast<size_t>(k)];
      }
    }
    const Eigen::VectorXd x = Eigen::VectorXd::Random(3 * n);
    Eigen::VectorXd y;
    matrix.multiply(x, y);
    EXPECT_LT((y - dense * x).cwiseAbs().maxCoeff(), 1e-13);
  }
}

TEST(BlockMatrix, MayBeEmpty) {
  const BlockMatrix matrix(0, {});
  EXPECT_EQ(matrix.blocks(), 0u);
  Eigen::VectorXd y;
  matrix.multiply(Eigen::VectorXd(0), y);
  EXPECT_EQ(y.size(), 0);
}

}  // namespace
}  // namespace ergon
