#pragma once
// Where the data of laws stand, at the points of quadrature of cells or on stencils, and what data of vertices and
// cells are there. A density's rest data is ordered as sites_of_cells are, a stencil energy's as sites_of_stencils.

#include <optional>
#include <vector>

#include "runtime/mesh/mesh.h"

namespace ergon {

struct Sites {
  int points = 0;               // vertices that each site lies between
  std::vector<int> vertices;    // [site][points]
  std::vector<double> weights;  // [site][points]; those of a site add to 1
  std::vector<int> first_cell;  // into cells: from first_cell[site] to first_cell[site + 1]
  std::vector<int> cells;       // whose data a site takes the mean of

  int count() const { return static_cast<int>(first_cell.size()) - 1; }
  // 3 x sites, of positions of the mesh's vertices.
  Eigen::Matrix3Xd positions(const Eigen::Matrix3Xd& X) const;
  // Data at the sites, `components` numbers each (adjacent), from as many per vertex or cell. Throws
  // std::out_of_range for fewer.
  std::vector<double> of_vertices(const std::vector<double>& values, int components) const;
  std::vector<double> of_cells(const std::vector<double>& values, int components) const;
};

// The points of quadrature of the given exactness, or of the element's default one, cell by cell. Data of vertices are
// interpolated by shape functions.
Sites sites_of_cells(const Mesh& mesh, std::optional<int> exactness = std::nullopt);

// Stencils of `points` vertices of the mesh. Data of vertices: their mean. Data of cells: the mean of the cells that
// share the most vertices with the stencil: of an edge those that have it, of a hinge the two on its sides.
Sites sites_of_stencils(const Mesh& mesh, const std::vector<int>& stencils, int points);

}  // namespace ergon
