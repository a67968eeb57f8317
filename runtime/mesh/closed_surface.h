#pragma once
// What a triangle surface must be before it can be filled: closed, free of branches and cuts, and told apart into the
// boundaries of separate solids.

#include <array>
#include <vector>

#include "runtime/mesh/mesh.h"

namespace ergon {

// One connected part of a surface.
struct SurfacePart {
  std::vector<std::array<int, 3>> triangles;  // counter-clockwise seen from outside the part
  int depth = 0;                              // how many other parts it lies in; even: a solid's outer boundary
  int parent = -1;                            // the innermost part it lies in
};

// Takes a Tri3 mesh apart and orients it. Throws InputError, naming one edge or pair of triangles with coordinates:
// empty; edges with one triangle (open); edges with more than two (branching); a part with only one side (it cannot be
// oriented) or without volume; two triangles that cut one another.
std::vector<SurfacePart> closed_parts(const Mesh& surface);

// Volume enclosed by triangles that are counter-clockwise from outside, m^3.
double enclosed_volume(const Eigen::Matrix3Xd& X, const std::vector<std::array<int, 3>>& triangles);

// Two triangles without a common vertex that surely cut one another, or {-1, -1}. Decided by signs of volumes that
// exceed their rounding errors, so that touching and coplanar triangles are not reported.
std::array<int, 2> crossing_triangles(const Eigen::Matrix3Xd& X, const std::vector<std::array<int, 3>>& triangles);

}  // namespace ergon
