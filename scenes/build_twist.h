#pragma once
// Rods of a scene whose edges twist: a vertex of the system for each edge, of which one axis is free, the angle times
// the radius of gyration of the cross-section. So a twist is a length, and its mass is that of the edge.

#include "scenes/builder.h"
#include "scenes/object_laws.h"

namespace ergon {

// Gives the body its axes and its radius of gyration where a law asks for twist. Throws SourceError at the scene's
// line where its lines branch or do not run in one direction, where the axis runs along the rod, and for keys of the
// object that then have no use.
void set_twist(const SceneObject& object, const std::vector<UsedLaw>& laws, Body& body);

// Twists of a body at the start: mass, guides, and what is held with both ends of its edge, fixed or by one script that
// was added last.
void start_twist(const SceneObject& object, const Body& body, BuiltScene& out, std::vector<char>& fixed,
                 std::vector<Guide>& guides);
void follow_twist(const BodyScript& script, const Body& body, BuiltScene& out, std::vector<char>& fixed);

}  // namespace ergon
