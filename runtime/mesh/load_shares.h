#pragma once
// How a force that is spread evenly over a part of a mesh acts on its vertices: the shares that do the same work on
// every displacement which the element's shape functions can make.

#include <Eigen/Core>
#include <vector>

#include "runtime/mesh/mesh.h"

namespace ergon {

// What carries an even load: faces (m^2) that belong to one cell only and have all their nodes among the vertices (of
// membranes the cells themselves); where there are none, edges between corners (m) likewise; else the vertices, each
// counting 1.
struct LoadShares {
  int dimension = 0;       // 2: faces, 1: edges, 0: vertices
  double measure = 0;      // their sum: m^2, m, or the count
  Eigen::VectorXd shares;  // per vertex of the mesh; they add to 1, and some may be negative
};

// `vertices` in any order. Integrals over faces and edges as they are curved, by a quadrature that is exact on flat
// ones. Throws InputError when there are no vertices.
LoadShares load_shares(const Mesh& mesh, const std::vector<int>& vertices);

}  // namespace ergon
