#include "tools/verify/modes.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>
#include <stdexcept>

namespace ergon {
namespace {

// Over the scalar rows of the tangent.
Eigen::SparseMatrix<double> free_rows(const System& system, const CoupledMass::Matrix& mass, int rows) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < mass.rows(); ++v)
    for (CoupledMass::Matrix::InnerIterator entry(mass, v); entry; ++entry) {
      const int i = system.block_of(v), j = system.block_of(static_cast<int>(entry.col()));
      for (int c = 0; c < 3 && i >= 0 && j >= 0; ++c) entries.emplace_back(3 * i + c, 3 * j + c, entry.value());
    }
  Eigen::SparseMatrix<double> out(rows, rows);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

}  // namespace

std::vector<double> lowest_frequencies(Model& model, const CoupledMass::Matrix& mass, int count) {
  constexpr int more = 6, most_iterations = 200;
  constexpr double settled = 1e-10;
  const BlockMatrix& stiffness = model.tangent();
  LinearSolver solver;
  if (solver.factor(stiffness)) throw std::runtime_error("the tangent is not positive definite: the state is unstable");
  const System& system = model.system();
  const int n = stiffness.rows(), columns = std::min(n, count + more);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-1, 1);
  Eigen::MatrixXd vectors(n, columns);
  const Eigen::SparseMatrix<double> row_mass = free_rows(system, mass, n);
  for (int column = 0; column < columns; ++column) {
    Eigen::Matrix3Xd field = Eigen::Matrix3Xd::NullaryExpr(3, system.vertices(), [&] { return noise(random); });
    system.guide(field);
    for (int v = 0; v < system.vertices(); ++v)
      if (const int block = system.block_of(v); block >= 0) vectors.col(column).segment<3>(3 * block) = field.col(v);
  }
  Eigen::VectorXd values = Eigen::VectorXd::Zero(columns), solution;
  for (int i = 0; i < most_iterations; ++i) {
    const Eigen::MatrixXd pushed = row_mass * vectors;
    Eigen::MatrixXd next(n, columns);
    for (int column = 0; column < columns; ++column) {
      solver.solve(pushed.col(column), solution);
      next.col(column) = solution;
    }
    const Eigen::MatrixXd K = next.transpose() * pushed, M = next.transpose() * (row_mass * next);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> small((K + K.transpose()) / 2,
                                                                          (M + M.transpose()) / 2);
    vectors = next * small.eigenvectors();
    const double change =
        ((small.eigenvalues() - values).head(count).array() / small.eigenvalues().head(count).array()).abs().maxCoeff();
    values = small.eigenvalues();
    if (change < settled) break;
  }
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(std::sqrt(values[i]));
  return out;
}

}  // namespace ergon
