#include "runtime/mesh/sites.h"

#include <algorithm>
#include <map>

#include "runtime/mesh/quadrature.h"

namespace ergon {
namespace {

// The cells that each vertex belongs to.
std::vector<std::vector<int>> cells_of_vertices(const Mesh& mesh) {
  std::vector<std::vector<int>> out(static_cast<size_t>(mesh.vertices()));
  const auto n = static_cast<size_t>(nodes_of(mesh.element));
  for (size_t i = 0; i < mesh.cells.size(); ++i) {
    out[static_cast<size_t>(mesh.cells[i])].push_back(static_cast<int>(i / n));
  }
  return out;
}

}  // namespace

Eigen::Matrix3Xd Sites::positions(const Eigen::Matrix3Xd& X) const {
  const std::vector<double> values = of_vertices({X.data(), X.data() + X.size()}, 3);
  return Eigen::Map<const Eigen::Matrix3Xd>(values.data(), 3, count());
}

std::vector<double> Sites::of_vertices(const std::vector<double>& values, int components) const {
  const auto size = static_cast<size_t>(components), n = static_cast<size_t>(points);
  std::vector<double> out(static_cast<size_t>(count()) * size, 0.0);
  for (size_t i = 0; i < vertices.size(); ++i) {
    const auto from = static_cast<size_t>(vertices[i]) * size;
    for (size_t c = 0; c < size; ++c) out[i / n * size + c] += weights[i] * values.at(from + c);
  }
  return out;
}

std::vector<double> Sites::of_cells(const std::vector<double>& values, int components) const {
  const auto size = static_cast<size_t>(components);
  std::vector<double> out(static_cast<size_t>(count()) * size, 0.0);
  for (size_t site = 0; site + 1 < first_cell.size(); ++site) {
    const auto first = static_cast<size_t>(first_cell[site]), last = static_cast<size_t>(first_cell[site + 1]);
    for (size_t i = first; i < last; ++i) {
      const auto from = static_cast<size_t>(cells[i]) * size;
      for (size_t c = 0; c < size; ++c) out[site * size + c] += values.at(from + c) / static_cast<double>(last - first);
    }
  }
  return out;
}

Sites sites_of_cells(const Mesh& mesh, std::optional<int> exactness) {
  const QuadratureRule rule = quadrature(mesh.element, exactness.value_or(default_exactness(mesh.element)));
  Sites out;
  out.points = nodes_of(mesh.element);
  out.first_cell = {0};
  for (int cell = 0; cell < mesh.cell_count(); ++cell) {
    const auto nodes = mesh.cells.begin() + static_cast<ptrdiff_t>(cell) * out.points;
    for (const Eigen::Vector3d& point : rule.points) {
      const Eigen::VectorXd values = shape_values(mesh.element, point);
      out.vertices.insert(out.vertices.end(), nodes, nodes + out.points);
      out.weights.insert(out.weights.end(), values.begin(), values.end());
      out.cells.push_back(cell);
      out.first_cell.push_back(static_cast<int>(out.cells.size()));
    }
  }
  return out;
}

Sites sites_of_stencils(const Mesh& mesh, const std::vector<int>& stencils, int points) {
  const std::vector<std::vector<int>> around = cells_of_vertices(mesh);
  Sites out;
  out.points = points;
  out.vertices = stencils;
  out.weights.assign(stencils.size(), 1.0 / points);
  out.first_cell = {0};
  for (size_t first = 0; first < stencils.size(); first += static_cast<size_t>(points)) {
    std::map<int, int> shared;  // vertices, by cell
    int most = 0;
    for (size_t i = first; i < first + static_cast<size_t>(points); ++i) {
      for (const int cell : around[static_cast<size_t>(stencils[i])]) most = std::max(most, ++shared[cell]);
    }
    for (const auto& [cell, count] : shared) {
      if (count == most) out.cells.push_back(cell);
    }
    out.first_cell.push_back(static_cast<int>(out.cells.size()));
  }
  return out;
}

}  // namespace ergon
