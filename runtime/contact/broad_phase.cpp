#include "runtime/contact/broad_phase.h"

#include <algorithm>
#include <numeric>

#include "runtime/contact/motion_boxes.h"
#include "runtime/contact/near_pairs.h"
#include "runtime/contact/object_pairs.h"
#include "runtime/contact/slack.h"
#include "runtime/contact/surface_trees.h"

namespace ergon {

namespace {

std::vector<std::array<int, 1>> points_of(const CollisionSurface& surface) {
  std::vector<std::array<int, 1>> points;
  for (const int v : surface.points) points.push_back({v});
  return points;
}

// Points that end no edge.
std::vector<char> loose_points(const CollisionSurface& surface) {
  std::vector<char> ends(surface.object.size(), 0), loose;
  for (const auto& edge : surface.edges) {
    for (const int v : edge) ends[static_cast<size_t>(v)] = 1;
  }
  for (const int v : surface.points) loose.push_back(!ends[static_cast<size_t>(v)]);
  return loose;
}

// Edges of no triangle.
std::vector<char> rod_edges(const CollisionSurface& surface) {
  // Sides by their lower end.
  std::vector<size_t> starts(surface.object.size() + 2, 0);
  const auto each_side = [&](const auto& call) {
    for (const auto& t : surface.triangles) {
      for (size_t i = 0; i < 3; ++i)
        call(static_cast<size_t>(std::min(t[i], t[(i + 1) % 3])), std::max(t[i], t[(i + 1) % 3]));
    }
  };
  each_side([&](size_t low, int) { ++starts[low + 2]; });
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<int> others(starts.back());
  each_side([&](size_t low, int high) { others[starts[low + 1]++] = high; });
  std::vector<char> rods;
  rods.reserve(surface.edges.size());
  for (const auto& [a, b] : surface.edges) {
    const auto low = static_cast<size_t>(std::min(a, b));
    const auto first = others.begin() + static_cast<std::ptrdiff_t>(starts[low]),
               last = others.begin() + static_cast<std::ptrdiff_t>(starts[low + 1]);
    rods.push_back(std::find(first, last, std::max(a, b)) == last);
  }
  return rods;
}

}  // namespace

struct BroadPhase::Impl {
  explicit Impl(const CollisionSurface& s)
      : surface(&s),
        motion(s),
        points(tree_of(points_of(s), {}, s)),
        edges(tree_of(s.edges, {}, s)),
        triangles(tree_of(s.triangles, {}, s)),
        loose(tree_of(points_of(s), loose_points(s), s)),
        rods(tree_of(s.edges, rod_edges(s), s)) {}

  void make(const Eigen::Matrix3Xd& x0, const Eigen::Matrix3Xd& x1, double excess);

  const CollisionSurface* surface;
  MotionBoxes motion;
  BoxTree points, edges, triangles, loose, rods;
  NearPairs near{*surface};
  PairList point_triangle{points, triangles, [this](auto* pairs, long n, double drift) {
                            return near.keep_point_triangle(pairs, n, drift);
                          }};
  PairList edge_edge{edges, edges,
                     [this](auto* pairs, long n, double drift) { return near.keep_edge_edge(pairs, n, drift); }};
  PairList point_edge{loose, rods}, point_point{loose, loose};
  std::vector<std::array<int, 2>> objects;
  Slack slack;
  Candidates candidates;
};

void BroadPhase::Impl::make(const Eigen::Matrix3Xd& x0, const Eigen::Matrix3Xd& x1, double excess) {
  motion.make(x0, x1, excess, slack);
  near.prepare(motion, x0);
  for (BoxTree* tree : {&points, &edges, &triangles, &loose, &rods}) tree->fit(motion.boxes());
  for (PairList* list : {&point_triangle, &edge_edge, &point_edge, &point_point}) list->clear();
  find_object_pairs(*surface, motion, points, objects);
  for (const auto& [a, b] : objects) {
    const Shift shift = motion.shift(a, b), back = motion.shift(b, a);
    point_triangle.add(a, b, shift);
    if (a != b) point_triangle.add(b, a, back);
    edge_edge.add(a, b, shift);
    point_edge.add(a, b, shift);
    if (a != b) point_edge.add(b, a, back);
    point_point.add(a, b, shift);
  }
  point_triangle.write(candidates.point_triangle);
  edge_edge.write(candidates.edge_edge);
  point_edge.write(candidates.point_edge);
  point_point.write(candidates.point_point);
}

BroadPhase::BroadPhase(const CollisionSurface& surface) : impl_(std::make_unique<Impl>(surface)) {}
BroadPhase::~BroadPhase() = default;

bool BroadPhase::cover(const Eigen::Matrix3Xd& x0, const Eigen::Matrix3Xd& x1, double reach) {
  impl_->slack.ask(reach);
  const double excess = impl_->motion.excess(x0, x1, reach);
  if (excess <= 0) return false;
  impl_->make(x0, x1, excess);
  return true;
}

const Candidates& BroadPhase::candidates() const { return impl_->candidates; }

}  // namespace ergon
