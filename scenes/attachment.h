#pragma once
// What joins the vertices of an object to places in space, to vertices or to the surface of another.

#include <limits>
#include <string>

#include "scenes/energy_use.h"

namespace ergon {

// The vertices of `object` with min <= x <= max at the start (m) and what each is joined to; the law that joins them.
struct SceneAttachment : EnergyUse {
  static constexpr double inf = std::numeric_limits<double>::infinity();
  std::string object;
  Vector3 min = {-inf, -inf, -inf};
  Vector3 max = {inf, inf, inf};
  std::string to;                       // an object or obstacle; "": the place where the vertex starts
  std::string joined_at = "point";      // the nearest of its vertices, or the nearest place on its surface
  Vector3 to_min = {-inf, -inf, -inf};  // only of its vertices, or triangles all of whose vertices are, in this box
  Vector3 to_max = {inf, inf, inf};
  double within = 0;  // m, the largest distance at the start

  bool to_space() const { return to.empty(); }
  bool to_surface() const { return joined_at == "surface"; }
};

}  // namespace ergon
