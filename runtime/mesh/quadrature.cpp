#include "runtime/mesh/quadrature.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "runtime/error.h"

namespace ergon {
namespace {

QuadratureRule on_triangle(int exactness) {
  if (exactness == 2) {
    const double a = 1.0 / 6, b = 2.0 / 3;
    return {{{a, a, 0}, {b, a, 0}, {a, b, 0}}, {a, a, a}, 2};
  }
  const int n = exactness / 2 + 1;
  const GaussPoints s = gauss_points(n, 1), t = gauss_points(n);
  QuadratureRule rule;
  for (size_t i = 0; i < s.points.size(); ++i) {
    for (size_t j = 0; j < t.points.size(); ++j) {
      rule.points.emplace_back(s.points[i], (1 - s.points[i]) * t.points[j], 0);
      rule.weights.push_back(s.weights[i] * t.weights[j]);
    }
  }
  rule.exactness = 2 * n - 1;
  return rule;
}

QuadratureRule on_tetrahedron(int exactness) {
  if (exactness == 2) {
    const double a = (5 - std::sqrt(5.0)) / 20, b = 1 - 3 * a, w = 1.0 / 24;
    return {{{a, a, a}, {b, a, a}, {a, b, a}, {a, a, b}}, {w, w, w, w}, 2};
  }
  const int n = exactness / 2 + 1;
  const GaussPoints s = gauss_points(n, 2);
  const QuadratureRule slice = on_triangle(2 * n - 1);
  QuadratureRule rule;
  for (size_t i = 0; i < s.points.size(); ++i) {
    for (size_t j = 0; j < slice.points.size(); ++j) {
      const Eigen::Vector3d p = (1 - s.points[i]) * slice.points[j];
      rule.points.emplace_back(s.points[i], p.x(), p.y());
      rule.weights.push_back(s.weights[i] * slice.weights[j]);
    }
  }
  rule.exactness = 2 * n - 1;
  return rule;
}

// The product of a rule of lower dimension with Gauss points along the given axis.
QuadratureRule times_edge(const QuadratureRule& base, int axis, int exactness) {
  const int n = exactness / 2 + 1;
  const GaussPoints along = gauss_points(n);
  QuadratureRule rule;
  for (size_t j = 0; j < along.points.size(); ++j) {
    for (size_t i = 0; i < base.points.size(); ++i) {
      rule.points.push_back(base.points[i] + along.points[j] * Eigen::Vector3d::Unit(axis));
      rule.weights.push_back(base.weights[i] * along.weights[j]);
    }
  }
  rule.exactness = axis == 0 ? 2 * n - 1 : std::min(base.exactness, 2 * n - 1);
  return rule;
}

}  // namespace

GaussPoints gauss_points(int n, int power) {
  // Golub, Welsch 1969, Calculation of Gauss Quadrature Rules, Mathematics of Computation 23: eigenvalues of the
  // tridiagonal matrix of the recurrence of Jacobi polynomials, here for the weight (1 - x)^power on [-1, 1].
  Eigen::MatrixXd recurrence = Eigen::MatrixXd::Zero(n, n);
  const double a = power;
  for (int k = 0; k < n; ++k) {
    const double m = 2 * k + a;
    recurrence(k, k) = k == 0 ? -a / (a + 2) : -a * a / (m * (m + 2));
    if (k > 0) recurrence(k, k - 1) = 2 * k * (k + a) / (m * std::sqrt(m * m - 1));
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(recurrence);
  const Eigen::VectorXd weights = solver.eigenvectors().row(0).cwiseAbs2();
  GaussPoints rule;
  for (int i = 0; i < n; ++i) {
    rule.points.push_back((1 + solver.eigenvalues()(i)) / 2);
    rule.weights.push_back(weights(i) / (weights.sum() * (a + 1)));
  }
  return rule;
}

QuadratureRule quadrature(Element element, int exactness) {
  if (exactness < 0 || exactness > kMaxExactness) {
    throw InputError(fmt::format("there is no quadrature of exactness {}; give 0 to {}", exactness, kMaxExactness));
  }
  const QuadratureRule point{{Eigen::Vector3d::Zero()}, {1.0}, 0};
  switch (shape_of(element)) {
    case ReferenceShape::point:
      return point;
    case ReferenceShape::edge:
      return times_edge(point, 0, exactness);
    case ReferenceShape::triangle:
      return on_triangle(exactness);
    case ReferenceShape::quadrilateral:
      return times_edge(times_edge(point, 0, exactness), 1, exactness);
    case ReferenceShape::tetrahedron:
      return on_tetrahedron(exactness);
    case ReferenceShape::hexahedron:
      return times_edge(times_edge(times_edge(point, 0, exactness), 1, exactness), 2, exactness);
    case ReferenceShape::prism:
      return times_edge(on_triangle(exactness), 2, exactness);
  }
  return point;
}

int default_exactness(Element element) {
  const int degree = degree_of(element);
  switch (shape_of(element)) {
    case ReferenceShape::point:
    case ReferenceShape::edge:
    case ReferenceShape::triangle:
    case ReferenceShape::tetrahedron:
      return 2 * std::max(degree - 1, 0);
    default:
      return 2 * degree;  // a gradient along one axis keeps its degree along the others
  }
}

QuadratureRule default_quadrature(Element element) { return quadrature(element, default_exactness(element)); }

}  // namespace ergon
