#pragma once
// Closed triangle surfaces made from numbers, seen counter-clockwise from outside.

#include "runtime/mesh/mesh.h"

namespace ergon {

// A sphere around the origin: every edge of an icosahedron is cut into `cuts`, its faces into cuts^2 triangles, and all
// vertices lie at `radius` (m). Throws InputError for a radius that is not positive and finite and for cuts below 1.
Mesh sphere_surface(double radius, int cuts);

// A pipe along x from the origin with inner and outer radius (m), closed at its ends by rings: `around` by `along`
// quadrilaterals on each side, each cut in two. Throws InputError unless 0 < inner < outer, length > 0, around >= 3
// and along >= 1.
Mesh tube_surface(double inner, double outer, double length, int around, int along);

// A ring around the z axis: a circle of `section` (m) whose centre runs along one of `radius` in the plane z = 0, cut
// into `around` by `across` quadrilaterals, and each of these in two. Throws InputError unless 0 < section < radius,
// around >= 3 and across >= 3.
Mesh torus_surface(double radius, double section, int around, int across);

}  // namespace ergon
