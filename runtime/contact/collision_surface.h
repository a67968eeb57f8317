#pragma once
// What may collide: points, edges and triangles over the vertices of a system, and which of them may meet. It
// establishes the one list of primitives that broad phase, active sets, continuous collision detection and exact
// checks share.

#include <array>
#include <string>
#include <vector>

#include "runtime/contact/rest_offsets.h"

namespace ergon {

struct CollisionSurface {
  // Vertices of the system. Every end of an edge is among the points and every side of a triangle among the edges, each
  // once.
  std::vector<int> points;
  std::vector<std::array<int, 2>> edges;
  std::vector<std::array<int, 3>> triangles;

  std::vector<int> object;   // per vertex of the system: which object it belongs to
  std::vector<char> moving;  // per vertex of the system: it has a degree of freedom or is scripted
  // Primitives of which no vertex is `moving` are never tested against one another, nor are those that share a vertex.

  // Per point and edge: what a pair of it with a triangle, or the mean of two edges, counts; empty: 1.
  std::vector<double> point_weight, edge_weight;

  std::vector<double> radius;           // m, per object: half the thickness, by which its primitives are fattened
  std::vector<std::vector<char>> meet;  // per pair of objects, symmetric: may they touch; on the diagonal: themselves
  std::vector<std::string> names;       // per object, for messages
  RestOffsets rest_offsets;             // of pairs within one object that are near at rest; may be empty

  // m, the distance of mid-surfaces at which two objects of this thickness touch.
  double offset(int object_a, int object_b) const {
    return radius[static_cast<size_t>(object_a)] + radius[static_cast<size_t>(object_b)];
  }
  // The same of a pair of primitives, one of which has vertex a and the other vertex b.
  double offset(RestOffsets::Kind kind, const std::array<int, 2>& pair, int a, int b) const {
    const int object_a = object[static_cast<size_t>(a)], object_b = object[static_cast<size_t>(b)];
    if (object_a == object_b && !rest_offsets.empty()) {
      if (const std::uint32_t number = rest_offsets.number(kind, pair)) return rest_offsets.lowered(number);
    }
    return offset(object_a, object_b);
  }
};

}  // namespace ergon
