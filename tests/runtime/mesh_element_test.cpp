#include "runtime/mesh/element.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "runtime/error.h"

namespace ergon {
namespace {

const std::vector<Element> kAll{Element::point, Element::edge2, Element::tri3,
                                Element::tet4,  Element::tet10, Element::hex8};

// A random point inside the reference element.
Eigen::Vector3d random_point(Element element, std::mt19937& generator) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const int dimension = dimension_of(element);
  while (true) {
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    for (int i = 0; i < dimension; ++i) p(i) = unit(generator);
    if (element == Element::hex8 || p.sum() <= 1) return p;
  }
}

// The VTK positions of an element's nodes in the reference element.
std::vector<Eigen::Vector3d> reference_nodes(Element element) {
  if (element == Element::hex8) {
    return {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  }
  std::vector<Eigen::Vector3d> nodes{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (element == Element::tet10) {
    const int edges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    for (const auto& e : edges) {
      nodes.push_back((nodes[static_cast<size_t>(e[0])] + nodes[static_cast<size_t>(e[1])]) / 2);
    }
    return nodes;
  }
  nodes.resize(static_cast<size_t>(dimension_of(element)) + 1);
  return nodes;
}

double factorial(int n) { return std::tgamma(n + 1.0); }

// Integral of x^a y^b z^c over the reference element, in closed form: on a simplex of dimension n it is
// a! b! c!/(a + b + c + n)!, on the cube 1/((a + 1)(b + 1)(c + 1)).
double monomial_integral(Element element, int a, int b, int c) {
  if (element == Element::hex8) return 1.0 / ((a + 1) * (b + 1) * (c + 1));
  return factorial(a) * factorial(b) * factorial(c) / factorial(a + b + c + dimension_of(element));
}

// The largest error of the rule over all monomials of the given total degree.
double quadrature_error(Element element, int degree) {
  const QuadratureRule rule = default_quadrature(element);
  const int dimension = dimension_of(element);
  double worst = 0;
  for (int a = 0; a <= degree; ++a) {
    for (int b = 0; a + b <= degree; ++b) {
      const int c = degree - a - b;
      if ((dimension < 1 && a > 0) || (dimension < 2 && b > 0) || (dimension < 3 && c > 0)) continue;
      double sum = 0;
      for (size_t i = 0; i < rule.points.size(); ++i) {
        const Eigen::Vector3d& p = rule.points[i];
        sum += rule.weights[i] * std::pow(p.x(), a) * std::pow(p.y(), b) * std::pow(p.z(), c);
      }
      worst = std::max(worst, std::abs(sum - monomial_integral(element, a, b, c)));
    }
  }
  return worst;
}

TEST(mesh_element, shape_functions_are_a_partition_of_unity) {
  std::mt19937 generator(7);
  for (const Element element : kAll) {
    for (int trial = 0; trial < 20; ++trial) {
      const Eigen::Vector3d p = random_point(element, generator);
      const Eigen::VectorXd values = shape_values(element, p);
      ASSERT_EQ(values.size(), nodes_of(element)) << name_of(element);
      EXPECT_NEAR(values.sum(), 1.0, 1e-14) << name_of(element);
      const Eigen::MatrixXd gradients = shape_gradients(element, p);
      ASSERT_EQ(gradients.rows(), nodes_of(element));
      ASSERT_EQ(gradients.cols(), dimension_of(element));
      for (int axis = 0; axis < gradients.cols(); ++axis) {
        EXPECT_NEAR(gradients.col(axis).sum(), 0.0, 1e-14) << name_of(element);
      }
    }
  }
}

TEST(mesh_element, shape_functions_are_one_at_their_node_in_vtk_order) {
  for (const Element element : kAll) {
    const auto nodes = reference_nodes(element);
    ASSERT_EQ(static_cast<int>(nodes.size()), nodes_of(element));
    for (size_t i = 0; i < nodes.size(); ++i) {
      const Eigen::VectorXd values = shape_values(element, nodes[i]);
      for (size_t j = 0; j < nodes.size(); ++j) {
        EXPECT_NEAR(values(static_cast<int>(j)), i == j ? 1.0 : 0.0, 1e-15) << name_of(element) << ' ' << i << ' ' << j;
      }
    }
  }
}

TEST(mesh_element, gradients_match_central_differences) {
  std::mt19937 generator(11);
  const double h = 1e-5;
  for (const Element element : kAll) {
    const Eigen::Vector3d p = random_point(element, generator);
    const Eigen::MatrixXd gradients = shape_gradients(element, p);
    for (int axis = 0; axis < dimension_of(element); ++axis) {
      const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(axis);
      const Eigen::VectorXd difference = (shape_values(element, p + step) - shape_values(element, p - step)) / (2 * h);
      EXPECT_LT((difference - gradients.col(axis)).cwiseAbs().maxCoeff(), 1e-10) << name_of(element);
    }
  }
}

TEST(mesh_element, quadrature_has_exactly_the_stated_exactness) {
  for (const Element element : kAll) {
    const int exactness = default_quadrature(element).exactness;
    for (int degree = 0; degree <= exactness; ++degree) {
      EXPECT_LT(quadrature_error(element, degree), 1e-16) << name_of(element) << " degree " << degree;
    }
    if (dimension_of(element) > 0) {
      EXPECT_GT(quadrature_error(element, exactness + 1), 1e-4) << name_of(element);
    }
  }
  EXPECT_EQ(default_quadrature(Element::tet4).points.size(), 1U);
  EXPECT_EQ(default_quadrature(Element::tet10).points.size(), 4U);
  EXPECT_EQ(default_quadrature(Element::hex8).points.size(), 8U);
}

TEST(mesh_element, names_are_read_in_any_capitalisation) {
  for (const Element element : kAll) EXPECT_EQ(element_named(name_of(element)), element);
  EXPECT_EQ(element_named("tEt10"), Element::tet10);
}

TEST(mesh_element, unknown_names_get_the_nearest_or_the_list) {
  const auto message = [](const char* name) -> std::string {
    try {
      element_named(name);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message("tett4"), "unknown element 'tett4'; did you mean 'Tet4'?");
  EXPECT_EQ(message("prism"), "unknown element 'prism'; known elements are Point, Edge2, Tri3, Tet4, Tet10, Hex8");
}

}  // namespace
}  // namespace ergon
