#include <gtest/gtest.h>

#include "runtime/contact/distance.h"
#include "tests/runtime/exact_distance.h"
#include "tools/contact_cases.h"

namespace ergon {
namespace {

using Eigen::Vector3d;

// Error of a squared gap, relative to it and, where the parts touch, to the size of the parts.
constexpr double kRelative = 1e-9, kTouching = 1e-30;

double extent(const FourPoints& x) {
  return std::max({(x[1] - x[0]).norm(), (x[2] - x[0]).norm(), (x[3] - x[0]).norm()});
}

void expect_near(double gap2, const mpq_class& exact, double size, const std::string& what) {
  const mpq_class error = abs(mpq_class(gap2) - exact);
  EXPECT_LE(error, mpq_class(kRelative) * exact + mpq_class(kTouching * kTouching) * mpq_class(size * size))
      << what << ": " << gap2 << " instead of " << exact.get_d();
}

// Weights stand on the part, are within it, and add to 1.
template <int corners>
void expect_weights(const double (&weight)[corners], unsigned part, const std::string& what) {
  double sum = 0;
  for (int i = 0; i < corners; ++i) {
    const bool on = (part >> i & 1u) != 0;
    EXPECT_EQ(weight[i] != 0, on) << what << ", weight " << i << " " << weight[i] << " of part " << part;
    EXPECT_GE(weight[i], 0) << what;
    sum += weight[i];
  }
  EXPECT_NEAR(sum, 1, 1e-15) << what;
}

std::string name(int kind, int trial) { return "kind " + std::to_string(kind) + ", trial " + std::to_string(trial); }

TEST(ContactDistance, PointTriangleAgreesWithExactArithmetic) {
  ContactCases cases(1);
  for (int kind = 0; kind < ContactCases::kPointTriangleKinds; ++kind) {
    for (int trial = 0; trial < 1000; ++trial) {
      const FourPoints x = cases.point_triangle(kind);
      const PointTriangleDistance found = point_triangle_distance(x[0], x[1], x[2], x[3]);
      expect_near(found.gap2,
                  exact::point_triangle(exact::point(x[0]), exact::point(x[1]), exact::point(x[2]), exact::point(x[3])),
                  extent(x), name(kind, trial));
      expect_weights(found.weight, found.part, name(kind, trial));
      const Vector3d on = found.weight[0] * x[1] + found.weight[1] * x[2] + found.weight[2] * x[3];
      const double size = x[0].norm() + x[1].norm() + x[2].norm() + x[3].norm();
      EXPECT_NEAR((on - x[0]).norm(), std::sqrt(found.gap2), 1e-15 * size) << name(kind, trial);
    }
  }
}

TEST(ContactDistance, EdgeEdgeAgreesWithExactArithmetic) {
  ContactCases cases(2);
  for (int kind = 0; kind < ContactCases::kEdgeEdgeKinds; ++kind) {
    for (int trial = 0; trial < 1000; ++trial) {
      const FourPoints x = cases.edge_edge(kind);
      const EdgeEdgeDistance found = edge_edge_distance(x[0], x[1], x[2], x[3]);
      expect_near(found.gap2,
                  exact::edge_edge(exact::point(x[0]), exact::point(x[1]), exact::point(x[2]), exact::point(x[3])),
                  extent(x), name(kind, trial));
      expect_weights(found.weight_a, found.part_a, name(kind, trial));
      expect_weights(found.weight_b, found.part_b, name(kind, trial));
      const Vector3d on_a = found.weight_a[0] * x[0] + found.weight_a[1] * x[1];
      const Vector3d on_b = found.weight_b[0] * x[2] + found.weight_b[1] * x[3];
      const double size = x[0].norm() + x[1].norm() + x[2].norm() + x[3].norm();
      EXPECT_NEAR((on_b - on_a).norm(), std::sqrt(found.gap2), 1e-15 * size) << name(kind, trial);
    }
  }
}

TEST(ContactDistance, PointEdgeAgreesWithExactArithmetic) {
  ContactCases cases(3);
  for (int kind = 0; kind < ContactCases::kPointTriangleKinds; ++kind) {
    for (int trial = 0; trial < 1000; ++trial) {
      const FourPoints x = cases.point_triangle(kind);
      const PointEdgeDistance found = point_edge_distance(x[0], x[1], x[2]);
      expect_near(found.gap2, exact::point_edge(exact::point(x[0]), exact::point(x[1]), exact::point(x[2])), extent(x),
                  name(kind, trial));
      expect_weights(found.weight, found.part, name(kind, trial));
    }
  }
}

TEST(ContactDistance, NamesThePartsThatAreNearest) {
  const Vector3d t0(0, 0, 0), t1(4, 0, 0), t2(0, 4, 0);
  const auto part = [&](double x, double y) { return point_triangle_distance({x, y, 1}, t0, t1, t2).part; };
  EXPECT_EQ(part(1, 1), 7u);
  EXPECT_EQ(part(-1, -1), 1u);
  EXPECT_EQ(part(6, 0), 2u);
  EXPECT_EQ(part(-1, 6), 4u);
  EXPECT_EQ(part(2, -1), 3u);
  EXPECT_EQ(part(3, 3), 6u);
  EXPECT_EQ(part(-1, 2), 5u);
  EXPECT_EQ(point_triangle_distance({1, 1, 1}, t0, t0, t0).part, 1u);  // no extent at all

  const auto parts = [](const Vector3d& b0, const Vector3d& b1) {
    const EdgeEdgeDistance d = edge_edge_distance({0, 0, 0}, {4, 0, 0}, b0, b1);
    return std::array<unsigned, 2>{d.part_a, d.part_b};
  };
  using Parts = std::array<unsigned, 2>;
  EXPECT_EQ(parts({2, -1, 1}, {2, 1, 1}), (Parts{3, 3}));
  EXPECT_EQ(parts({2, 1, 0}, {2, 2, 0}), (Parts{3, 1}));
  EXPECT_EQ(parts({2, 2, 0}, {2, 1, 0}), (Parts{3, 2}));
  EXPECT_EQ(parts({-1, -1, 0}, {-1, 1, 0}), (Parts{1, 3}));
  EXPECT_EQ(parts({6, 0, 0}, {9, 0, 0}), (Parts{2, 1}));
  EXPECT_EQ(parts({4, 0, 0}, {9, 0, 0}), (Parts{2, 1}));  // end to end
}

// Between parallel edges the insides are never named: their common normal is zero.
TEST(ContactDistance, ParallelEdgesAreNearestAtAnEnd) {
  ContactCases cases(4);
  for (int trial = 0; trial < 2000; ++trial) {
    const FourPoints x = cases.edge_edge(7);
    const EdgeEdgeDistance found = edge_edge_distance(x[0], x[1], x[2], x[3]);
    EXPECT_FALSE(found.part_a == 3 && found.part_b == 3) << trial;
  }
}

}  // namespace
}  // namespace ergon
