#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unsupported/Eigen/BVH>

#include "runtime/mesh/closed_surface.h"
#include "runtime/predicates.h"

namespace ergon {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

// Whether it surely does: what rounding may have brought about is no crossing.
bool pierces(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Corners& t) {
  const int above = sure_orientation(t[0], t[1], t[2], from);
  if (above == 0 || sure_orientation(t[0], t[1], t[2], to) != -above) return false;
  const int turn = sure_orientation(from, to, t[0], t[1]);
  return turn != 0 && sure_orientation(from, to, t[1], t[2]) == turn && sure_orientation(from, to, t[2], t[0]) == turn;
}

// Whether `point` is surely on the inner side of the edge from `from` to `to`, in the plane of the axes u and v; `turn`
// is the sense of rotation of the edge's triangle there.
bool inner(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& point, int u, int v,
           int turn) {
  const double left = (to(u) - from(u)) * (point(v) - from(v)), right = (to(v) - from(v)) * (point(u) - from(u));
  const double bound = 16 * std::numeric_limits<double>::epsilon() * (std::abs(left) + std::abs(right));
  return turn * (left - right) > bound;
}

// Two triangles in one plane overlap when no edge of either separates them.
bool overlap_in_plane(const Corners& a, const Corners& b) {
  for (const Eigen::Vector3d& point : b) {
    if (sure_orientation(a[0], a[1], a[2], point) != 0) return false;
  }
  const Eigen::Vector3d normal = (a[1] - a[0]).cross(a[2] - a[0]);
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const auto separates = [&](const Corners& s, const Corners& t) {
    const int turn = (s[1] - s[0]).cross(s[2] - s[0])(axis) > 0 ? 1 : -1;
    for (size_t i = 0; i < 3; ++i) {
      const auto beyond = [&](const Eigen::Vector3d& point) { return !inner(s[i], s[(i + 1) % 3], point, u, v, turn); };
      if (std::all_of(t.begin(), t.end(), beyond)) return true;
    }
    return false;
  };
  return !separates(a, b) && !separates(b, a);
}

bool cut(const Corners& a, const Corners& b) {
  if (overlap_in_plane(a, b)) return true;
  for (size_t i = 0; i < 3; ++i) {
    if (pierces(a[i], a[(i + 1) % 3], b) || pierces(b[i], b[(i + 1) % 3], a)) return true;
  }
  return false;
}

// Looks at each pair of triangles whose boxes meet, for Eigen::BVIntersect.
struct PairSearch {
  const Eigen::Matrix3Xd& X;
  const std::vector<std::array<int, 3>>& triangles;
  const std::vector<Eigen::AlignedBox3d>& boxes;
  std::array<int, 2> found{-1, -1};

  Corners corners(int t) const {
    const auto& v = triangles[static_cast<size_t>(t)];
    return {X.col(v[0]), X.col(v[1]), X.col(v[2])};
  }
  bool intersectVolumeVolume(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) { return a.intersects(b); }
  bool intersectVolumeObject(const Eigen::AlignedBox3d& a, int b) {
    return a.intersects(boxes[static_cast<size_t>(b)]);
  }
  bool intersectObjectVolume(int a, const Eigen::AlignedBox3d& b) { return intersectVolumeObject(b, a); }
  // True ends the search. Each pair comes twice; one of them is looked at.
  bool intersectObjectObject(int a, int b) {
    if (a >= b || !boxes[static_cast<size_t>(a)].intersects(boxes[static_cast<size_t>(b)])) return false;
    const auto& va = triangles[static_cast<size_t>(a)];
    const auto& vb = triangles[static_cast<size_t>(b)];
    if (std::find_first_of(va.begin(), va.end(), vb.begin(), vb.end()) != va.end()) return false;
    if (!cut(corners(a), corners(b))) return false;
    found = {a, b};
    return true;
  }
};

}  // namespace

std::array<int, 2> crossing_triangles(const Eigen::Matrix3Xd& X, const std::vector<std::array<int, 3>>& triangles) {
  std::vector<int> numbers(triangles.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  std::vector<Eigen::AlignedBox3d> boxes(triangles.size());
  for (size_t t = 0; t < triangles.size(); ++t) {
    for (const int v : triangles[t]) boxes[t].extend(Eigen::Vector3d(X.col(v)));
  }
  const Eigen::KdBVH<double, 3, int> tree(numbers.begin(), numbers.end(), boxes.begin(), boxes.end());
  PairSearch search{X, triangles, boxes};
  Eigen::BVIntersect(tree, tree, search);
  return search.found;
}

}  // namespace ergon
