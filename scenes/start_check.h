#pragma once
// Whether a scene's first state is one that can be stepped from.

#include <vector>

#include "scenes/body.h"
#include "scenes/scene.h"

namespace ergon {

// Throws SourceError at the object's line when a free vertex of its surface starts on or below a ground: the deepest
// one, by how much, and how far to move the object.
void check_start(const Scene& scene, const std::vector<Body>& bodies);

}  // namespace ergon
