#pragma once
// Matrix Market files (Boisvert, Pozo, Remington 1996, The Matrix Market Exchange Formats, NISTIR 5935): what other
// programs read. Numbers are written so that they read back to the same double.

#include <Eigen/Core>
#include <string>

#include "runtime/block_matrix.h"

namespace ergon {

// "array real general", 3n x 1: the components of the n columns one after the other. Throws OutputError when the file
// cannot be written; then nothing is left behind.
void write_matrix_market(const std::string& path, const Eigen::Matrix3Xd& vectors);

// "coordinate real symmetric", 3n x 3n, the lower triangle; entries of the pattern that are zero are written too.
void write_matrix_market(const std::string& path, const BlockMatrix& matrix);

}  // namespace ergon
