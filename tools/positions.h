#pragma once
// Vertex positions as text, the simplest thing another program can write.

#include <Eigen/Core>
#include <string>

namespace ergon {

// One vertex per line, three numbers (m); empty lines and what follows a '#' count for nothing. Throws InputError
// (file, line) unless there are `vertices` of them, all finite.
Eigen::Matrix3Xd read_positions(const std::string& path, int vertices);

}  // namespace ergon
