#pragma once
// Whether primitives that move along straight lines touch, decided without rounding: what continuous collision
// detection is held against.

#include <Eigen/Core>

namespace ergon {

// x: positions at time 0, m: p, t0, t1, t2 or a0, a1, b0, b1. motion: displacement from time 0 to 1, m. Whether the two
// have a point in common at some time in [0, until]; until >= 0.
bool point_triangle_collides(const Eigen::Vector3d* x, const Eigen::Vector3d* motion, double until);
bool edge_edge_collides(const Eigen::Vector3d* x, const Eigen::Vector3d* motion, double until);

}  // namespace ergon
