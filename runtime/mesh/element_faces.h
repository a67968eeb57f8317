#pragma once
// Edges and faces of elements, found from the positions of their nodes.

#include <array>
#include <vector>

#include "runtime/mesh/element.h"

namespace ergon {

// Pairs of corners that an edge joins.
std::vector<std::array<int, 2>> corner_edges(Element element);

// One face of a solid element, or a triangle or quadrilateral itself. `nodes` are numbers in the cell,
// counter-clockwise seen from outside: corners first, then the nodes amid edges (node i lies between corners i and i +
// 1) and the face.
struct ElementFace {
  int corners = 0;  // 3 or 4
  std::vector<int> nodes;
};

// Empty for points and edges.
const std::vector<ElementFace>& faces_of(Element element);

// Appends the triangles of a face with the given vertices, in the face's order, using all of them. Where four are left
// without a vertex amid them, the diagonal starts at the lowest number.
void append_triangles(const ElementFace& face, const std::vector<int>& vertices,
                      std::vector<std::array<int, 3>>& triangles);

}  // namespace ergon
