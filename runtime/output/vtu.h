#pragma once
// One frame of a simulation as a VTK unstructured grid, which ParaView opens and Blender imports.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "runtime/mesh/element.h"

namespace ergon {

// One quantity on all points or all cells: a row per component (1 a scalar, 3 a vector, 9 a matrix), a column per point
// or cell.
struct Field {
  std::string name;
  Eigen::MatrixXd values;
};

// Cells of one kind; `nodes` are columns of the frame's points.
struct CellBlock {
  Element element = Element::tet4;
  std::vector<int> nodes;
};

struct Frame {
  double time = 0;     // s, kept as the field TimeValue
  Eigen::Matrix3Xd x;  // current positions, m
  std::vector<CellBlock> cells;
  std::vector<Field> point_data;
  std::vector<Field> cell_data;  // over the cells of all blocks, in their order
};

// Writes `frame` in 64-bit floating point, as raw bytes behind an XML header. The file is there as a whole or not at
// all. Throws OutputError when it cannot be written, InputError when a field's size is not that of the points or cells,
// a name is empty or twice there, or a cell names a point that does not exist.
void write_vtu(const std::string& path, const Frame& frame);

}  // namespace ergon
