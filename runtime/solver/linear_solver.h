#pragma once
// Sparse Cholesky factorisation of a BlockMatrix in three functions: analyse, factor, solve. It establishes that the
// matrix is read where assembly wrote it (no copy), and that the symbolic analysis is made once per pattern.

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "runtime/block_matrix.h"

namespace ergon {

// Fill-reducing ordering: minimum degree is fast to find, nested dissection gives sparser factors of large solids.
// `automatic` tries both and keeps the one that needs fewer operations.
enum class Ordering { automatic, minimum_degree, nested_dissection };

class LinearSolver {
 public:
  explicit LinearSolver(Ordering ordering = Ordering::automatic);
  ~LinearSolver();
  LinearSolver(LinearSolver&&) noexcept;
  LinearSolver& operator=(LinearSolver&&) noexcept;

  // Orders the unknowns and finds the factor's pattern. Does nothing while matrix.pattern_id() is that of the last
  // call, and keeps the order for other patterns of as many rows until their factors cost more than another order
  // would.
  void analyse(const BlockMatrix& matrix);

  // Factors matrix + shift * identity (shift in the matrix's unit), analysing first if needed. Empty when the factor
  // exists; otherwise the scalar row of the matrix at which a pivot was not positive, and there is no factor to solve
  // with. Throws InputError when memory runs out.
  std::optional<int> factor(const BlockMatrix& matrix, double shift = 0);

  // Solves with the last factor, as often as wanted: rows() components in, rows() out. Throws std::logic_error when
  // there is none.
  void solve(const Eigen::VectorXd& right_side, Eigen::VectorXd& solution);

  long analyses() const;          // made so far
  long orderings() const;         // found for these; the other analyses kept the last one
  long factorisations() const;    // tried so far
  double factor_entries() const;  // nonzeros of the factor, 0 before the first analysis
  double factor_flops() const;    // per factorisation

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ergon
