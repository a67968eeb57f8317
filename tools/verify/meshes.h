#pragma once
// Structured meshes of the shapes that published problems have.

#include "runtime/mesh/mesh.h"

namespace ergon {

// A cylinder around the z axis from z = 0, of hexahedra: a square of n by n cells amid, n rings of cells around it, and
// cells along z about as long as wide. Nodes of an element of degree 2 on the outside lie on the circle. For Hex8,
// Hex20 and Hex27.
Mesh round_column(Element element, double radius, double height, int n);

// A strip of equilateral triangles in the plane z = 0, from x = 0: columns of vertices `cell` apart along x, and
// `across` triangles' sides along y; every other column has half triangles at its ends.
Mesh equilateral_strip(double cell, int along, int across);

// A part of a pipe of mid-surface `radius` around the x axis, from x = 0 to `length` and from the direction z (angle 0)
// to the direction y (`angle`, rad), of one cell through its thickness. Nodes lie on the cylinders. For hexahedra.
Mesh pipe_sector(Element element, double radius, double thickness, double length, double angle, int along, int around);

}  // namespace ergon
