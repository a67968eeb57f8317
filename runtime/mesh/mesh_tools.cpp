#include "runtime/mesh/mesh_tools.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "runtime/error.h"

namespace ergon {
namespace {

// Ratio of rest to reference volume at a point with the given shape gradients; signed for solids.
double volume_factor(const Mesh& mesh, const int* nodes, const Eigen::MatrixXd& gradients) {
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < gradients.rows(); ++i) {
    jacobian.leftCols(gradients.cols()) += mesh.X.col(nodes[i]) * gradients.row(i);
  }
  switch (gradients.cols()) {
    case 3:
      return jacobian.determinant();
    case 2:
      return jacobian.col(0).cross(jacobian.col(1)).norm();
    case 1:
      return jacobian.col(0).norm();
    default:
      return 1;
  }
}

std::vector<Eigen::MatrixXd> gradients_at(Element element, const std::vector<Eigen::Vector3d>& points) {
  std::vector<Eigen::MatrixXd> gradients;
  for (const Eigen::Vector3d& point : points) gradients.push_back(shape_gradients(element, point));
  return gradients;
}

// Where orientation is checked: the quadrature points and, on elements that can bend, the nodes.
std::vector<Eigen::Vector3d> checked_points(Element element) {
  std::vector<Eigen::Vector3d> points = default_quadrature(element).points;
  if (element == Element::hex8 || element == Element::tet10) {
    const double top = element == Element::hex8 ? 1.0 : 0.5;
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
          const bool node = element == Element::hex8 ? i != 1 && j != 1 && k != 1 : i + j + k <= 2;
          if (node) points.push_back(Eigen::Vector3d(i, j, k) * (element == Element::hex8 ? top / 2 : top));
        }
      }
    }
  }
  return points;
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

void check_mesh(const Mesh& mesh) {
  check_names(mesh);
  const int count = nodes_of(mesh.element);
  const int dimension = dimension_of(mesh.element);
  if (dimension == 0) return;
  const auto gradients = gradients_at(mesh.element, checked_points(mesh.element));
  int bad = 0, first = -1;
  for (int c = 0; c < mesh.cell_count(); ++c) {
    const int* nodes = &mesh.cells[static_cast<size_t>(c) * static_cast<size_t>(count)];
    const double smallest = 1e-12 * std::pow(extent_of(mesh, nodes, count), dimension);
    const bool sound = std::all_of(gradients.begin(), gradients.end(),
                                   [&](const auto& g) { return volume_factor(mesh, nodes, g) > smallest; });
    if (!sound && bad++ == 0) first = c;
  }
  if (bad == 0) return;
  const int* nodes = &mesh.cells[static_cast<size_t>(first) * static_cast<size_t>(count)];
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& g : gradients) lowest = std::min(lowest, volume_factor(mesh, nodes, g));
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
  const QuadratureRule rule = default_quadrature(mesh.element);
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
  Eigen::VectorXd masses = Eigen::VectorXd::Zero(mesh.vertices());
  const size_t count = static_cast<size_t>(nodes_of(mesh.element));
  if (mesh.element == Element::hex8) {
    // A node's shape function times the volume factor has degree 3 along each axis: the rule is exact for it.
    const QuadratureRule rule = default_quadrature(mesh.element);
    const auto gradients = gradients_at(mesh.element, rule.points);
    for (size_t q = 0; q < gradients.size(); ++q) {
      const Eigen::VectorXd shape = shape_values(mesh.element, rule.points[q]);
      for (size_t c = 0; c < mesh.cells.size(); c += count) {
        const double mass = density * rule.weights[q] * volume_factor(mesh, &mesh.cells[c], gradients[q]);
        for (size_t i = 0; i < count; ++i) masses(mesh.cells[c + i]) += mass * shape(static_cast<Eigen::Index>(i));
      }
    }
    return masses;
  }
  const std::vector<double> volumes = rest_volumes(mesh);
  for (size_t c = 0; c < volumes.size(); ++c) {
    for (size_t i = 0; i < count; ++i) {
      const double share = mesh.element != Element::tet10 ? 1.0 / static_cast<double>(count)
                           : i < 4                        ? 1.0 / 36
                                                          : 4.0 / 27;
      masses(mesh.cells[c * count + i]) += density * volumes[c] * share;
    }
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
