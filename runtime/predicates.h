#pragma once
// Signs of determinants of points and what follows from them, exactly, as long as no product of three coordinates
// overflows or falls below 1e-290.
// Source: Shewchuk 1997, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates, Discrete &
// Computational Geometry 18: the first filter of ORIENT3D and ORIENT2D, and GROW-EXPANSION for what it leaves open.

#include <Eigen/Core>

namespace ergon {

// The sign of det(a - d, b - d, c - d): 1 where d is below the plane through a, b, c that is seen counterclockwise from
// above, 0 where the four are in one plane.
int orientation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, const Eigen::Vector3d& d);
// The same where rounded arithmetic shows it, else 0.
int sure_orientation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                     const Eigen::Vector3d& d);
// The sign of det(a - c, b - c) in the plane of two axes: 1 where a, b, c turn counterclockwise.
int orientation_in_plane(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, int axis_u,
                         int axis_v);

// Whether the segment from p to q and the triangle have a point in common, ends, sides and corners included. Either may
// be degenerate.
bool segment_meets_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& a,
                            const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace ergon
