#include "runtime/mesh/consistent_mass.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/error.h"
#include "runtime/mesh/mesh_tools.h"
#include "runtime/mesh/quadrature.h"
#include "runtime/mesh/volume_factor.h"

namespace ergon {
namespace {

std::string place_of(const Mesh& mesh) { return mesh.source.empty() ? "mesh" : mesh.source; }

// Of products of two shape functions with the volume factor of the cell's map; the latter as in rest_volumes.
int exactness_of(Element element) {
  const int product = 2 * degree_of(element);
  if (has_constant_gradients(element)) return product;
  return std::min(kMaxExactness, product + 3 * degree_of(element) - 1);
}

std::vector<Eigen::VectorXd> shapes_at(Element element, const QuadratureRule& rule) {
  std::vector<Eigen::VectorXd> out;
  for (const Eigen::Vector3d& point : rule.points) out.push_back(shape_values(element, point));
  return out;
}

// Per node: what a reference element of density 1 resists with at least, whatever its other nodes do.
Eigen::VectorXd reference_bound(Element element, const QuadratureRule& rule,
                                const std::vector<Eigen::VectorXd>& shapes) {
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(nodes_of(element), nodes_of(element));
  for (size_t q = 0; q < shapes.size(); ++q) mass += rule.weights[q] * shapes[q] * shapes[q].transpose();
  const Eigen::VectorXd scale = mass.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * mass * scale.asDiagonal();
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues()[0];
  return least * mass.diagonal();
}

}  // namespace

bool lumping_suits(Element element) {
  return element != Element::tri6 && element != Element::tet10 && element != Element::hex20;
}

CoupledMass consistent_mass(const Mesh& mesh, double density) {
  if (!(density > 0) || !std::isfinite(density)) {
    throw InputError(fmt::format("{}: density is {}; it must be positive and finite", place_of(mesh), density));
  }
  const QuadratureRule rule = quadrature(mesh.element, exactness_of(mesh.element));
  const std::vector<Eigen::MatrixXd> gradients = gradients_at(mesh.element, rule.points);
  const std::vector<Eigen::VectorXd> shapes = shapes_at(mesh.element, rule);
  const Eigen::VectorXd least = reference_bound(mesh.element, rule, shapes);
  const int n = nodes_of(mesh.element);
  CoupledMass out;
  out.bound = Eigen::VectorXd::Zero(mesh.vertices());
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(mesh.cells.size() * static_cast<size_t>(n));
  Eigen::MatrixXd cell(n, n);
  for (size_t first = 0; first < mesh.cells.size(); first += static_cast<size_t>(n)) {
    const int* nodes = &mesh.cells[first];
    cell.setZero();
    double smallest = std::numeric_limits<double>::infinity();
    for (size_t q = 0; q < shapes.size(); ++q) {
      const double factor = density * volume_factor(mesh, nodes, gradients[q]);
      smallest = std::min(smallest, factor);
      cell.selfadjointView<Eigen::Lower>().rankUpdate(shapes[q], rule.weights[q] * factor);
    }
    if (!(smallest > 0))
      throw InputError(
          fmt::format("{}: cell {} is inverted at a point of its mass; repair the mesh, or take mass = \"lumped\"",
                      place_of(mesh), first / static_cast<size_t>(n)));
    for (int j = 0; j < n; ++j) {
      out.bound[nodes[j]] += smallest * least[j];
      for (int i = 0; i < n; ++i) entries.emplace_back(nodes[i], nodes[j], i < j ? cell(j, i) : cell(i, j));
    }
  }
  out.mass.resize(mesh.vertices(), mesh.vertices());
  out.mass.setFromTriplets(entries.begin(), entries.end());
  return out;
}

CoupledMass::Matrix mass_matrix(const Mesh& mesh, double density) {
  if (!lumping_suits(mesh.element)) return consistent_mass(mesh, density).mass;
  return CoupledMass::Matrix(lumped_masses(mesh, density).asDiagonal());
}

}  // namespace ergon
