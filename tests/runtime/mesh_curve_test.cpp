#include "runtime/mesh/curve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "runtime/error.h"

namespace ergon {
namespace {

using Points = std::vector<Eigen::Vector3d>;

std::string error_of(const Points& points, bool closed, int cells) {
  try {
    smooth_curve(points, closed, cells);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

Points circle(int n) {
  Points points;
  for (int i = 0; i < n; ++i) points.emplace_back(std::cos(2 * M_PI * i / n), std::sin(2 * M_PI * i / n), 0);
  return points;
}

TEST(mesh_curve, lines_join_their_points) {
  const Mesh open = line_mesh(circle(4), false), closed = line_mesh(circle(4), true);
  EXPECT_EQ(open.element, Element::edge2);
  EXPECT_EQ(open.cells, (std::vector<int>{0, 1, 1, 2, 2, 3}));
  EXPECT_EQ(closed.cells, (std::vector<int>{0, 1, 1, 2, 2, 3, 3, 0}));
  const Mesh loose = point_mesh(circle(3));
  EXPECT_EQ(loose.element, Element::point);
  EXPECT_EQ(loose.cells, (std::vector<int>{0, 1, 2}));
}

TEST(mesh_curve, smooth_curves_go_through_their_points_in_equal_steps) {
  const Points four = {{0, 0, 0}, {1, 0.2, 0}, {1.5, 1, 0.3}, {1, 2, 1}};
  const Points fine = smooth_curve(four, false, 3000);
  ASSERT_EQ(fine.size(), 3001u);
  EXPECT_EQ(fine.front(), four.front());
  EXPECT_EQ(fine.back(), four.back());
  for (const Eigen::Vector3d& point : four) {
    double nearest = 1;
    for (const Eigen::Vector3d& p : fine) nearest = std::min(nearest, (p - point).norm());
    EXPECT_LT(nearest, 1e-3);
  }
  const double step = (fine[1] - fine[0]).norm();
  for (size_t i = 1; i < fine.size(); ++i) EXPECT_NEAR((fine[i] - fine[i - 1]).norm(), step, 2e-3 * step);
}

TEST(mesh_curve, a_closed_curve_through_points_of_a_circle_is_nearly_one) {
  const Points round = smooth_curve(circle(12), true, 100);
  ASSERT_EQ(round.size(), 100u);
  for (const Eigen::Vector3d& p : round) EXPECT_NEAR(p.norm(), 1, 2e-3);
  EXPECT_NEAR((round[0] - round[99]).norm(), (round[1] - round[0]).norm(), 1e-4);
}

TEST(mesh_curve, two_points_make_a_straight_line) {
  const Points line = smooth_curve({{0, 0, 0}, {2, 0, 0}}, false, 4);
  for (size_t i = 0; i < line.size(); ++i)
    EXPECT_NEAR((line[i] - Eigen::Vector3d(0.5 * double(i), 0, 0)).norm(), 0, 1e-12);
}

TEST(mesh_curve, bad_input_is_named) {
  EXPECT_EQ(error_of({{0, 0, 0}}, false, 1), "a line has 1 point; at least 2 are needed");
  EXPECT_EQ(error_of({{0, 0, 0}, {1, 0, 0}}, true, 1), "a closed line has 2 points; at least 3 are needed");
  EXPECT_EQ(error_of({{0, 0, 0}, {1, 0, 0}}, false, 0), "a line is cut into 0 cells; at least 1 is needed");
  EXPECT_EQ(error_of({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}}, false, 5),
            "points 1 and 2 of the line (counted from 0) are in one place");
  EXPECT_THROW(point_mesh({}), InputError);
  EXPECT_THROW(line_mesh({}, false), InputError);
}

}  // namespace
}  // namespace ergon
