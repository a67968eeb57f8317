#pragma once
// The pairs of primitives that may meet, one by one, by the definition of CollisionSurface.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include "runtime/contact/collision_surface.h"
#include "runtime/contact/distance.h"

namespace ergon {

using Pairs = std::set<std::array<int, 2>>;

inline std::vector<int> corners(int v) { return {v}; }
template <size_t N>
std::vector<int> corners(const std::array<int, N>& primitive) {
  return {primitive.begin(), primitive.end()};
}

// Every pair that may meet, by its definition.
class PairOracle {
 public:
  explicit PairOracle(const CollisionSurface& surface) : surface_(surface) {}

  bool may_meet(const std::vector<int>& a, const std::vector<int>& b) const {
    const auto object = [&](int v) { return static_cast<size_t>(surface_.object[static_cast<size_t>(v)]); };
    if (!surface_.meet[object(a[0])][object(b[0])]) return false;
    bool moving = false;
    for (const auto& part : {a, b}) {
      for (const int v : part) moving = moving || surface_.moving[static_cast<size_t>(v)];
    }
    for (const int v : a) {
      if (std::count(b.begin(), b.end(), v) > 0) return false;
    }
    return moving;
  }
  bool loose(int v) const {
    return std::none_of(surface_.edges.begin(), surface_.edges.end(), [v](auto& e) { return e[0] == v || e[1] == v; });
  }
  bool rod(const std::array<int, 2>& edge) const {
    return std::none_of(surface_.triangles.begin(), surface_.triangles.end(), [&](auto& t) {
      return std::count(t.begin(), t.end(), edge[0]) + std::count(t.begin(), t.end(), edge[1]) == 2;
    });
  }

  // call(kind, i, j, corners of i, corners of j) for all pairs that may meet.
  template <class Call>
  void each(const Call& call) const {
    const auto& s = surface_;
    const int points = static_cast<int>(s.points.size()), edges = static_cast<int>(s.edges.size()),
              triangles = static_cast<int>(s.triangles.size());
    const auto offer = [&](int kind, int i, int j, const auto& a, const auto& b) {
      if (may_meet(corners(a), corners(b))) call(kind, i, j, corners(a), corners(b));
    };
    std::vector<char> is_loose, is_rod;
    for (const int v : s.points) is_loose.push_back(loose(v));
    for (const auto& e : s.edges) is_rod.push_back(rod(e));
    for (int i = 0; i < points; ++i) {
      const auto p = static_cast<size_t>(i);
      for (int j = 0; j < triangles; ++j) offer(0, i, j, s.points[p], s.triangles[static_cast<size_t>(j)]);
      for (int j = 0; j < edges && is_loose[p]; ++j) {
        if (is_rod[static_cast<size_t>(j)]) offer(2, i, j, s.points[p], s.edges[static_cast<size_t>(j)]);
      }
      for (int j = i + 1; j < points && is_loose[p]; ++j) {
        if (is_loose[static_cast<size_t>(j)]) offer(3, i, j, s.points[p], s.points[static_cast<size_t>(j)]);
      }
    }
    for (int i = 0; i < edges; ++i) {
      for (int j = i + 1; j < edges; ++j)
        offer(1, i, j, s.edges[static_cast<size_t>(i)], s.edges[static_cast<size_t>(j)]);
    }
  }

  double gap(int kind, const std::vector<int>& a, const std::vector<int>& b, const Eigen::Matrix3Xd& x) const {
    const auto at = [&](int v) -> Eigen::Vector3d { return x.col(v); };
    double gap2 = 0;
    if (kind == 0) gap2 = point_triangle_distance(at(a[0]), at(b[0]), at(b[1]), at(b[2])).gap2;
    if (kind == 1) gap2 = edge_edge_distance(at(a[0]), at(a[1]), at(b[0]), at(b[1])).gap2;
    if (kind == 2) gap2 = point_edge_distance(at(a[0]), at(b[0]), at(b[1])).gap2;
    if (kind == 3) gap2 = (x.col(a[0]) - x.col(b[0])).squaredNorm();
    return std::sqrt(gap2) -
           surface_.offset(surface_.object[static_cast<size_t>(a[0])], surface_.object[static_cast<size_t>(b[0])]);
  }

  // Pairs that come within reach on the way, seen at 9 times.
  std::array<Pairs, 4> near(const Eigen::Matrix3Xd& x0, const Eigen::Matrix3Xd& x1, double reach) const {
    std::array<Pairs, 4> found;
    const int times = x0 == x1 ? 1 : 9;
    for (int n = 0; n < times; ++n) {
      const Eigen::Matrix3Xd x = x0 + n / 8.0 * (x1 - x0);
      each([&](int kind, int i, int j, const std::vector<int>& a, const std::vector<int>& b) {
        if (gap(kind, a, b, x) < reach) found[static_cast<size_t>(kind)].insert({i, j});
      });
    }
    return found;
  }

  std::array<Pairs, 4> all() const {
    std::array<Pairs, 4> found;
    each([&](int kind, int i, int j, const auto&, const auto&) { found[static_cast<size_t>(kind)].insert({i, j}); });
    return found;
  }

 private:
  const CollisionSurface& surface_;
};

}  // namespace ergon
