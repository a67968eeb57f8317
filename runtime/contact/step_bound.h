#pragma once
// The largest step that no pair of a list of candidates forbids.

#include <Eigen/Core>

#include "runtime/contact/broad_phase.h"
#include "runtime/contact/collision_surface.h"

namespace ergon {

// The largest step in [0, 1] such that x + t*direction keeps, for all t in [0, step], what runtime/contact/ccd.h
// establishes of each pair, with the offset of its objects as separation: every gap beyond the offset stays above the
// fraction `kept` of what it is at x, and above what rounding the moved positions to doubles may take of it (2^-47 of
// the largest coordinate). 0 when a pair is not that far apart at x. x, direction: 3 x vertices of the system, m. The
// same for any number of threads; allocates nothing.
double largest_step(const CollisionSurface& surface, const Candidates& candidates, const Eigen::Matrix3Xd& x,
                    const Eigen::Matrix3Xd& direction, double kept = 0.1);

}  // namespace ergon
