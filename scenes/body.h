#pragma once
// The mesh of one object: read or made, filled, moved to its start, checked, and reordered for memory.

#include <optional>
#include <string>
#include <vector>

#include "runtime/mesh/load_shares.h"
#include "runtime/mesh/mesh.h"
#include "runtime/mesh/solid_moments.h"
#include "runtime/script.h"
#include "runtime/system.h"
#include "scenes/scene.h"

namespace ergon {

// Vertices of a body that a script moves about a centre (m).
struct BodyScript {
  std::vector<int> vertices;  // of `ordered`
  Eigen::Vector3d center;
  std::vector<MotionKey> keys;
  std::vector<ScriptShape> shapes;
};

struct Body {
  std::string name;
  Mesh mesh;                      // in the order of its source, moved to its start
  Mesh ordered;                   // the same in the order in which it is computed
  std::vector<int> vertex_from;   // vertex i of `ordered` is vertex vertex_from[i] of `mesh`
  std::vector<int> cell_from;     // the same of cells
  std::vector<int> fixed;         // vertices of `ordered` that never move
  std::vector<Guide> guides;      // vertices of `ordered` that move along some axes only
  std::vector<LoadShares> loads;  // of the object's loads, over vertices of `ordered`
  std::vector<BodyScript> scripts;
  std::vector<int> surface;       // vertices of `ordered` that may touch something
  std::optional<int> quadrature;  // exactness; absent: the element's own
  double section = 1;             // rest volume per measure of its cells: 1, a membrane's thickness (m), a line's (m^2)
  int first_vertex = 0;           // of `ordered` among all vertices of the scene
  // An affine body, unless all of it is fixed or follows a script.
  std::optional<SolidMoments> moments;
  int first_control = 0;  // of its four control points among all vertices of the scene

  // A rod that twists: a unit vector across each cell of `ordered` at rest, the cross-section's first axis; else none.
  std::vector<Eigen::Vector3d> axes;
  double gyration = 0;  // m, the radius of gyration of its cross-section
  int first_twist = 0;  // of the twists of its cells among all vertices of the scene

  // Points that move with the body and are no vertices of it (m, at the start), which joints ask for: of an affine
  // body, and of one that is held or scripted as a whole.
  std::vector<Eigen::Vector3d> places;
  int first_place = 0;  // of these among all vertices of the scene

  // A shell with normals amid its edges (runtime/mesh/edge_normals.h): how many; their tips stand where twists would.
  int tips = 0;

  bool twists() const { return !axes.empty(); }
  int first_tip() const { return first_twist; }
  // Of a vertex of `ordered`, or of the twist of cell c or the tip of edge c, numbered ordered.vertices() + c.
  int in_scene(int vertex) const {
    return vertex < ordered.vertices() ? first_vertex + vertex : first_twist + vertex - ordered.vertices();
  }
  bool affine() const { return moments.has_value(); }
};

// `folder` is what paths are relative to. Throws SourceError at the scene's line for whatever the mesh functions
// refuse: missing and broken files, open surfaces, inverted or flat cells; for a `fixed` box that holds no vertex, and
// where such boxes hold a part of an affine body.
Body load_body(const SceneObject& object, const std::string& folder);

// Of all bodies together; the control points of affine ones are not among them.
int vertices_of(const std::vector<Body>& bodies);

// The surface of an obstacle, none of whose vertices is free; it has no mass and no laws. Throws SourceError, beside
// the above, for a shape with other cells and for one that intersects itself although the obstacle touches itself.
Body load_obstacle(const SceneObstacle& obstacle, const std::string& folder);

}  // namespace ergon
