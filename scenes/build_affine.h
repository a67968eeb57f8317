#pragma once
// Affine bodies of a scene: their control points, what these carry, and the energy that keeps them near a rotation.

#include "runtime/carriers.h"
#include "scenes/builder.h"

namespace ergon {

// Start and mass of the control points of a body whose first_control is known: four points of equal mass that have the
// moments of the solid.
void start_affine(const SceneObject& object, const Body& body, BuiltScene& out);

// What the control points of all affine bodies carry.
Carriers carriers_of(const std::vector<Body>& bodies);

// One potential for all bodies that are alike up to how they lie.
void add_affine_potentials(const Scene& scene, const Kernel& orthogonality, BuiltScene& out);

}  // namespace ergon
