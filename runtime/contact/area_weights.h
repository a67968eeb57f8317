#pragma once
// Stencils weighted by area, so that the barrier's energy is an integral over surfaces: refining a mesh then does not
// make its contact stiffer. Source: Li et al. 2023, Convergent Incremental Potential Contact, arXiv:2307.15908.

#include <Eigen/Core>
#include <vector>

#include "runtime/contact/collision_surface.h"

namespace ergon {

// Fills point_weight and edge_weight, m^2. Points and edges have a third of the triangles around them; the integral is
// the mean of those over both surfaces, and each of these the mean of sums over points and over edges. Edges without
// triangles count as strips as wide as their object is thick (without thickness dhat), loose points as squares of it.
// X: rest positions, 3 x vertices of the system, m; dhat: m.
void weight_by_area(CollisionSurface& surface, const Eigen::Matrix3Xd& X, double dhat);

// Means of point_weight by object; 1 without weights, and for objects without points.
std::vector<double> mean_weights(const CollisionSurface& surface);

}  // namespace ergon
