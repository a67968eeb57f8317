#include "runtime/mesh/element.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "runtime/error.h"
#include "runtime/mesh/quadrature.h"

namespace ergon {
namespace {

class EveryElement : public ::testing::TestWithParam<Element> {
 protected:
  // Somewhere inside: a mean of the nodes with random positive weights.
  Eigen::Vector3d random_point() {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    double total = 0;
    for (const Eigen::Vector3d& node : reference_nodes(element_)) {
      const double weight = unit(generator_);
      point += weight * node;
      total += weight;
    }
    return point / total;
  }

  const Element element_ = GetParam();
  std::mt19937 generator_{7};
};

INSTANTIATE_TEST_SUITE_P(mesh_element, EveryElement, ::testing::ValuesIn(all_elements()),
                         [](const auto& info) { return name_of(info.param); });

TEST_P(EveryElement, shape_functions_are_a_partition_of_unity) {
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Vector3d p = random_point();
    const Eigen::VectorXd values = shape_values(element_, p);
    ASSERT_EQ(values.size(), nodes_of(element_));
    EXPECT_NEAR(values.sum(), 1.0, 2e-14);
    const Eigen::MatrixXd gradients = shape_gradients(element_, p);
    ASSERT_EQ(gradients.rows(), nodes_of(element_));
    ASSERT_EQ(gradients.cols(), dimension_of(element_));
    for (int axis = 0; axis < gradients.cols(); ++axis) EXPECT_NEAR(gradients.col(axis).sum(), 0.0, 1e-13);
  }
}

TEST_P(EveryElement, shape_functions_are_one_at_their_node) {
  const auto& nodes = reference_nodes(element_);
  ASSERT_EQ(static_cast<int>(nodes.size()), nodes_of(element_));
  for (size_t i = 0; i < nodes.size(); ++i) {
    const Eigen::VectorXd values = shape_values(element_, nodes[i]);
    for (size_t j = 0; j < nodes.size(); ++j)
      EXPECT_EQ(values(static_cast<int>(j)), i == j ? 1.0 : 0.0) << i << ' ' << j;
  }
}

TEST_P(EveryElement, gradients_match_central_differences) {
  const double h = 1e-5;
  const Eigen::Vector3d p = random_point();
  const Eigen::MatrixXd gradients = shape_gradients(element_, p);
  for (int axis = 0; axis < dimension_of(element_); ++axis) {
    const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(axis);
    const Eigen::VectorXd difference = (shape_values(element_, p + step) - shape_values(element_, p - step)) / (2 * h);
    EXPECT_LT((difference - gradients.col(axis)).cwiseAbs().maxCoeff(), 1e-9);
  }
}

// Every polynomial up to the element's degree is the sum of its values at the nodes, so its gradient too.
TEST_P(EveryElement, reproduces_polynomials) {
  const int degree = degree_of(element_), dimension = dimension_of(element_);
  const Eigen::Vector3d p = random_point();
  const Eigen::VectorXd values = shape_values(element_, p);
  const Eigen::MatrixXd gradients = shape_gradients(element_, p);
  for (int a = 0; a <= degree; ++a) {
    for (int b = 0; a + b <= (dimension > 1 ? degree : a); ++b) {
      for (int c = 0; a + b + c <= (dimension > 2 ? degree : a + b); ++c) {
        const auto f = [&](const Eigen::Vector3d& x) {
          return std::pow(x(0), a) * std::pow(x(1), b) * std::pow(x(2), c);
        };
        double value = 0;
        Eigen::VectorXd gradient = Eigen::VectorXd::Zero(dimension);
        for (int i = 0; i < nodes_of(element_); ++i) {
          const double at_node = f(reference_nodes(element_)[static_cast<size_t>(i)]);
          value += values(i) * at_node;
          gradient += gradients.row(i).transpose() * at_node;
        }
        EXPECT_NEAR(value, f(p), 1e-14);
        const Eigen::Vector3d exact(a == 0 ? 0 : a * f(p) / p(0), b == 0 ? 0 : b * f(p) / p(1),
                                    c == 0 ? 0 : c * f(p) / p(2));
        EXPECT_LT((gradient - exact.head(dimension)).norm(), 1e-13);
      }
    }
  }
}

// VTK's user's guide and the classes vtkQuadraticTetra, vtkQuadraticHexahedron, vtkTriQuadraticHexahedron,
// vtkBiQuadraticQuad, vtkQuadraticTriangle, vtkQuadraticEdge: corners of the edge or face amid which a node lies.
TEST(mesh_element, nodes_follow_vtk) {
  struct Row {
    Element element;
    int first;
    std::vector<std::vector<int>> amid;
  };
  const std::vector<std::vector<int>> cube_edges{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                                 {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  const std::vector<Row> rows{
      {Element::edge3, 2, {{0, 1}}},
      {Element::tri6, 3, {{0, 1}, {1, 2}, {2, 0}}},
      {Element::quad9, 4, {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 1, 2, 3}}},
      {Element::tet10, 4, {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}},
      {Element::hex20, 8, cube_edges},
      {Element::hex27, 8, cube_edges},
      {Element::hex27,
       20,
       {{0, 3, 7, 4}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 2, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7}}}};
  for (const Row& row : rows) {
    const auto& nodes = reference_nodes(row.element);
    for (size_t i = 0; i < row.amid.size(); ++i) {
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (const int corner : row.amid[i]) mean += nodes[static_cast<size_t>(corner)];
      EXPECT_EQ(nodes[static_cast<size_t>(row.first) + i], mean / static_cast<double>(row.amid[i].size()))
          << name_of(row.element) << ' ' << i;
    }
  }
  const std::vector<Eigen::Vector3d> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(reference_nodes(Element::quad4)[i], square[i]);
    EXPECT_EQ(reference_nodes(Element::hex8)[i], square[i]);
    EXPECT_EQ(reference_nodes(Element::hex8)[i + 4], square[i] + Eigen::Vector3d::UnitZ());
  }
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(reference_nodes(Element::prism6)[i], reference_nodes(Element::tri3)[i]);
    EXPECT_EQ(reference_nodes(Element::prism6)[i + 3], reference_nodes(Element::tri3)[i] + Eigen::Vector3d::UnitZ());
  }
}

TEST(mesh_element, cell_types_are_those_of_vtk) {
  std::vector<int> types;
  for (const Element element : all_elements()) types.push_back(vtk_cell_type(element));
  EXPECT_EQ(types, (std::vector<int>{1, 3, 21, 5, 22, 9, 28, 10, 24, 12, 25, 29, 13}));
}

double factorial(int n) { return std::tgamma(n + 1.0); }

// Integral of x^a y^b z^c in closed form: on a simplex of dimension n it is a! b! c!/(a + b + c + n)!, on products the
// product of the factors' integrals.
double monomial_integral(ReferenceShape shape, int a, int b, int c) {
  const auto simplex = [](int degrees, double factorials, int n) { return factorials / factorial(degrees + n); };
  switch (shape) {
    case ReferenceShape::triangle:
      return simplex(a + b, factorial(a) * factorial(b), 2);
    case ReferenceShape::tetrahedron:
      return simplex(a + b + c, factorial(a) * factorial(b) * factorial(c), 3);
    case ReferenceShape::prism:
      return simplex(a + b, factorial(a) * factorial(b), 2) / (c + 1);
    default:
      return 1.0 / ((a + 1) * (b + 1) * (c + 1));
  }
}

// The largest error of the rule over all monomials of the given total degree.
double quadrature_error(Element element, const QuadratureRule& rule, int degree) {
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
      worst = std::max(worst, std::abs(sum - monomial_integral(shape_of(element), a, b, c)));
    }
  }
  return worst;
}

TEST_P(EveryElement, quadrature_has_exactly_the_stated_exactness) {
  for (int asked = 0; asked <= kMaxExactness; ++asked) {
    const QuadratureRule rule = quadrature(element_, asked);
    EXPECT_TRUE(rule.exactness >= asked || dimension_of(element_) == 0) << asked;
    for (int degree = 0; degree <= rule.exactness; ++degree) {
      EXPECT_LT(quadrature_error(element_, rule, degree), 2e-15) << asked << " degree " << degree;
    }
    if (dimension_of(element_) > 0) {
      EXPECT_GT(quadrature_error(element_, rule, rule.exactness + 1), 1e-12) << asked;
    }
  }
}

TEST_P(EveryElement, quadrature_points_are_inside_with_positive_weights) {
  for (int asked = 0; asked <= kMaxExactness; ++asked) {
    const QuadratureRule rule = quadrature(element_, asked);
    for (size_t i = 0; i < rule.points.size(); ++i) {
      EXPECT_GT(rule.weights[i], 0);
      // Inside: a mean of the corners with positive weights.
      const Element corners[] = {Element::point, Element::edge2, Element::tri3,  Element::quad4,
                                 Element::tet4,  Element::hex8,  Element::prism6};
      const Element linear = corners[static_cast<size_t>(shape_of(element_))];
      EXPECT_GT(shape_values(linear, rule.points[i]).minCoeff(), 0);
    }
  }
}

TEST(mesh_element, default_rules_integrate_the_stiffness_of_straight_elements) {
  const std::vector<std::pair<Element, size_t>> points{
      {Element::point, 1},  {Element::edge2, 1},  {Element::edge3, 2}, {Element::tri3, 1},  {Element::tri6, 3},
      {Element::quad4, 4},  {Element::quad9, 9},  {Element::tet4, 1},  {Element::tet10, 4}, {Element::hex8, 8},
      {Element::hex20, 27}, {Element::hex27, 27}, {Element::prism6, 6}};
  for (const auto& [element, count] : points) {
    const QuadratureRule rule = default_quadrature(element), finer = quadrature(element, kMaxExactness);
    EXPECT_EQ(rule.points.size(), count) << name_of(element);
    const auto stiffness = [&, e = element](const QuadratureRule& q) {
      Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(nodes_of(e), nodes_of(e));
      for (size_t i = 0; i < q.points.size(); ++i) {
        const Eigen::MatrixXd dN = shape_gradients(e, q.points[i]);
        sum += q.weights[i] * dN * dN.transpose();
      }
      return sum;
    };
    EXPECT_LT((stiffness(rule) - stiffness(finer)).cwiseAbs().maxCoeff(), 1e-12) << name_of(element);
  }
}

TEST(mesh_element, quadrature_beyond_the_tables_is_refused) {
  const auto message = [](int exactness) -> std::string {
    try {
      quadrature(Element::tet4, exactness);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message(12), "there is no quadrature of exactness 12; give 0 to 11");
  EXPECT_EQ(message(-1), "there is no quadrature of exactness -1; give 0 to 11");
}

TEST(mesh_element, names_are_read_in_any_capitalisation) {
  for (const Element element : all_elements()) EXPECT_EQ(element_named(name_of(element)), element);
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
  EXPECT_EQ(message("wedge"),
            "unknown element 'wedge'; known elements are Point, Edge2, Edge3, Tri3, Tri6, Quad4, Quad9, Tet4, Tet10, "
            "Hex8, Hex20, Hex27, Prism6");
}

}  // namespace
}  // namespace ergon
