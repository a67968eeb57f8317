#pragma once
// Whether the objects of a scene without inertia have something to come to rest against.

#include "scenes/builder.h"

namespace ergon {

// Throws SourceError at the object's line for one that may be translated without resistance: by its energies, by what
// touches it at the start, by vertices that are fixed or scripted. Objects that attachments join are held as one. An
// object that can only turn is not refused: its energy has a minimum.
void check_held(const Scene& scene, BuiltScene& built);

}  // namespace ergon
