#include "runtime/contact/intersections.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "runtime/contact/surface_trees.h"
#include "runtime/error.h"
#include "runtime/predicates.h"

namespace ergon {
namespace {

constexpr std::ptrdiff_t kSerial = 4096;  // pairs: fewer are not worth waking other threads

// Boxes of points, in the order of surface.points, in units that fit all into an int.
std::vector<IntegerBox> boxes_of(const CollisionSurface& surface, const Eigen::Matrix3Xd& x) {
  constexpr double kUnits = 1 << 29;  // along the longest side
  Eigen::AlignedBox3d all;
  for (const int v : surface.points) {
    if (!x.col(v).allFinite()) throw InputError(fmt::format("vertex {} has no finite position", v));
    all.extend(Eigen::Vector3d(x.col(v)));
  }
  const double side = all.sizes().maxCoeff(), scale = side > 0 ? kUnits / side : 0;
  std::vector<IntegerBox> boxes;
  for (const int v : surface.points) {
    IntegerBox box{};
    for (int k = 0; k < 3; ++k) {
      const int unit = static_cast<int>((x(k, v) - all.min()(k)) * scale);  // never reverses an order
      box.lower[static_cast<size_t>(k)] = box.upper[static_cast<size_t>(k)] = unit;
    }
    boxes.push_back(box);
  }
  return boxes;
}

}  // namespace

IntersectionFinder::IntersectionFinder(const CollisionSurface& surface)
    : surface_(&surface),
      edges_(tree_of(surface.edges, {}, surface)),
      triangles_(tree_of(surface.triangles, {}, surface)),
      near_(edges_, triangles_) {}

std::vector<Intersection> IntersectionFinder::find(const Eigen::Matrix3Xd& x) {
  std::vector<Intersection> found;
  const CollisionSurface& surface = *surface_;
  if (surface.edges.empty() || surface.triangles.empty()) return found;
  const std::vector<IntegerBox> boxes = boxes_of(surface, x);
  edges_.fit(boxes);
  triangles_.fit(boxes);
  near_.clear();
  for (int i = 0; i < static_cast<int>(surface.radius.size()); ++i) {
    for (int j = 0; j < static_cast<int>(surface.radius.size()); ++j) {
      if (surface.meet[static_cast<size_t>(i)][static_cast<size_t>(j)]) near_.add(i, j, Shift{});
    }
  }
  near_.write(pairs_);
  meeting_.clear();
  const auto count = static_cast<std::ptrdiff_t>(pairs_.size());
#pragma omp parallel for schedule(dynamic, 256) if (count >= kSerial)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const auto& pair = pairs_[static_cast<size_t>(i)];
    const auto& e = surface.edges[static_cast<size_t>(pair[0])];
    const auto& t = surface.triangles[static_cast<size_t>(pair[1])];
    if (std::find_first_of(e.begin(), e.end(), t.begin(), t.end()) != e.end()) continue;
    if (!segment_meets_triangle(x.col(e[0]), x.col(e[1]), x.col(t[0]), x.col(t[1]), x.col(t[2]))) continue;
#pragma omp critical
    meeting_.push_back(pair);
  }
  std::sort(meeting_.begin(), meeting_.end());
  for (const auto& [edge, triangle] : meeting_) {
    found.push_back({surface.edges[static_cast<size_t>(edge)], surface.triangles[static_cast<size_t>(triangle)]});
  }
  return found;
}

std::vector<Intersection> find_intersections(const CollisionSurface& surface, const Eigen::Matrix3Xd& x) {
  return IntersectionFinder(surface).find(x);
}

}  // namespace ergon
