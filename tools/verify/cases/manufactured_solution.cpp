// A smooth field of displacements is chosen, the body force that it needs is found from the law, and the field must
// come back: with errors that fall as the elements' degree says when cells become smaller.

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "runtime/mesh/mesh_build.h"
#include "runtime/mesh/quadrature.h"
#include "tools/verify/model.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

constexpr double young = 1e5, poisson = 0.3;  // Pa, 1
constexpr int exactness = 7;                  // of integrals of the chosen field, which is no polynomial

Eigen::Vector3d displacement(const Eigen::Vector3d& X) {
  return 0.1 * Eigen::Vector3d(std::sin(2 * X[0] + X[1]), std::cos(X[0] + 2 * X[2]), std::sin(X[1] - 2 * X[2]));
}

Eigen::Matrix3d displacement_gradient(const Eigen::Vector3d& X) {
  const double a = std::cos(2 * X[0] + X[1]), b = -std::sin(X[0] + 2 * X[2]), c = std::cos(X[1] - 2 * X[2]);
  Eigen::Matrix3d out;
  out << 2 * a, a, 0, b, 0, 2 * b, 0, c, -2 * c;
  return 0.1 * out;
}

// Nominal stress of stable_neo_hookean, by hand, Pa.
Eigen::Matrix3d stress(const Eigen::Vector3d& X) {
  const double mu = young / (2 * (1 + poisson)), la = young * poisson / ((1 + poisson) * (1 - 2 * poisson)) + mu;
  const Eigen::Matrix3d F = Eigen::Matrix3d::Identity() + displacement_gradient(X);
  const double J = F.determinant();
  return mu * F + (la * (J - 1) - mu) * J * F.inverse().transpose();
}

// -Div P by differences of fourth order, whose error is far below that of any mesh; N/m^3.
Eigen::Vector3d body_force(const Eigen::Vector3d& X) {
  constexpr double h = 2e-3;
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(k);
    out -=
        (8 * (stress(X + step) - stress(X - step)) - (stress(X + 2 * step) - stress(X - 2 * step))).col(k) / (12 * h);
  }
  return out;
}

// Calls visit(place, weight in m^3, shape values, their gradients, the cell's nodes) for all points of quadrature.
template <class Visit>
void over_points(const Mesh& mesh, Visit visit) {
  const QuadratureRule rule = quadrature(mesh.element, exactness);
  const int nodes = nodes_of(mesh.element);
  for (size_t first = 0; first < mesh.cells.size(); first += static_cast<size_t>(nodes))
    for (size_t k = 0; k < rule.points.size(); ++k) {
      const Eigen::VectorXd values = shape_values(mesh.element, rule.points[k]);
      const Eigen::MatrixXd gradients = shape_gradients(mesh.element, rule.points[k]);
      Eigen::Vector3d X = Eigen::Vector3d::Zero();
      Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
      for (int i = 0; i < nodes; ++i) {
        const Eigen::Vector3d node = mesh.X.col(mesh.cells[first + static_cast<size_t>(i)]);
        X += values[i] * node;
        jacobian += node * gradients.row(i);
      }
      visit(X, rule.weights[k] * jacobian.determinant(), values, (gradients * jacobian.inverse()).eval(), first);
    }
}

struct FieldErrors {
  double l2 = 0, h1 = 0;  // of displacements and of their gradients, relative
};

FieldErrors errors_on(Element element, int n) {
  Model model(box_mesh(element, {1, 1, 1}, {n, n, n}));
  const Mesh& mesh = model.mesh();
  model.add("stable_neo_hookean", {{"E", {young}}, {"nu", {poisson}}});
  const int nodes = nodes_of(element);
  Eigen::Matrix3Xd force = Eigen::Matrix3Xd::Zero(3, mesh.vertices());
  over_points(mesh, [&](const Eigen::Vector3d& X, double weight, const Eigen::VectorXd& values, const Eigen::MatrixXd&,
                        size_t first) {
    const Eigen::Vector3d b = weight * body_force(X);
    for (int i = 0; i < nodes; ++i) force.col(mesh.cells[first + static_cast<size_t>(i)]) += values[i] * b;
  });
  for (int k = 0; k < 3; ++k) model.add_load(force.row(k), Eigen::Vector3d::Unit(k));
  model.hold(vertices_where(
      mesh, [](const Eigen::Vector3d& X) { return (X.array() < 1e-9).any() || (X.array() > 1 - 1e-9).any(); }));
  for (int v = 0; v < mesh.vertices(); ++v) model.x.col(v) += displacement(mesh.X.col(v));
  model.solve(1e-9);

  double l2 = 0, h1 = 0, all_l2 = 0, all_h1 = 0;
  over_points(mesh, [&](const Eigen::Vector3d& X, double weight, const Eigen::VectorXd& values,
                        const Eigen::MatrixXd& gradients, size_t first) {
    Eigen::Vector3d u = -X;
    Eigen::Matrix3d gradient = -Eigen::Matrix3d::Identity();
    for (int i = 0; i < nodes; ++i) {
      const Eigen::Vector3d x = model.x.col(mesh.cells[first + static_cast<size_t>(i)]);
      u += values[i] * x;
      gradient += x * gradients.row(i);
    }
    l2 += weight * (u - displacement(X)).squaredNorm();
    h1 += weight * (gradient - displacement_gradient(X)).squaredNorm();
    all_l2 += weight * displacement(X).squaredNorm();
    all_h1 += weight * displacement_gradient(X).squaredNorm();
  });
  return {std::sqrt(l2 / all_l2), std::sqrt(h1 / all_h1)};
}

void run(const VerifyRows& rows) {
  for (const Element element : all_elements()) {
    if (dimension_of(element) != 3) continue;
    const int degree = degree_of(element), n = (rows.quick() ? 4 : 8) / degree;
    const FieldErrors coarse = errors_on(element, n), fine = errors_on(element, 2 * n);
    const std::string mesh = std::to_string(n) + ", " + std::to_string(2 * n) + " per edge";
    const auto row = [&](const char* norm, double on_coarse, double on_fine, int order) {
      rows.add({.quantity = fmt::format("order in h, {}", norm),
                .element = name_of(element),
                .mesh = mesh,
                .value = std::log2(on_coarse / on_fine),
                .reference = static_cast<double>(order),
                .bound = 0.05,
                .note = fmt::format("relative error on the finer mesh {:.2g}", on_fine)});
    };
    row("L2 of displacements", coarse.l2, fine.l2, degree + 1);
    row("H1 seminorm of displacements", coarse.h1, fine.h1, degree);
  }
}

}  // namespace

VerifyCase manufactured_solution_case() {
  return {
      "manufactured_solution", "order of convergence of every solid element, at finite strain",
      "Roache 2002, Code verification by the method of manufactured solutions, J. Fluids Eng. 124(1); orders: Ciarlet "
      "1978, The finite element method for elliptic problems",
      run};
}

}  // namespace ergon
