#pragma once
// Which objects come near each other at all: the others cost nothing further.

#include <array>
#include <vector>

#include "runtime/contact/motion_boxes.h"

namespace ergon {

// Pairs (a, b), a <= b, that may meet, of which something moves, and whose boxes meet on the way. `points` is a tree
// over all points of the surface. Room is reused.
void find_object_pairs(const CollisionSurface& surface, const MotionBoxes& motion, const BoxTree& points,
                       std::vector<std::array<int, 2>>& pairs);

}  // namespace ergon
