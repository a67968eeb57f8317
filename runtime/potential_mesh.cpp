// A density on the cells of a mesh: gradients of the shape functions at rest, per point of quadrature.

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>

#include "runtime/error.h"
#include "runtime/mesh/quadrature.h"
#include "runtime/potential_data.h"

namespace ergon {
namespace {

int dimension_of_geometry(const std::string& geometry) {
  if (geometry == "solid") return 3;
  return geometry == "membrane" ? 2 : 1;
}

struct CellRule {
  std::vector<Eigen::MatrixXd> gradients;  // per point of quadrature: nodes x dimension, in the reference element
  std::vector<double> weights;
};

CellRule rule_of(Element element) {
  const QuadratureRule rule = default_quadrature(element);
  CellRule cell;
  cell.weights = rule.weights;
  for (const Eigen::Vector3d& point : rule.points) cell.gradients.push_back(shape_gradients(element, point));
  return cell;
}

// Gradients of the shape functions in the cell's own orthonormal frame (nodes x dimension) and the determinant of the
// map from the reference element. The frame of a solid is that of space; a membrane's or line's first axis is along the
// first direction of the reference element.
double rest_gradients(const Eigen::Matrix3Xd& nodes, const Eigen::MatrixXd& reference, Eigen::MatrixXd& gradients) {
  const Eigen::MatrixXd map = nodes * reference;  // 3 x dimension
  const auto d = map.cols();
  Eigen::MatrixXd local = map;
  if (d < 3) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(map);
    local = qr.matrixQR().topRows(d).triangularView<Eigen::Upper>();
    for (Eigen::Index i = 0; i < d; ++i) {
      if (local(i, i) < 0) local.row(i) *= -1;
    }
  }
  const double determinant = local.determinant();
  gradients = reference * local.inverse();
  return determinant;
}

std::string node_list(const Mesh& mesh, int cell) {
  const auto n = static_cast<size_t>(nodes_of(mesh.element));
  const auto first = mesh.cells.begin() + static_cast<ptrdiff_t>(static_cast<size_t>(cell) * n);
  return fmt::format("{}", fmt::join(first, first + static_cast<ptrdiff_t>(n), " "));
}

// Throws for the cell's first point of quadrature where the map is flat or turned inside out.
void check_cell(const Mesh& mesh, int cell, double determinant, double reference_volume, double extent) {
  const int d = dimension_of(mesh.element);
  const double volume = determinant * reference_volume;
  const double flat = 1e-12 * std::pow(extent, d);
  if (volume > flat) return;
  const std::string file = mesh.source.empty() ? "mesh" : mesh.source;
  const char* measure = d == 3 ? "volume" : d == 2 ? "area" : "length";
  const std::string unit = d == 3 ? " m^3" : d == 2 ? " m^2" : " m";
  if (!(volume < -flat)) {
    throw InputError(fmt::format("{}: cell {} (nodes {}) is flat: its {} is {:.6g}{}; remove or repair it", file, cell,
                                 node_list(mesh, cell), measure, volume, unit));
  }
  throw InputError(fmt::format("{}: cell {} (nodes {}) is inverted: its {} is {:.6g}{}; swap two of its nodes", file,
                               cell, node_list(mesh, cell), measure, volume, unit));
}

}  // namespace

Potential Potential::on_mesh(std::string name, Kernel kernel, const Mesh& mesh, int first_vertex,
                             const Parameters& params) {
  Potential potential{std::make_shared<Impl>()};
  Impl& d = *potential.impl;
  d.bind(std::move(name), std::move(kernel));
  if (!d.kernel->density) d.fail(fmt::format("{} is a stencil energy, not a density", d.kernel->energy));
  const int dimension = dimension_of(mesh.element);
  if (dimension_of_geometry(d.kernel->geometry) != dimension || d.kernel->q_vectors != dimension) {
    d.fail(fmt::format("{} is a density of a {}; {} cells have dimension {}", d.kernel->energy, d.kernel->geometry,
                       name_of(mesh.element), dimension));
  }
  const CellRule rule = rule_of(mesh.element);
  const int n = nodes_of(mesh.element);
  d.points = n;
  d.quadrature = static_cast<int>(rule.weights.size());
  d.count = mesh.cell_count();
  d.stencils = mesh.cells;
  for (size_t i = 0; i < mesh.cells.size(); ++i) {
    if (mesh.cells[i] < 0 || mesh.cells[i] >= mesh.vertices()) {
      d.fail(fmt::format("cell {} names vertex {}; vertices are 0 to {}", i / static_cast<size_t>(n), mesh.cells[i],
                         mesh.vertices() - 1));
    }
    d.stencils[i] += first_vertex;
  }
  d.first_vertex = first_vertex;
  if (d.kernel->displacement) d.rest = mesh.X;
  d.check_params(params);
  d.give_params(params);

  d.cut();
  const auto width = static_cast<size_t>(d.lanes), free = static_cast<size_t>(n - 1);
  const auto vectors = static_cast<size_t>(dimension), points = static_cast<size_t>(d.quadrature);
  const auto blocks = static_cast<size_t>(d.blocks());
  d.weights.resize(blocks * points * vectors * free * width);
  d.volumes.resize(blocks * points * width);
  const double reference_volume = std::accumulate(rule.weights.begin(), rule.weights.end(), 0.0);
  std::vector<int> sorted(d.stencils.size());
  std::vector<int> order(static_cast<size_t>(n));
  Eigen::Matrix3Xd nodes(3, n);
  Eigen::MatrixXd gradients;
  for (size_t lane = 0; lane < blocks * width; ++lane) {
    const int cell = d.stencil_in(static_cast<int>(lane / width), static_cast<int>(lane % width));
    const int* vertex = d.stencils.data() + static_cast<ptrdiff_t>(cell) * n;
    // In ascending order of vertex, as lanes::Stencils::vertices wants them.
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) { return vertex[a] < vertex[b]; });
    for (int a = 0; a < n; ++a) nodes.col(a) = mesh.X.col(vertex[a] - first_vertex);
    const double extent = (nodes.rowwise().maxCoeff() - nodes.rowwise().minCoeff()).norm();
    for (size_t p = 0; p < points; ++p) {
      const double determinant = rest_gradients(nodes, rule.gradients[p], gradients);
      check_cell(mesh, cell, determinant, reference_volume, extent);
      const size_t place = lane / width * points + p, l = lane % width;
      d.volumes[place * width + l] = determinant * rule.weights[p];
      for (size_t k = 0; k < vectors; ++k) {
        for (size_t a = 0; a < free; ++a) {
          d.weights[((place * vectors + k) * free + a) * width + l] = gradients(order[a], static_cast<Eigen::Index>(k));
        }
      }
    }
    for (int a = 0; a < n; ++a) {
      sorted[static_cast<size_t>(cell * n + a)] = vertex[order[static_cast<size_t>(a)]];
    }
  }
  d.order_vertices(sorted);
  d.allocate_raw();
  d.give_rest(mesh.X, {});
  return potential;
}

}  // namespace ergon
