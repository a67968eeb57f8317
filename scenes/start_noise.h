#pragma once
// Random velocities at the start, for runs that differ by a seed alone. It establishes that each number follows from
// the seed, the object, the vertex of its mesh and the axis alone: the same on every machine, in every order.

#include <Eigen/Core>
#include <vector>

#include "runtime/system.h"
#include "scenes/body.h"
#include "scenes/scene.h"

namespace ergon {

// Adds to v (m/s, 3 x vertices of the system): to every free vertex a velocity of up to start.noise along each axis; to
// an affine body one velocity of that size, and a rotation by which its control points move as fast. `bodies`: objects
// first, of which there are `objects`.
void add_start_noise(const StartSettings& start, const std::vector<Body>& bodies, size_t objects, const System& system,
                     const Eigen::Matrix3Xd& x, Eigen::Matrix3Xd& v);

}  // namespace ergon
