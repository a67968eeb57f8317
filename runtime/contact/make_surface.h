#pragma once
// Makes the collision surface of meshes. It establishes what CollisionSurface promises: every end of an edge is a point
// and every side of a triangle an edge, each once, in ascending order of vertices.

#include <string>
#include <vector>

#include "runtime/contact/collision_surface.h"
#include "runtime/mesh/mesh.h"

namespace ergon {

struct CollisionObject {
  std::string name;
  const Mesh* mesh = nullptr;
  int first_vertex = 0;  // vertex v of the mesh is vertex first_vertex + v of the system
  double radius = 0;     // m, half the thickness
};

// The boundary of solids, membranes themselves, lines as edges, points as loose points. Curved faces and lines are cut
// at all their nodes, so that every point of the surface is a vertex that moves by itself. All objects may meet all.
// `moving`: per vertex of the system. Throws InputError for an object without name or cells, two of one name or that
// share vertices, a radius that is negative or not finite, and cells that name a vertex twice or one that is not there.
CollisionSurface make_surface(const std::vector<CollisionObject>& objects, std::vector<char> moving);

// Throws InputError unless the surface is as CollisionSurface describes it: for surfaces made by hand.
void check_surface(const CollisionSurface& surface);

}  // namespace ergon
