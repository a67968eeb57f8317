#include "runtime/mesh/mesh_tools.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "runtime/error.h"
#include "runtime/mesh/quadrature.h"
#include "runtime/mesh/volume_factor.h"

namespace ergon {
namespace {

// The volume factor, negative where a membrane or line is turned back against its centre.
double oriented_factor(const Mesh& mesh, const int* nodes, const Eigen::MatrixXd& gradients,
                       const Eigen::MatrixXd& centre_gradients) {
  const CellJacobian here = jacobian_at(mesh, nodes, gradients);
  const double factor = volume_factor(here);
  if (here.cols() == 3 || here.cols() == 0) return factor;
  const CellJacobian centre = jacobian_at(mesh, nodes, centre_gradients);
  return (centre.transpose() * here).determinant() < 0 ? -factor : factor;
}

// Where orientation is checked; one point tells all of a linear simplex.
std::vector<Eigen::Vector3d> checked_points(Element element, int exactness) {
  std::vector<Eigen::Vector3d> points = quadrature(element, exactness).points;
  const std::vector<Eigen::Vector3d>& nodes = reference_nodes(element);
  if (!has_constant_gradients(element)) points.insert(points.end(), nodes.begin(), nodes.end());
  return points;
}

Eigen::Vector3d reference_centre(Element element) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& node : reference_nodes(element)) sum += node;
  return sum / nodes_of(element);
}

double extent_of(const Mesh& mesh, const int* nodes, int count) {
  Eigen::Vector3d lower = mesh.X.col(nodes[0]), upper = lower;
  for (int i = 1; i < count; ++i) {
    lower = lower.cwiseMin(mesh.X.col(nodes[i]));
    upper = upper.cwiseMax(mesh.X.col(nodes[i]));
  }
  return (upper - lower).norm();
}

std::string prefix_of(const Mesh& mesh) { return mesh.source.empty() ? "mesh: " : mesh.source + ": "; }

void check_names(const Mesh& mesh) {
  const int count = nodes_of(mesh.element);
  if (mesh.cells.size() % static_cast<size_t>(count) != 0) {
    throw InputError(fmt::format("{}{} node numbers do not divide into {} cells of {} nodes", prefix_of(mesh),
                                 mesh.cells.size(), name_of(mesh.element), count));
  }
  for (int v = 0; v < mesh.vertices(); ++v) {
    const Eigen::Vector3d X = mesh.X.col(v);
    if (!X.allFinite()) {
      throw InputError(fmt::format("{}vertex {} is not finite: ({}, {}, {})", prefix_of(mesh), v, X.x(), X.y(), X.z()));
    }
  }
  for (int c = 0; c < mesh.cell_count(); ++c) {
    const int* nodes = &mesh.cells[static_cast<size_t>(c) * static_cast<size_t>(count)];
    for (int i = 0; i < count; ++i) {
      if (nodes[i] < 0 || nodes[i] >= mesh.vertices()) {
        throw InputError(fmt::format("{}cell {} names vertex {}, but there are only {} (counted from 0)",
                                     prefix_of(mesh), c, nodes[i], mesh.vertices()));
      }
      if (std::find(nodes, nodes + i, nodes[i]) != nodes + i) {
        throw InputError(fmt::format("{}cell {} names vertex {} twice", prefix_of(mesh), c, nodes[i]));
      }
    }
  }
}

}  // namespace

void check_mesh(const Mesh& mesh) { check_mesh(mesh, default_exactness(mesh.element)); }

void check_mesh(const Mesh& mesh, int exactness) {
  check_names(mesh);
  const int count = nodes_of(mesh.element);
  const int dimension = dimension_of(mesh.element);
  if (dimension == 0) return;
  const auto gradients = gradients_at(mesh.element, checked_points(mesh.element, exactness));
  const Eigen::MatrixXd centre = shape_gradients(mesh.element, reference_centre(mesh.element));
  int bad = 0, first = -1;
  for (int c = 0; c < mesh.cell_count(); ++c) {
    const int* nodes = &mesh.cells[static_cast<size_t>(c) * static_cast<size_t>(count)];
    const double smallest = 1e-12 * std::pow(extent_of(mesh, nodes, count), dimension);
    const bool sound = std::all_of(gradients.begin(), gradients.end(),
                                   [&](const auto& g) { return oriented_factor(mesh, nodes, g, centre) > smallest; });
    if (!sound && bad++ == 0) first = c;
  }
  if (bad == 0) return;
  const int* nodes = &mesh.cells[static_cast<size_t>(first) * static_cast<size_t>(count)];
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& g : gradients) lowest = std::min(lowest, oriented_factor(mesh, nodes, g, centre));
  const double flat = 1e-12 * std::pow(extent_of(mesh, nodes, count), dimension);
  const bool inverted = lowest < -flat;
  const double volume = rest_volumes(mesh)[static_cast<size_t>(first)];
  const char* units[] = {"", "m", "m^2", "m^3"};
  const char* measures[] = {"", "length", "area", "volume"};
  throw InputError(fmt::format(
      "{}cell {} ({}, vertices {}) is {}: {} {:.6g} {}{}; {} of {} cells inverted or flat; {}", prefix_of(mesh), first,
      name_of(mesh.element), fmt::join(nodes, nodes + count, " "), inverted ? "inverted" : "flat", measures[dimension],
      volume, units[dimension],
      volume > flat ? fmt::format(", but {:.6g} {} per unit at one of its points", lowest, units[dimension]) : "", bad,
      mesh.cell_count(),
      inverted ? "reverse the order of its vertices or repair the mesh" : "remove it or repair the mesh"));
}

std::vector<double> rest_volumes(const Mesh& mesh) {
  // Along an axis the volume factor of a curved solid is of degree 3k - 1; on a simplex its total degree is 3k - 3.
  const int exactness = has_constant_gradients(mesh.element) ? 1 : 3 * degree_of(mesh.element) - 1;
  const QuadratureRule rule = quadrature(mesh.element, exactness);
  const auto gradients = gradients_at(mesh.element, rule.points);
  const size_t count = static_cast<size_t>(nodes_of(mesh.element));
  std::vector<double> volumes(mesh.cells.size() / count, 0.0);
  for (size_t c = 0; c < volumes.size(); ++c) {
    for (size_t q = 0; q < gradients.size(); ++q) {
      volumes[c] += rule.weights[q] * volume_factor(mesh, &mesh.cells[c * count], gradients[q]);
    }
  }
  return volumes;
}

Eigen::VectorXd lumped_masses(const Mesh& mesh, double density) {
  if (!(density > 0) || !std::isfinite(density)) {
    throw InputError(fmt::format("{}density is {}; it must be positive and finite", prefix_of(mesh), density));
  }
  const bool quadratic = degree_of(mesh.element) == 2;
  const QuadratureRule rule = quadrature(mesh.element, has_constant_gradients(mesh.element) ? 1 : quadratic ? 4 : 3);
  const auto gradients = gradients_at(mesh.element, rule.points);
  std::vector<Eigen::VectorXd> share;  // of the nodes, at each point
  for (const Eigen::Vector3d& point : rule.points) {
    share.push_back(shape_values(mesh.element, point));
    if (quadratic) share.back() = share.back().cwiseAbs2();
  }
  const std::vector<double> volumes = rest_volumes(mesh);
  const size_t count = static_cast<size_t>(nodes_of(mesh.element));
  Eigen::VectorXd masses = Eigen::VectorXd::Zero(mesh.vertices());
  Eigen::VectorXd shares(nodes_of(mesh.element));
  for (size_t c = 0; c < volumes.size(); ++c) {
    const int* nodes = &mesh.cells[c * count];
    shares.setZero();
    for (size_t q = 0; q < gradients.size(); ++q) {
      shares += rule.weights[q] * volume_factor(mesh, nodes, gradients[q]) * share[q];
    }
    shares *= density * volumes[c] / shares.sum();
    for (size_t i = 0; i < count; ++i) masses(nodes[i]) += shares(static_cast<Eigen::Index>(i));
  }
  return masses;
}

Mesh transformed(const Mesh& mesh, const Transform& transform) {
  if (!(transform.scale > 0) || !std::isfinite(transform.scale)) {
    throw InputError(fmt::format("{}scale is {}; it must be positive and finite", prefix_of(mesh), transform.scale));
  }
  if (!std::isfinite(transform.angle) || !transform.translation.allFinite()) {
    throw InputError(prefix_of(mesh) + "rotation angle and translation must be finite");
  }
  const double length = transform.axis.norm();
  if (!(length > 0) || !std::isfinite(length)) {
    throw InputError(prefix_of(mesh) + "rotation axis must be finite and not zero");
  }
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(transform.angle, transform.axis / length).toRotationMatrix();
  Mesh moved = mesh;
  moved.X = ((transform.scale * rotation) * mesh.X).colwise() + transform.translation;
  return moved;
}

std::vector<int> vertices_in_box(const Mesh& mesh, const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) {
  std::vector<int> inside;
  for (int v = 0; v < mesh.vertices(); ++v) {
    const auto X = mesh.X.col(v).array();
    if ((X >= lower.array()).all() && (X <= upper.array()).all()) inside.push_back(v);
  }
  return inside;
}

Eigen::Matrix<double, 3, 2> bounding_box(const Mesh& mesh) {
  if (mesh.vertices() == 0) throw InputError(prefix_of(mesh) + "a mesh without vertices has no extent");
  Eigen::Matrix<double, 3, 2> box;
  box << mesh.X.rowwise().minCoeff(), mesh.X.rowwise().maxCoeff();
  return box;
}

}  // namespace ergon
