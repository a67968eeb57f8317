#include "runtime/solver/linear_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

namespace ergon {
namespace {

// Sets block (i, j) and, on the diagonal, what mirrors it.
void set_block(BlockMatrix& matrix, int i, int j, const Eigen::Matrix3d& block) {
  const ptrdiff_t at = matrix.find(i, j);
  ASSERT_GE(at, 0);
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      matrix.values()[static_cast<size_t>(at + c * matrix.column_stride(j) + r)] = block(r, c);
    }
  }
}

struct Problem {
  BlockMatrix matrix;
  Eigen::MatrixXd dense;
};

// A ring of blocks with some chords, positive definite by dominance.
Problem random_problem(int blocks, unsigned seed, double diagonal = 20) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i + 1 < blocks; ++i) pairs.emplace_back(i, i + 1);
  for (int i = 0; i + 7 < blocks; i += 3) pairs.emplace_back(i + 7, i);
  Problem problem{BlockMatrix(blocks, pairs), Eigen::MatrixXd::Zero(3 * blocks, 3 * blocks)};
  for (int i = 0; i < blocks; ++i) pairs.emplace_back(i, i);
  for (const auto& [a, b] : pairs) {
    const int i = std::max(a, b), j = std::min(a, b);
    Eigen::Matrix3d block = Eigen::Matrix3d::NullaryExpr([&]() { return uniform(random); });
    if (i == j) block = (block + block.transpose() + diagonal * Eigen::Matrix3d::Identity()).eval();
    set_block(problem.matrix, i, j, block);
    problem.dense.block<3, 3>(3 * i, 3 * j) = block;
    problem.dense.block<3, 3>(3 * j, 3 * i) = block.transpose();
  }
  return problem;
}

class EveryOrdering : public testing::TestWithParam<Ordering> {};

TEST_P(EveryOrdering, AgreesWithTheDenseSolution) {
  for (int blocks : {1, 2, 40, 300}) {
    const Problem problem = random_problem(blocks, 7);
    LinearSolver solver(GetParam());
    ASSERT_FALSE(solver.factor(problem.matrix).has_value());
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(3 * blocks, -1, 2);
    Eigen::VectorXd x;
    solver.solve(b, x);
    const Eigen::VectorXd expected = problem.dense.llt().solve(b);
    EXPECT_LT((x - expected).norm(), 1e-13 * expected.norm()) << blocks << " blocks";
    EXPECT_GE(solver.factor_entries(), 3.0 * blocks);
  }
}

INSTANTIATE_TEST_SUITE_P(, EveryOrdering,
                         testing::Values(Ordering::automatic, Ordering::minimum_degree, Ordering::nested_dissection));

TEST(LinearSolver, FactorServesSeveralRightSides) {
  const Problem problem = random_problem(30, 3);
  LinearSolver solver;
  ASSERT_FALSE(solver.factor(problem.matrix).has_value());
  for (int k = 0; k < 3; ++k) {
    const Eigen::VectorXd b = Eigen::VectorXd::Unit(90, 11 * k);
    Eigen::VectorXd x;
    solver.solve(b, x);
    EXPECT_LT((problem.dense * x - b).norm(), 1e-13);
  }
  EXPECT_EQ(solver.factorisations(), 1);
}

TEST(LinearSolver, AnalysesOncePerPattern) {
  Problem problem = random_problem(50, 1);
  LinearSolver solver;
  for (int k = 0; k < 4; ++k) {
    for (double& value : problem.matrix.values()) value *= 1.5;
    ASSERT_FALSE(solver.factor(problem.matrix).has_value());
  }
  EXPECT_EQ(solver.analyses(), 1);
  EXPECT_EQ(solver.factorisations(), 4);
  const Problem other = random_problem(51, 1);
  ASSERT_FALSE(solver.factor(other.matrix).has_value());
  EXPECT_EQ(solver.analyses(), 2);
}

TEST(LinearSolver, KeepsItsOrderForPatternsThatAreMuchTheSame) {
  constexpr int side = 30, n = side * side;
  LinearSolver solver;
  // A grid whose vertices are numbered `step` apart, and one more coupling.
  const auto solve_grid = [&](int step, int chord) {
    std::vector<std::pair<int, int>> pairs{{0, chord}};
    for (int i = 0; i < n; ++i) {
      if (i % side != 0) pairs.emplace_back(i * step % n, (i - 1) * step % n);
      if (i >= side) pairs.emplace_back(i * step % n, (i - side) * step % n);
    }
    BlockMatrix matrix(n, pairs);
    for (const auto& [a, b] : pairs) {
      set_block(matrix, std::max(a, b), std::min(a, b), -Eigen::Matrix3d::Identity());
    }
    for (int i = 0; i < n; ++i) set_block(matrix, i, i, 7 * Eigen::Matrix3d::Identity());
    ASSERT_FALSE(solver.factor(matrix).has_value());
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(3 * n, -1, 2);
    Eigen::VectorXd x, product(3 * n);
    solver.solve(b, x);
    matrix.multiply(x, product);
    EXPECT_LT((product - b).norm(), 1e-13 * b.norm());
  };
  solve_grid(1, 2);
  const double flops = solver.factor_flops();
  EXPECT_EQ(solver.orderings(), 1);
  solve_grid(1, 2 * side);
  solve_grid(1, 5 * side);
  EXPECT_EQ(solver.orderings(), 1);
  EXPECT_EQ(solver.analyses(), 3);
  EXPECT_LT(solver.factor_flops(), flops + 5e4 * n);
  solve_grid(97, 2);
  EXPECT_EQ(solver.orderings(), 2);
  EXPECT_EQ(solver.analyses(), 4);
  EXPECT_LT(solver.factor_flops(), 1.5 * flops);
}

TEST(LinearSolver, NamesTheRowWithoutAPositivePivot) {
  Problem problem = random_problem(40, 5);
  Eigen::Matrix3d bad = Eigen::Matrix3d::Identity() * 20;
  bad(1, 1) = -30;
  set_block(problem.matrix, 23, 23, bad);
  LinearSolver solver;
  const std::optional<int> row = solver.factor(problem.matrix);
  ASSERT_TRUE(row.has_value());
  EXPECT_EQ(*row, 3 * 23 + 1);
  Eigen::VectorXd x;
  EXPECT_THROW(solver.solve(Eigen::VectorXd::Zero(120), x), std::logic_error);
}

TEST(LinearSolver, ShiftIsAddedToTheDiagonal) {
  Problem problem = random_problem(40, 5, -3);
  LinearSolver solver;
  ASSERT_TRUE(solver.factor(problem.matrix).has_value());
  const double shift = 25;
  ASSERT_FALSE(solver.factor(problem.matrix, shift).has_value());
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(120);
  Eigen::VectorXd x;
  solver.solve(b, x);
  EXPECT_LT((problem.dense * x + shift * x - b).norm(), 1e-12);
  EXPECT_EQ(solver.analyses(), 1);
}

TEST(LinearSolver, NoUnknownsAreNoProblem) {
  const BlockMatrix empty(0, {});
  LinearSolver solver;
  EXPECT_FALSE(solver.factor(empty).has_value());
  Eigen::VectorXd x;
  solver.solve(Eigen::VectorXd(0), x);
  EXPECT_EQ(x.size(), 0);
}

}  // namespace
}  // namespace ergon
