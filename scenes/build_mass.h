#pragma once
// What the masses of a scene give it: inertia, weight, and damping in proportion to mass. Lumped masses give potentials
// of points, consistent ones the coupled mass of the system.

#include "scenes/builder.h"

namespace ergon {

// Whether the mass of a body is the matrix of its shape functions.
bool has_consistent_mass(const SceneObject& object, const Body& body);

// To a scene whose bodies, system, masses and start are known.
void add_inertia(const Kernel& kernel, BuiltScene& out);
void add_gravity(const Scene& scene, const Kernel& kernel, BuiltScene& out);
// Of objects that have it, with their twists, and of the control points of affine ones.
void add_mass_damping(const Scene& scene, const Kernel& kernel, BuiltScene& out);

// The consistent mass of all bodies that have it, over the vertices of the scene.
CoupledMass coupled_mass_of(const Scene& scene, const std::vector<Body>& bodies, int vertices);

}  // namespace ergon
