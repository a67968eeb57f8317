#pragma once
// A mesh at rest: positions and one kind of cell.

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "runtime/mesh/element.h"

namespace ergon {

struct Mesh {
  Eigen::Matrix3Xd X;  // rest positions, m, 3 x vertices
  Element element = Element::tet4;
  std::vector<int> cells;  // nodes of each cell, one cell after the other
  std::string source;      // the file it came from, for messages

  int vertices() const { return static_cast<int>(X.cols()); }
  int cell_count() const { return static_cast<int>(cells.size()) / nodes_of(element); }
};

}  // namespace ergon
