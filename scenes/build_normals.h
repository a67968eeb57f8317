#pragma once
// Shells of a scene with laws that know of the normals amid edges: a vertex of the system for each edge, the tip of its
// normal. Its mass stands for the inertia of the thickness against turning, and has no weight.

#include "scenes/builder.h"
#include "scenes/object_laws.h"

namespace ergon {

// Gives the body its tips where a law asks for them.
void set_normals(const std::vector<UsedLaw>& laws, Body& body);

// The tips of a body at the start, and those of triangles that are fixed, or follow one script that was added last, as
// a whole. An edge alone that is held lets the shell turn about it.
void start_normals(const SceneObject& object, const Body& body, BuiltScene& out, std::vector<char>& fixed);
std::vector<int> tips_of(const BodyScript& script, const Body& body);  // vertices of the scene

}  // namespace ergon
