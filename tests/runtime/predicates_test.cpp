#include "runtime/predicates.h"

#include <gtest/gtest.h>

#include "tests/runtime/exact_distance.h"
#include "tools/contact_cases.h"

namespace ergon {
namespace {

using Eigen::Vector3d;

int exact_sign(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  using namespace exact;
  return sgn(dot(minus(point(a), point(d)), cross(minus(point(b), point(d)), minus(point(c), point(d)))));
}

// Four points that are in one plane, but for rounding.
FourPoints nearly_flat(ContactCases& cases) {
  FourPoints x{cases.vector(), cases.vector(), cases.vector(), {}};
  if (cases.integer(0, 2) == 0) x[2] = x[0] + cases.uniform(-1, 2) * (x[1] - x[0]);
  x[3] = x[0] + cases.uniform(-1, 2) * (x[1] - x[0]) + cases.uniform(-1, 2) * (x[2] - x[0]);
  const double size = std::pow(10, cases.integer(-6, 6));
  const Vector3d shift = cases.integer(0, 1) == 0 ? Vector3d::Zero() : Vector3d(1e6 * cases.vector());
  for (Vector3d& p : x) p = size * p + shift;
  return x;
}

TEST(Predicates, OrientationIsExact) {
  ContactCases cases(1);
  int zero = 0, unsure = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const FourPoints x =
        trial % 3 == 0 ? cases.point_triangle(trial % ContactCases::kPointTriangleKinds) : nearly_flat(cases);
    const int exact = exact_sign(x[0], x[1], x[2], x[3]), sure = sure_orientation(x[0], x[1], x[2], x[3]);
    ASSERT_EQ(orientation(x[0], x[1], x[2], x[3]), exact) << trial;
    ASSERT_TRUE(sure == 0 || sure == exact) << trial;
    zero += exact == 0 ? 1 : 0;
    unsure += sure == 0 ? 1 : 0;
  }
  EXPECT_GT(zero, 100);
  EXPECT_GT(unsure, 1000);
}

TEST(Predicates, OrientationHasItsSense) {
  EXPECT_EQ(orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}), 1);
  EXPECT_EQ(orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), -1);
  EXPECT_EQ(orientation_in_plane({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0, 1), 1);
  EXPECT_EQ(orientation_in_plane({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, 0), -1);
}

TEST(Predicates, OrientationInAPlaneIsExact) {
  ContactCases cases(2);
  for (int trial = 0; trial < 20000; ++trial) {
    const FourPoints x = nearly_flat(cases);
    const mpq_class u0 = x[0].x(), v0 = x[0].z(), u1 = x[1].x(), v1 = x[1].z(), u2 = x[2].x(), v2 = x[2].z();
    ASSERT_EQ(orientation_in_plane(x[0], x[1], x[2], 0, 2), sgn((u0 - u2) * (v1 - v2) - (v0 - v2) * (u1 - u2)))
        << trial;
  }
}

// By distances: where the segment pierces the plane, or of its ends and sides.
bool exactly_meets(const Vector3d& from, const Vector3d& to, const Vector3d& t0, const Vector3d& t1,
                   const Vector3d& t2) {
  using namespace exact;
  const Point p = point(from), q = point(to), a = point(t0), b = point(t1), c = point(t2);
  const Point normal = cross(minus(b, a), minus(c, a)), along = minus(q, p);
  const mpq_class rate = dot(normal, along);
  if (rate == 0) {
    return exact::point_triangle(p, a, b, c) == 0 || exact::point_triangle(q, a, b, c) == 0 ||
           exact::edge_edge(p, q, a, b) == 0 || exact::edge_edge(p, q, b, c) == 0 || exact::edge_edge(p, q, c, a) == 0;
  }
  const mpq_class s = dot(normal, minus(a, p)) / rate;
  if (s < 0 || s > 1) return false;
  return exact::point_triangle({p[0] + s * along[0], p[1] + s * along[1], p[2] + s * along[2]}, a, b, c) == 0;
}

TEST(Predicates, SegmentAndTriangleMeetAsExactArithmeticSays) {
  ContactCases cases(3);
  int meeting = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    FourPoints x = cases.point_triangle(4);
    Vector3d q = cases.whole();
    if (trial % 4 == 1) {  // degenerate, or nearly
      x[3] = x[1] + cases.integer(-1, 2) * (x[2] - x[1]);
      if (cases.integer(0, 3) == 0) x[2] = x[1];
      if (cases.integer(0, 3) == 0) q = x[0];
    } else if (trial % 4 == 2) {  // in one plane
      q.z() = 0;
      for (Vector3d& p : x) p.z() = 0;
    } else if (trial % 4 == 3) {  // one end on the triangle, but for rounding
      for (Vector3d& p : x) p = cases.vector();
      const double u = cases.uniform(0, 1), v = cases.integer(0, 1) * cases.uniform(0, 1 - u);
      x[0] = x[1] + u * (x[2] - x[1]) + v * (x[3] - x[1]);
    }
    const bool expected = exactly_meets(x[0], q, x[1], x[2], x[3]);
    ASSERT_EQ(segment_meets_triangle(x[0], q, x[1], x[2], x[3]), expected) << trial;
    ASSERT_EQ(segment_meets_triangle(q, x[0], x[3], x[1], x[2]), expected) << trial;
    meeting += expected ? 1 : 0;
  }
  EXPECT_GT(meeting, 3000);
  EXPECT_LT(meeting, 17000);
}

}  // namespace
}  // namespace ergon
