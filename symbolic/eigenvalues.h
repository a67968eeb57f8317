#pragma once
// Eigenvalues of small symmetric matrices.

#include <vector>

namespace ergon {

// All eigenvalues of a symmetric n x n matrix in increasing order, by cyclic Jacobi rotations.
std::vector<double> symmetric_eigenvalues(std::vector<double> matrix, int n);

}  // namespace ergon
