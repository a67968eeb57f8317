#include "runtime/contact/active_set.h"

#include <omp.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "runtime/contact/distance.h"
#include "runtime/lanes/distances.h"
#include "runtime/lanes/lanes.h"

namespace ergon {

namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr size_t kSerial = 4096;  // pairs: fewer are not worth waking other threads

enum Case : size_t { kPointPoint, kPointEdge, kPointTriangle, kEdgeEdge, kParallelPointEdge, kParallelPointPoint };

template <size_t N>
const int (*plain(const std::array<int, N>* items))[N] {
  return reinterpret_cast<const int(*)[N]>(items);
}

std::uint64_t pair_key(int a, int b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint64_t>(std::max(a, b));
}
std::uint64_t key_of(int a) { return static_cast<std::uint64_t>(a); }

// The pairs that one thread looks at.
class Finder {
 public:
  Finder(const CollisionSurface& surface, const Matrix3Xd& x, const Matrix3Xd& X, double dhat, FoundStencils& found,
         LoweredStencils& lowered)
      : surface_(surface), x_(x), X_(X), dhat_(dhat), found_(found), lowered_(lowered) {}

  // Up to kDistances pairs.
  void point_triangles(const std::array<int, 2>* pairs, int count) {
    operations_.point_triangle(x_.data(), surface_.points.data(), plain(surface_.triangles.data()), plain(pairs), count,
                               room_);
    for (int i = 0; i < count; ++i) {
      const auto [point, triangle] = pairs[i];
      const int p = surface_.points[static_cast<size_t>(point)];
      const auto& t = surface_.triangles[static_cast<size_t>(triangle)];
      double gap2 = room_.gap2[i];
      auto part = static_cast<unsigned>(room_.part[i]);
      if (!(gap2 >= 0)) {
        const PointTriangleDistance d = point_triangle_distance(at(p), at(t[0]), at(t[1]), at(t[2]));
        gap2 = d.gap2, part = d.part;
      }
      if (near(RestOffsets::point_triangle, pairs[i], gap2, p, t[0])) {
        weight_ = weight_of_point(point);
        add_point_triangle(point, triangle, part);
      }
    }
  }

  void edge_edges(const std::array<int, 2>* pairs, int count) {
    operations_.edge_edge(x_.data(), plain(surface_.edges.data()), plain(pairs), count, room_);
    for (int i = 0; i < count; ++i) {
      const auto &a = surface_.edges[static_cast<size_t>(pairs[i][0])],
                 &b = surface_.edges[static_cast<size_t>(pairs[i][1])];
      double gap2 = room_.gap2[i];
      auto parts = static_cast<unsigned>(room_.part[i]);
      if (!(gap2 >= 0)) {
        const EdgeEdgeDistance d = edge_edge_distance(at(a[0]), at(a[1]), at(b[0]), at(b[1]));
        gap2 = d.gap2, parts = d.part_a | d.part_b << 2;
      }
      if (near(RestOffsets::edge_edge, pairs[i], gap2, a[0], b[0])) {
        weight_ = (weight_of_edge(pairs[i][0]) + weight_of_edge(pairs[i][1])) / 2;
        add_edge_edge(pairs[i][0], pairs[i][1], parts & 3u, parts >> 2, room_.sine2[i]);
      }
    }
  }

  void point_edges(const std::array<int, 2>* pairs, int count) {
    for (int i = 0; i < count; ++i) point_edge(pairs[i]);
  }
  void point_points(const std::array<int, 2>* pairs, int count) {
    for (int i = 0; i < count; ++i) point_point(pairs[i]);
  }

  double smallest_gap() const { return smallest_; }

 private:
  void point_edge(const std::array<int, 2>& pair) {
    const int p = surface_.points[static_cast<size_t>(pair[0])];
    const auto& e = surface_.edges[static_cast<size_t>(pair[1])];
    const PointEdgeDistance d = point_edge_distance(at(p), at(e[0]), at(e[1]));
    if (!near(RestOffsets::point_edge, pair, d.gap2, p, e[0])) return;
    weight_ = weight_of_point(pair[0]);
    if (d.part == 3) return add_point_edge(p, e[0], e[1]);
    add_point_point(p, e[d.part - 1]);
  }

  void point_point(const std::array<int, 2>& pair) {
    const int p = surface_.points[static_cast<size_t>(pair[0])], q = surface_.points[static_cast<size_t>(pair[1])];
    if (!near(RestOffsets::point_point, pair, (x_.col(p) - x_.col(q)).squaredNorm(), p, q)) return;
    weight_ = (weight_of_point(pair[0]) + weight_of_point(pair[1])) / 2;
    add_point_point(p, q);
  }

  float weight_of_point(int point) const {
    return surface_.point_weight.empty() ? 1 : static_cast<float>(surface_.point_weight[static_cast<size_t>(point)]);
  }
  float weight_of_edge(int edge) const {
    return surface_.edge_weight.empty() ? 1 : static_cast<float>(surface_.edge_weight[static_cast<size_t>(edge)]);
  }

  Vector3d at(int vertex) const { return x_.col(vertex); }

  bool near(RestOffsets::Kind kind, const std::array<int, 2>& pair, double gap2, int p, int q) {
    const int object_p = object_of(p), object_q = object_of(q);
    number_ = object_p == object_q && !surface_.rest_offsets.empty() ? surface_.rest_offsets.number(kind, pair) : 0;
    const double offset = number_ > 0 ? surface_.rest_offsets.lowered(number_) : surface_.offset(object_p, object_q);
    const double limit = dhat_ + offset, smallest = smallest_ + offset;
    if (smallest >= 0 && gap2 < smallest * smallest) smallest_ = std::sqrt(gap2) - offset;
    return gap2 < limit * limit;
  }

  int object_of(int vertex) const { return surface_.object[static_cast<size_t>(vertex)]; }

  double rest_length2(const std::array<int, 2>& edge) const {
    return (X_.col(edge[1]) - X_.col(edge[0])).squaredNorm();
  }

  void add(Case which, int bin, std::uint64_t key) {
    if (number_ > 0)
      lowered_[which].push_back({bin, number_, key, weight_});
    else
      found_[which].push_back({bin, weight_, key});
  }

  void add_point_triangle(int point, int triangle, unsigned part) {
    const int p = surface_.points[static_cast<size_t>(point)];
    const auto& t = surface_.triangles[static_cast<size_t>(triangle)];
    switch (part) {
      case 7:
        return add(kPointTriangle, point, key_of(triangle));
      case 3:
      case 5:
      case 6:
        return add_point_edge(p, t[part == 6 ? 1 : 0], t[part == 3 ? 1 : 2]);
      default:
        return add_point_point(p, t[part / 2]);
    }
  }

  // sine2: |cross(a, b)|^2, m^4.
  void add_edge_edge(int edge_a, int edge_b, unsigned part_a, unsigned part_b, double sine2) {
    if (part_a == 3 && part_b == 3) return add(kEdgeEdge, edge_a, key_of(edge_b));
    const auto &a = surface_.edges[static_cast<size_t>(edge_a)], &b = surface_.edges[static_cast<size_t>(edge_b)];
    const size_t end_a = part_a - 1, end_b = part_b - 1;
    if (sine2 < kMollified * rest_length2(a) * rest_length2(b)) {
      const std::uint64_t key = key_of(edge_b) << 2;
      if (part_a != 3 && part_b != 3) return add(kParallelPointPoint, edge_a, key | end_a << 1 | end_b);
      return add(kParallelPointEdge, edge_a, key | (part_a != 3 ? end_a : 2 | end_b));
    }
    if (part_a == 3) return add_point_edge(b[end_b], a[0], a[1]);
    if (part_b == 3) return add_point_edge(a[end_a], b[0], b[1]);
    add_point_point(a[end_a], b[end_b]);
  }

  void add_point_edge(int p, int e0, int e1) { add(kPointEdge, p, pair_key(e0, e1)); }
  void add_point_point(int p, int q) { add(kPointPoint, std::min(p, q), key_of(std::max(p, q))); }

  const CollisionSurface& surface_;
  const Matrix3Xd &x_, &X_;
  double dhat_;
  FoundStencils& found_;
  LoweredStencils& lowered_;
  std::uint32_t number_ = 0;  // of the lowered offset of the present pair, or 0
  const lanes::DistanceOperations& operations_ = lanes::distance_operations(lanes::best_lanes());
  lanes::DistanceRoom room_;
  float weight_ = 1;  // of the pair looked at
  double smallest_ = std::numeric_limits<double>::infinity();
};

// One list from what the threads have found; vertices(bin, key) are those of a stencil.
template <class Vertices>
void fill(const CollisionSurface& surface, Case which, size_t bins, const Vertices& vertices, ActiveSet& active,
          ActiveList& list) {
  list.vertices.clear();
  list.multiplicity.clear();
  list.offset.clear();
  const auto add = [&](const auto& stencil, double weight, double offset) {
    list.vertices.insert(list.vertices.end(), stencil.begin(), stencil.end());
    list.multiplicity.push_back(weight);
    list.offset.push_back(offset);
  };
  merge_stencils(active.found, which, bins, active.room, [&](int bin, std::uint64_t key, double weight) {
    const auto stencil = vertices(static_cast<size_t>(bin), key);
    add(stencil, weight,
        surface.offset(surface.object[static_cast<size_t>(stencil.front())],
                       surface.object[static_cast<size_t>(stencil.back())]));
  });
  merge_lowered(active.lowered, which, active.lowered_room,
                [&](int bin, std::uint64_t key, double weight, std::uint32_t number) {
                  add(vertices(static_cast<size_t>(bin), key), weight, surface.rest_offsets.lowered(number));
                });
}

void fill_lists(const CollisionSurface& surface, ActiveSet& active) {
  const size_t vertices = surface.object.size(), edges = surface.edges.size();
  const auto low = [](std::uint64_t key) { return static_cast<int>(key & 0xffffffffu); };
  fill(
      surface, kPointPoint, vertices,
      [&](size_t p, std::uint64_t key) {
        return std::array{static_cast<int>(p), low(key)};
      },
      active, active.point_point);
  fill(
      surface, kPointEdge, vertices,
      [&](size_t p, std::uint64_t key) {
        return std::array{static_cast<int>(p), static_cast<int>(key >> 32), low(key)};
      },
      active, active.point_edge);
  fill(
      surface, kPointTriangle, surface.points.size(),
      [&](size_t point, std::uint64_t key) {
        const auto& t = surface.triangles[key];
        return std::array{surface.points[point], t[0], t[1], t[2]};
      },
      active, active.point_triangle);
  const auto edge_edge = [&](size_t a, std::uint64_t b, bool turn_a, bool turn_b) {
    const auto &ea = surface.edges[a], &eb = surface.edges[b];
    return std::array{ea[turn_a], ea[!turn_a], eb[turn_b], eb[!turn_b]};
  };
  fill(
      surface, kEdgeEdge, edges, [&](size_t a, std::uint64_t b) { return edge_edge(a, b, false, false); }, active,
      active.edge_edge);
  fill(
      surface, kParallelPointEdge, edges,
      [&](size_t a, std::uint64_t key) {
        const bool of_b = (key & 2) != 0, second = (key & 1) != 0;
        return of_b ? edge_edge(key >> 2, a, second, false) : edge_edge(a, key >> 2, second, false);
      },
      active, active.parallel_point_edge);
  fill(
      surface, kParallelPointPoint, edges,
      [&](size_t a, std::uint64_t key) { return edge_edge(a, key >> 2, (key & 2) != 0, (key & 1) != 0); }, active,
      active.parallel_point_point);
}

}  // namespace

void find_active(const CollisionSurface& surface, const Candidates& candidates, const Matrix3Xd& x, const Matrix3Xd& X,
                 double dhat, ActiveSet& active) {
  active.found.resize(std::max(active.found.size(), static_cast<size_t>(omp_get_max_threads())));
  active.lowered.resize(active.found.size());
  for (LoweredStencils& lowered : active.lowered) {
    for (auto& each : lowered) each.clear();
  }
  for (FoundStencils& found : active.found) {
    for (auto& each : found) each.clear();
  }
  double smallest = std::numeric_limits<double>::infinity();
  const size_t all = candidates.point_triangle.size() + candidates.edge_edge.size() + candidates.point_edge.size() +
                     candidates.point_point.size();
#pragma omp parallel reduction(min : smallest) if (all > kSerial)
  {
    const auto thread = static_cast<size_t>(omp_get_thread_num()), threads = static_cast<size_t>(omp_get_num_threads());
    Finder finder(surface, x, X, dhat, active.found[thread], active.lowered[thread]);
    const auto each = [&](const std::vector<std::array<int, 2>>& pairs, const auto& call) {
      const size_t last = pairs.size() * (thread + 1) / threads;
      for (size_t i = pairs.size() * thread / threads; i < last; i += lanes::kDistances) {
        call(pairs.data() + i, static_cast<int>(std::min<size_t>(lanes::kDistances, last - i)));
      }
    };
    each(candidates.point_triangle, [&](const auto* pairs, int n) { finder.point_triangles(pairs, n); });
    each(candidates.edge_edge, [&](const auto* pairs, int n) { finder.edge_edges(pairs, n); });
    each(candidates.point_edge, [&](const auto* pairs, int n) { finder.point_edges(pairs, n); });
    each(candidates.point_point, [&](const auto* pairs, int n) { finder.point_points(pairs, n); });
    smallest = finder.smallest_gap();
  }
  active.smallest_gap = smallest;
  fill_lists(surface, active);
}

}  // namespace ergon
