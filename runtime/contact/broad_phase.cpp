#include "runtime/contact/broad_phase.h"

#include <omp.h>

#include <algorithm>

#include "runtime/contact/box_tree.h"
#include "runtime/contact/motion_boxes.h"
#include "runtime/lanes/lanes.h"

namespace ergon {

namespace {

static_assert(sizeof(lanes::IdPair) == sizeof(std::array<int, 2>));

// Primitives of one kind, in the numbers of MotionBoxes.
template <size_t N>
BoxTree tree_of(const std::vector<std::array<int, N>>& primitives, const std::vector<char>& kept,
                const CollisionSurface& surface, const MotionBoxes& motion) {
  std::vector<int> corners, ids, object;
  std::vector<char> moving;
  for (const int v : surface.points) {
    object.push_back(surface.object[static_cast<size_t>(v)]);
    moving.push_back(surface.moving[static_cast<size_t>(v)]);
  }
  for (size_t i = 0; i < primitives.size(); ++i) {
    if (!kept.empty() && !kept[i]) continue;
    for (const int v : primitives[i]) corners.push_back(motion.number_of(v));
    ids.push_back(static_cast<int>(i));
  }
  return {
      static_cast<int>(N), std::move(corners), std::move(ids), object, moving, static_cast<int>(surface.radius.size())};
}

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
  std::vector<std::array<int, 2>> sides;
  for (const auto& t : surface.triangles) {
    for (size_t i = 0; i < 3; ++i) sides.push_back({std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])});
  }
  std::sort(sides.begin(), sides.end());
  std::vector<char> rods;
  for (const auto& [a, b] : surface.edges) {
    rods.push_back(!std::binary_search(sides.begin(), sides.end(), std::array{std::min(a, b), std::max(a, b)}));
  }
  return rods;
}

}  // namespace

struct BroadPhase::Impl {
  // Pairs of leaves of two trees, and what is written for them.
  struct List {
    lanes::OverlapTask task{};
    std::vector<lanes::LeafPair> pairs;
    std::vector<std::array<int, 2>>* out = nullptr;
  };

  explicit Impl(const CollisionSurface& s)
      : surface(&s),
        motion(s),
        points(tree_of(points_of(s), {}, s, motion)),
        edges(tree_of(s.edges, {}, s, motion)),
        triangles(tree_of(s.triangles, {}, s, motion)),
        loose(tree_of(points_of(s), loose_points(s), s, motion)),
        rods(tree_of(s.edges, rod_edges(s), s, motion)) {}

  void make(const Eigen::Matrix3Xd& x0, const Eigen::Matrix3Xd& x1, double reach);
  void list_objects();
  void list(const BoxTree& a, int object_a, const BoxTree& b, int object_b, std::vector<lanes::LeafPair>& pairs);
  void write(const BoxTree& a, const BoxTree& b, std::vector<lanes::LeafPair>& pairs,
             std::vector<std::array<int, 2>>& out);
  bool may_meet(int a, int b) const { return surface->meet[static_cast<size_t>(a)][static_cast<size_t>(b)] != 0; }

  const CollisionSurface* surface;
  MotionBoxes motion;
  BoxTree points, edges, triangles, loose, rods;
  std::vector<lanes::LeafPair> point_triangle, edge_edge, point_edge, point_point;
  std::vector<std::vector<lanes::IdPair>> found;  // per thread
  Candidates candidates;
  double slack = 0;
};

void BroadPhase::Impl::list(const BoxTree& a, int object_a, const BoxTree& b, int object_b,
                            std::vector<lanes::LeafPair>& pairs) {
  const int none[3] = {0, 0, 0};
  const BoxTree::Node *na = a.root(object_a), *nb = b.root(object_b);
  if (na != nullptr && nb != nullptr) BoxTree::meet(na, nb, none, none, pairs);
}

void BroadPhase::Impl::list_objects() {
  for (auto* pairs : {&point_triangle, &edge_edge, &point_edge, &point_point}) pairs->clear();
  const int objects = static_cast<int>(surface->radius.size());
  for (int i = 0; i < objects; ++i) {
    for (int j = i; j < objects; ++j) {
      if (!may_meet(i, j)) continue;
      list(points, i, triangles, j, point_triangle);
      if (i != j) list(points, j, triangles, i, point_triangle);
      list(edges, i, edges, j, edge_edge);
      list(loose, i, rods, j, point_edge);
      if (i != j) list(loose, j, rods, i, point_edge);
      list(loose, i, loose, j, point_point);
    }
  }
}

void BroadPhase::Impl::write(const BoxTree& a, const BoxTree& b, std::vector<lanes::LeafPair>& pairs,
                             std::vector<std::array<int, 2>>& out) {
  const lanes::OverlapOperations& operations = lanes::overlap_operations(lanes::best_lanes());
  lanes::OverlapTask task{};
  task.a = a.leaves();
  task.b = b.leaves();
  task.corners_a = a.corners();
  task.corners_b = b.corners();
  task.same = &a == &b;
  const auto count = static_cast<long>(pairs.size());
  found.resize(static_cast<size_t>(omp_get_max_threads()));
  for (auto& each : found) each.clear();
#pragma omp parallel
  {
    const auto thread = static_cast<size_t>(omp_get_thread_num());
    const long threads = omp_get_num_threads();
    const long first = count * static_cast<long>(thread) / threads,
               last = count * static_cast<long>(thread + 1) / threads;
    std::vector<lanes::IdPair>& mine = found[thread];
    long done = first, size = 0;
    while (done < last) {
      if (static_cast<long>(mine.size()) < size + lanes::kMostOverlaps) {
        mine.resize(std::max(mine.capacity(), 2 * mine.size() + 16 * lanes::kMostOverlaps));
      }
      done += operations.overlaps(task, pairs.data() + done, last - done, mine.data() + size,
                                  static_cast<long>(mine.size()) - size, &size);
    }
    mine.resize(static_cast<size_t>(size));
  }
  out.clear();
  for (const auto& each : found) {
    for (const lanes::IdPair& pair : each) out.push_back({pair.a, pair.b});
  }
}

void BroadPhase::Impl::make(const Eigen::Matrix3Xd& x0, const Eigen::Matrix3Xd& x1, double reach) {
  slack = reach / 4;
  motion.make(x0, x1, reach, slack);
  for (BoxTree* tree : {&points, &edges, &triangles, &loose, &rods}) tree->fit(motion.boxes());
  list_objects();
  write(points, triangles, point_triangle, candidates.point_triangle);
  write(edges, edges, edge_edge, candidates.edge_edge);
  write(loose, rods, point_edge, candidates.point_edge);
  write(loose, loose, point_point, candidates.point_point);
}

BroadPhase::BroadPhase(const CollisionSurface& surface) : impl_(std::make_unique<Impl>(surface)) {}
BroadPhase::~BroadPhase() = default;

bool BroadPhase::cover(const Eigen::Matrix3Xd& x0, const Eigen::Matrix3Xd& x1, double reach) {
  if (impl_->motion.hold(x0, x1, reach)) return false;
  impl_->make(x0, x1, reach);
  return true;
}

const Candidates& BroadPhase::candidates() const { return impl_->candidates; }

}  // namespace ergon
