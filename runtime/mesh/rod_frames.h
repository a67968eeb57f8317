#pragma once
// Rods that twist: the pairs of edges that meet, and where the axes of their cross-sections point at rest.

#include <optional>
#include <vector>

#include "runtime/mesh/mesh.h"

namespace ergon {

// Points of the "rod_corner" stencils of a line: those of a corner, in the direction of its two edges, and the twists
// of these, of which that of cell c is numbered vertices() + c. Throws InputError where a line branches, and where two
// edges that meet do not run in one direction.
std::vector<int> rod_corners_of(const Mesh& mesh);

// A unit vector across each edge of a line of Edge2: on the first edge of each piece what of `axis` is across it, or
// of z (of x, where the edge runs along z); from there it is carried from edge to edge without turning about them
// (parallel transport). The first edge of a closed piece is that of its lowest number. Throws InputError as above, and
// for an axis that runs along that edge.
std::vector<Eigen::Vector3d> cross_section_axes(const Mesh& mesh, const std::optional<Eigen::Vector3d>& axis);

// rad, by rod corner: the angle from the first edge's axis, carried to the second, to the axis there. 0 but where a
// closed piece closes.
std::vector<double> frame_turns(const Mesh& mesh, const std::vector<int>& corners,
                                const std::vector<Eigen::Vector3d>& axes);

}  // namespace ergon
