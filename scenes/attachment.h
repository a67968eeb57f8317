#pragma once
// What joins the vertices of an object to places in space, to vertices or to the surface of another.

#include <limits>
#include <string>
#include <vector>

#include "scenes/energy_use.h"

namespace ergon {

// The vertices of `object` with min <= x <= max at the start (m), or places that move with it, and what each is joined
// to; the law that joins them.
struct SceneAttachment : EnergyUse {
  static constexpr double inf = std::numeric_limits<double>::infinity();
  std::string object;
  Vector3 min = {-inf, -inf, -inf};
  Vector3 max = {inf, inf, inf};
  std::vector<Vector3> places;          // m, in place of vertices
  std::string to;                       // an object or obstacle; "": the place where the vertex starts
  std::string joined_at = "point";      // its nearest vertex, the nearest place on its surface, or the same place
  Vector3 to_min = {-inf, -inf, -inf};  // only of its vertices, or triangles all of whose vertices are, in this box
  Vector3 to_max = {inf, inf, inf};
  double within = 0;  // m, the largest distance at the start

  bool to_space() const { return to.empty(); }
  bool to_surface() const { return joined_at == "surface"; }
  bool to_place() const { return joined_at == "place"; }
};

}  // namespace ergon
