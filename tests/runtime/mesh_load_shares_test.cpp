#include "runtime/mesh/load_shares.h"

#include <gtest/gtest.h>

#include "runtime/mesh/mesh_build.h"
#include "runtime/mesh/mesh_tools.h"
#include "tests/runtime/mesh_helpers.h"

namespace ergon {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

class LoadSharesOf : public testing::TestWithParam<Element> {};

// The work of an even load is exact for every field that the shape functions can make: those of degree 1 and 2 along an
// axis.
TEST_P(LoadSharesOf, DoTheWorkOfAnEvenLoad) {
  const Element element = GetParam();
  const int dimension = dimension_of(element);
  const Mesh mesh = box_mesh(element, {2, 3, 4}, {2, 3, 2});
  // The end x = 2 of a solid, the edge x = 2 of a membrane, the end of a line.
  const LoadShares at = load_shares(mesh, vertices_in_box(mesh, {2 - 1e-9, -inf, -inf}, {inf, inf, inf}));
  EXPECT_EQ(at.dimension, dimension - 1);
  EXPECT_NEAR(at.measure, dimension == 3 ? 12 : dimension == 2 ? 3 : 1, 1e-12);
  EXPECT_NEAR(at.shares.sum(), 1, 1e-14);
  const Eigen::VectorXd y = mesh.X.row(1), z = mesh.X.row(2);
  if (dimension > 1) {
    EXPECT_NEAR(at.shares.dot(y), 1.5, 1e-13);
  }
  if (dimension > 2) {
    EXPECT_NEAR(at.shares.dot(z), 2, 1e-13);
  }
  if (dimension > 1 && degree_of(element) == 2) {
    EXPECT_NEAR(at.shares.dot(y.cwiseAbs2()), 3, 1e-12);
  }  // mean of y^2
  for (int v = 0; v < mesh.vertices(); ++v) {
    if (mesh.X(0, v) < 2 - 1e-9) {
      EXPECT_EQ(at.shares[v], 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllElements, LoadSharesOf,
                         testing::Values(Element::edge2, Element::edge3, Element::tri3, Element::tri6, Element::quad4,
                                         Element::quad9, Element::tet4, Element::tet10, Element::hex8, Element::hex20,
                                         Element::hex27, Element::prism6),
                         [](const auto& each) { return name_of(each.param); });

TEST(LoadShares, ThePressureOnAMembraneIsOnItsCells) {
  const Mesh mesh = box_mesh(Element::quad4, {2, 1, 1}, {2, 1, 1});
  const LoadShares at = load_shares(mesh, {0, 1, 2, 3, 4, 5});
  EXPECT_EQ(at.dimension, 2);
  EXPECT_NEAR(at.measure, 2, 1e-14);
  EXPECT_NEAR(at.shares[1], 0.25, 1e-14);
  EXPECT_NEAR(at.shares[0], 0.125, 1e-14);
}

TEST(LoadShares, LonePointsCountAlike) {
  const Mesh mesh = box_mesh(Element::hex8, {1, 1, 1}, {1, 1, 1});
  const LoadShares at = load_shares(mesh, {0, 7});
  EXPECT_EQ(at.dimension, 0);
  EXPECT_EQ(at.measure, 2);
  EXPECT_EQ(at.shares[0], 0.5);
  EXPECT_EQ(at.shares[7], 0.5);
  EXPECT_EQ(message_of([&] { load_shares(mesh, {}); }), "a load needs at least one vertex to act on");
}

}  // namespace
}  // namespace ergon
