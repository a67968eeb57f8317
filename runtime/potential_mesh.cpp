// A density on the cells of a mesh: gradients of the shape functions at rest, per point of quadrature.

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>

#include "runtime/error.h"
#include "runtime/mesh/mesh_tools.h"
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

CellRule rule_of(Element element, int exactness) {
  const QuadratureRule rule = quadrature(element, exactness);
  CellRule cell;
  cell.weights = rule.weights;
  for (const Eigen::Vector3d& point : rule.points) cell.gradients.push_back(shape_gradients(element, point));
  return cell;
}

// The map from the reference element (dimension x dimension) in the cell's own orthonormal frame: that of space for a
// solid; of the tangents at this point for a membrane or line, its first axis along the first of the reference element.
Eigen::MatrixXd local_map(const Eigen::Matrix3Xd& nodes, const Eigen::MatrixXd& reference) {
  const Eigen::MatrixXd map = nodes * reference;  // 3 x dimension
  const auto d = map.cols();
  if (d == 3) return map;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(map);
  Eigen::MatrixXd local = qr.matrixQR().topRows(d).triangularView<Eigen::Upper>();
  for (Eigen::Index i = 0; i < d; ++i) {
    if (local(i, i) < 0) local.row(i) *= -1;
  }
  return local;
}

// The axes of that frame in space, as columns, completed to a right-handed three.
Eigen::Matrix3d local_axes(const Eigen::Matrix3Xd& nodes, const Eigen::MatrixXd& reference) {
  const Eigen::Matrix3Xd map = nodes * reference;
  const Eigen::Vector3d first = map.col(0).normalized();
  Eigen::Vector3d second = first.unitOrthogonal();
  if (map.cols() == 2) {
    const Eigen::Vector3d along = map.col(1);
    second = (along - first.dot(along) * first).normalized();
  }
  Eigen::Matrix3d axes;
  axes << first, second, first.cross(second);
  return axes;
}

// Fills `axis` and `nodes` as lanes::Stencils wants them.
void factor_table(Element element, std::vector<double>& axis, std::vector<int>& nodes) {
  const std::vector<double> points = gauss_points(3).points;
  Eigen::Matrix3d values, gradients;  // of the shape functions along an edge, by point and node
  const int edge_nodes[] = {0, 2, 1};
  for (int p = 0; p < 3; ++p) {
    const Eigen::Vector3d at(points[static_cast<size_t>(p)], 0, 0);
    for (int i = 0; i < 3; ++i) {
      values(p, i) = shape_values(Element::edge3, at)(edge_nodes[i]);
      gradients(p, i) = shape_gradients(Element::edge3, at)(edge_nodes[i], 0);
    }
  }
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> between = gradients * values.inverse(), rows = values;
  axis.assign(between.data(), between.data() + 9);
  axis.insert(axis.end(), rows.data(), rows.data() + 9);
  nodes.resize(27);
  for (size_t a = 0; a < 27; ++a) {
    const Eigen::Vector3i place = (2 * reference_nodes(element)[a]).cast<int>();
    nodes[static_cast<size_t>(place.dot(Eigen::Vector3i(1, 3, 9)))] = static_cast<int>(a);
  }
}

}  // namespace

Potential Potential::on_mesh(std::string name, Kernel kernel, const Mesh& mesh, int first_vertex,
                             const Parameters& params, std::optional<int> exactness, const StencilData& rest) {
  Potential potential{std::make_shared<Impl>()};
  Impl& d = *potential.impl;
  if (kernel.curvature)
    d.curvature = on_mesh(name, *kernel.curvature, mesh, first_vertex, params, exactness, rest).impl;
  d.bind(std::move(name), std::move(kernel));
  if (!d.kernel->density) d.fail(fmt::format("{} is a stencil energy, not a density", d.kernel->energy));
  const int dimension = dimension_of(mesh.element);
  if (dimension_of_geometry(d.kernel->geometry) != dimension || d.kernel->q_vectors != dimension) {
    d.fail(fmt::format("{} is a density of a {}; {} cells have dimension {}", d.kernel->energy, d.kernel->geometry,
                       name_of(mesh.element), dimension));
  }
  const int used = exactness.value_or(default_exactness(mesh.element));
  const CellRule rule = rule_of(mesh.element, used);
  const int n = nodes_of(mesh.element);
  d.points = d.listed = n;
  d.used.resize(static_cast<size_t>(n));
  std::iota(d.used.begin(), d.used.end(), 0);
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
  check_mesh(mesh, used);
  d.first_vertex = first_vertex;
  if (d.kernel->displacement) d.rest = mesh.X;
  d.check_params(params);
  d.give_params(params);

  d.cut();
  const bool constant = has_constant_gradients(mesh.element);
  const auto width = static_cast<size_t>(d.lanes), vectors = static_cast<size_t>(dimension);
  const auto points = static_cast<size_t>(d.quadrature), blocks = static_cast<size_t>(d.blocks());
  if (!constant) {
    for (const Eigen::MatrixXd& gradients : rule.gradients) {
      d.table.insert(d.table.end(), gradients.data(), gradients.data() + gradients.size());
    }
  }
  if (mesh.element == Element::hex27 && points == 27) factor_table(mesh.element, d.axis, d.axis_nodes);
  const size_t columns = constant ? static_cast<size_t>(n - 1) : vectors;
  d.weights.resize(blocks * points * vectors * columns * width);
  d.volumes.resize(blocks * points * width);
  if (d.kernel->displacement && dimension < 3) d.frames.resize(blocks * points * 9 * width);
  std::vector<int> ordered(d.stencils.size());
  std::vector<int> order(static_cast<size_t>(n));
  Eigen::Matrix3Xd nodes(3, n);
  for (size_t lane = 0; lane < blocks * width; ++lane) {
    const int cell = d.lane_stencil[lane];
    const int* vertex = d.stencils.data() + static_cast<ptrdiff_t>(cell) * n;
    std::iota(order.begin(), order.end(), 0);
    if (constant) std::sort(order.begin(), order.end(), [&](int a, int b) { return vertex[a] < vertex[b]; });
    for (int a = 0; a < n; ++a) nodes.col(a) = mesh.X.col(vertex[a] - first_vertex);
    for (size_t p = 0; p < points; ++p) {
      const Eigen::MatrixXd map = local_map(nodes, rule.gradients[p]), inverse = map.inverse();
      const size_t place = lane / width * points + p, l = lane % width;
      d.volumes[place * width + l] = map.determinant() * rule.weights[p];
      if (!d.frames.empty()) {
        const Eigen::Matrix3d axes = local_axes(nodes, rule.gradients[p]);
        for (size_t i = 0; i < 9; ++i) d.frames[(place * 9 + i) * width + l] = axes.data()[i];
      }
      double* out = d.weights.data() + place * vectors * columns * width + l;
      if (constant) {
        const Eigen::MatrixXd gradients = rule.gradients[p] * inverse;
        for (size_t k = 0; k < vectors; ++k) {
          for (size_t a = 0; a < columns; ++a) {
            out[(k * columns + a) * width] = gradients(order[a], static_cast<Eigen::Index>(k));
          }
        }
      } else {
        for (size_t i = 0; i < vectors * vectors; ++i) {
          out[i * width] = inverse(static_cast<Eigen::Index>(i / vectors), static_cast<Eigen::Index>(i % vectors));
        }
      }
    }
    for (int a = 0; a < n; ++a) {
      ordered[static_cast<size_t>(cell * n + a)] = vertex[order[static_cast<size_t>(a)]];
    }
  }
  d.order_vertices(ordered, n, d.used);
  d.allocate_raw();
  d.give_rest(mesh.X, rest);
  return potential;
}

}  // namespace ergon
