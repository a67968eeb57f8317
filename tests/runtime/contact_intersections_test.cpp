#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "runtime/contact/intersections.h"
#include "runtime/predicates.h"

namespace ergon {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// A grid of squares of side 1, halved, in the plane z = 0; each call adds one.
struct Sheets {
  CollisionSurface surface;
  std::vector<Vector3d> x;
  void add(int cells, const Vector3d& at, const Vector3d& u, const Vector3d& v, bool moving = true) {
    const int first = static_cast<int>(x.size()), object = static_cast<int>(surface.radius.size());
    const auto vertex = [&](int i, int j) { return first + i * (cells + 1) + j; };
    for (int i = 0; i <= cells; ++i) {
      for (int j = 0; j <= cells; ++j) {
        surface.points.push_back(static_cast<int>(x.size()));
        surface.object.push_back(object);
        surface.moving.push_back(moving);
        x.push_back(at + i * u + j * v);
        if (i < cells) surface.edges.push_back({vertex(i, j), vertex(i + 1, j)});
        if (j < cells) surface.edges.push_back({vertex(i, j), vertex(i, j + 1)});
        if (i == cells || j == cells) continue;
        surface.edges.push_back({vertex(i, j), vertex(i + 1, j + 1)});
        surface.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
        surface.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
      }
    }
    surface.radius.push_back(0);
    surface.names.push_back("sheet " + std::to_string(object));
    surface.meet.assign(surface.radius.size(), std::vector<char>(surface.radius.size(), 1));
  }
  Matrix3Xd positions() const {
    Matrix3Xd all(3, x.size());
    for (size_t i = 0; i < x.size(); ++i) all.col(static_cast<Eigen::Index>(i)) = x[i];
    return all;
  }
};

using Found = std::set<std::pair<std::array<int, 2>, std::array<int, 3>>>;

Found found(const CollisionSurface& surface, const Matrix3Xd& x) {
  Found all;
  for (const Intersection& i : find_intersections(surface, x)) EXPECT_TRUE(all.insert({i.edge, i.triangle}).second);
  return all;
}

Found each_with_each(const CollisionSurface& s, const Matrix3Xd& x) {
  Found all;
  const auto of = [](const auto& values, int i) { return values[static_cast<size_t>(i)]; };
  for (const auto& e : s.edges) {
    for (const auto& t : s.triangles) {
      if (std::find_first_of(e.begin(), e.end(), t.begin(), t.end()) != e.end()) continue;
      if (!of(of(s.meet, of(s.object, e[0])), of(s.object, t[0]))) continue;
      const auto rests = [&](int v) { return !of(s.moving, v); };
      if (std::all_of(e.begin(), e.end(), rests) && std::all_of(t.begin(), t.end(), rests)) continue;
      if (segment_meets_triangle(x.col(e[0]), x.col(e[1]), x.col(t[0]), x.col(t[1]), x.col(t[2]))) all.insert({e, t});
    }
  }
  return all;
}

TEST(ContactIntersections, AreThoseOfEachEdgeWithEachTriangle) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> noise(-1, 1);
  for (int trial = 0; trial < 6; ++trial) {
    Sheets sheets;
    sheets.add(5, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    sheets.add(5, {0.3, 0.2, 0.05 * trial}, {1, 0.1, 0}, {0, 0.9, 0.1}, trial != 3);
    sheets.add(5, {2.5, 0, -2}, {0, 1, 0}, {0, 0, 1}, trial != 3);
    if (trial == 4) sheets.surface.meet[0][1] = sheets.surface.meet[1][0] = 0;
    if (trial == 5) sheets.surface.meet[2][2] = 0;
    Matrix3Xd x = sheets.positions();
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      for (int k = 0; k < 3; ++k) x(k, i) += (trial % 2 == 0 ? 0.3 : 0.0) * noise(random);
    }
    const Found all = found(sheets.surface, x);
    EXPECT_EQ(all, each_with_each(sheets.surface, x)) << trial;
    EXPECT_FALSE(all.empty()) << trial;
  }
}

TEST(ContactIntersections, AnUndisturbedSheetHasNone) {
  Sheets sheets;
  sheets.add(20, {1e6, 0, 0}, {1, 0, 0}, {0, 1, 0});
  sheets.add(20, {1e6, 0, 1e-300}, {1, 0, 0}, {0, 1, 0});
  const Matrix3Xd x = sheets.positions();
  EXPECT_TRUE(find_intersections(sheets.surface, x).empty());
}

TEST(ContactIntersections, TouchingAndCoplanarCount) {
  Sheets sheets;
  sheets.add(1, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  sheets.add(1, {0.25, 0.5, 0}, {1, 0, 0}, {0, 0, 1});  // stands on it with one edge, in its plane
  const Matrix3Xd x = sheets.positions();
  const std::vector<Intersection> all = find_intersections(sheets.surface, x);
  EXPECT_TRUE(std::any_of(all.begin(), all.end(), [](const Intersection& i) {
    return i.edge == std::array<int, 2>{4, 6} && i.triangle == std::array<int, 3>{0, 2, 3};
  }));
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end(),
                             [](const Intersection& a, const Intersection& b) { return a.edge[0] < b.edge[0]; }));
  Matrix3Xd apart = x;
  for (Eigen::Index i = 4; i < 8; ++i) apart(2, i) += 1e-300;
  EXPECT_TRUE(find_intersections(sheets.surface, apart).empty());
}

TEST(ContactIntersections, WithoutEdgesOrTrianglesThereAreNone) {
  CollisionSurface points;
  points.points = {0};
  points.object = {0};
  points.moving = {1};
  points.radius = {0};
  points.meet = {{1}};
  EXPECT_TRUE(find_intersections(points, Matrix3Xd::Zero(3, 1)).empty());
}

}  // namespace
}  // namespace ergon
