#pragma once
// Lines and loose points made from positions.

#include <vector>

#include "runtime/mesh/mesh.h"

namespace ergon {

// Loose points (m), each a cell of its own. Throws InputError without points.
Mesh point_mesh(const std::vector<Eigen::Vector3d>& points);

// Edges from point to point, and from the last to the first of a closed line. Throws InputError for fewer than two
// points, three of a closed line.
Mesh line_mesh(const std::vector<Eigen::Vector3d>& points, bool closed);

// A smooth curve through the points, as the points that cut it into `cells` pieces of equal length (to 1e-4): cells + 1
// with both ends, or cells of a closed curve. Between two points it is the cubic whose tangents are those of parabolas
// through a point and its neighbours, over the distances between points. Throws InputError as above, for cells < 1, and
// for points that follow each other in one place.
std::vector<Eigen::Vector3d> smooth_curve(const std::vector<Eigen::Vector3d>& points, bool closed, int cells);

}  // namespace ergon
