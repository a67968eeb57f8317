#include "runtime/mesh/element.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numeric>

#include "runtime/error.h"

namespace ergon {
namespace {

struct ElementRow {
  Element element;
  const char* name;
  int nodes;
  int dimension;
  int vtk_cell_type;  // vtkCellType.h
};

constexpr std::array<ElementRow, 6> kElements{{{Element::point, "Point", 1, 0, 1},
                                               {Element::edge2, "Edge2", 2, 1, 3},
                                               {Element::tri3, "Tri3", 3, 2, 5},
                                               {Element::tet4, "Tet4", 4, 3, 10},
                                               {Element::tet10, "Tet10", 10, 3, 24},
                                               {Element::hex8, "Hex8", 8, 3, 12}}};

const ElementRow& row_of(Element element) { return kElements[static_cast<size_t>(element)]; }

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<size_t> previous(b.size() + 1), current(b.size() + 1);
  std::iota(previous.begin(), previous.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    current[0] = i + 1;
    for (size_t j = 0; j < b.size(); ++j) {
      current[j + 1] = std::min({previous[j + 1] + 1, current[j] + 1, previous[j] + (a[i] == b[j] ? 0 : 1)});
    }
    std::swap(previous, current);
  }
  return previous[b.size()];
}

// Corner pairs of the mid-edge nodes 4 to 9 of a Tet10, in VTK's order.
constexpr std::array<std::array<int, 2>, 6> kTet10Edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

// Corners of the unit cube in VTK's order.
constexpr std::array<std::array<int, 3>, 8> kHexCorners{
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

// Barycentric coordinates of a point of the unit simplex; their gradients are constant.
Eigen::VectorXd barycentric(int dimension, const Eigen::Vector3d& point) {
  Eigen::VectorXd lambda(dimension + 1);
  lambda.tail(dimension) = point.head(dimension);
  lambda(0) = 1 - lambda.tail(dimension).sum();
  return lambda;
}

Eigen::MatrixXd barycentric_gradients(int dimension) {
  Eigen::MatrixXd gradients(dimension + 1, dimension);
  gradients.row(0).setConstant(-1);
  gradients.bottomRows(dimension).setIdentity();
  return gradients;
}

}  // namespace

int nodes_of(Element element) { return row_of(element).nodes; }
int dimension_of(Element element) { return row_of(element).dimension; }
std::string name_of(Element element) { return row_of(element).name; }
int vtk_cell_type(Element element) { return row_of(element).vtk_cell_type; }

Element element_named(std::string_view name) {
  const std::string wanted = lower_case(name);
  const ElementRow* nearest = nullptr;
  size_t nearest_distance = 3;
  std::string known;
  for (const ElementRow& row : kElements) {
    const std::string candidate = lower_case(row.name);
    if (candidate == wanted) return row.element;
    const size_t distance = edit_distance(candidate, wanted);
    if (distance < nearest_distance) {
      nearest_distance = distance;
      nearest = &row;
    }
    known += (known.empty() ? "" : ", ") + std::string(row.name);
  }
  const std::string remedy =
      nearest ? "; did you mean '" + std::string(nearest->name) + "'?" : "; known elements are " + known;
  throw InputError("unknown element '" + std::string(name) + "'" + remedy);
}

QuadratureRule default_quadrature(Element element) {
  QuadratureRule rule;
  switch (element) {
    case Element::point:
      return {{Eigen::Vector3d::Zero()}, {1.0}, 0};
    case Element::edge2:
      return {{Eigen::Vector3d(0.5, 0, 0)}, {1.0}, 1};
    case Element::tri3:
      return {{Eigen::Vector3d(1.0 / 3, 1.0 / 3, 0)}, {0.5}, 1};
    case Element::tet4:
      return {{Eigen::Vector3d::Constant(0.25)}, {1.0 / 6}, 1};
    case Element::tet10: {
      const double a = (5 - std::sqrt(5.0)) / 20;
      rule.points.assign(4, Eigen::Vector3d::Constant(a));
      for (int i = 0; i < 3; ++i) rule.points[static_cast<size_t>(i) + 1](i) = 1 - 3 * a;
      rule.weights.assign(4, 1.0 / 24);
      rule.exactness = 2;
      return rule;
    }
    case Element::hex8: {
      const double offset = 0.5 / std::sqrt(3.0);
      for (const auto& corner : kHexCorners) {
        rule.points.push_back(Eigen::Vector3d(corner[0] - 0.5, corner[1] - 0.5, corner[2] - 0.5) * (2 * offset) +
                              Eigen::Vector3d::Constant(0.5));
      }
      rule.weights.assign(8, 0.125);
      rule.exactness = 3;
      return rule;
    }
  }
  return rule;
}

Eigen::VectorXd shape_values(Element element, const Eigen::Vector3d& point) {
  if (element == Element::hex8) {
    Eigen::VectorXd values(8);
    for (int node = 0; node < 8; ++node) {
      double product = 1;
      for (size_t axis = 0; axis < 3; ++axis) {
        const double t = point(static_cast<int>(axis));
        product *= kHexCorners[static_cast<size_t>(node)][axis] ? t : 1 - t;
      }
      values(node) = product;
    }
    return values;
  }
  const Eigen::VectorXd lambda = barycentric(dimension_of(element), point);
  if (element != Element::tet10) return lambda;
  Eigen::VectorXd values(10);
  for (int i = 0; i < 4; ++i) values(i) = lambda(i) * (2 * lambda(i) - 1);
  for (int e = 0; e < 6; ++e) {
    const auto& edge = kTet10Edges[static_cast<size_t>(e)];
    values(4 + e) = 4 * lambda(edge[0]) * lambda(edge[1]);
  }
  return values;
}

Eigen::MatrixXd shape_gradients(Element element, const Eigen::Vector3d& point) {
  if (element == Element::hex8) {
    Eigen::MatrixXd gradients(8, 3);
    for (int node = 0; node < 8; ++node) {
      const auto& corner = kHexCorners[static_cast<size_t>(node)];
      for (size_t derived = 0; derived < 3; ++derived) {
        double product = 1;
        for (size_t axis = 0; axis < 3; ++axis) {
          const double t = point(static_cast<int>(axis));
          product *= axis == derived ? (corner[axis] ? 1 : -1) : (corner[axis] ? t : 1 - t);
        }
        gradients(node, static_cast<int>(derived)) = product;
      }
    }
    return gradients;
  }
  const int dimension = dimension_of(element);
  const Eigen::MatrixXd lambda_gradients = barycentric_gradients(dimension);
  if (element != Element::tet10) return lambda_gradients;
  const Eigen::VectorXd lambda = barycentric(dimension, point);
  Eigen::MatrixXd gradients(10, 3);
  for (int i = 0; i < 4; ++i) gradients.row(i) = (4 * lambda(i) - 1) * lambda_gradients.row(i);
  for (int e = 0; e < 6; ++e) {
    const auto& [a, b] = kTet10Edges[static_cast<size_t>(e)];
    gradients.row(4 + e) = 4 * (lambda(a) * lambda_gradients.row(b) + lambda(b) * lambda_gradients.row(a));
  }
  return gradients;
}

}  // namespace ergon
