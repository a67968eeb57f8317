#include "runtime/contact/intersections.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "runtime/contact/pair_list.h"
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

std::vector<Intersection> find_intersections(const CollisionSurface& surface, const Eigen::Matrix3Xd& x) {
  std::vector<Intersection> found;
  if (surface.edges.empty() || surface.triangles.empty()) return found;
  const std::vector<IntegerBox> boxes = boxes_of(surface, x);
  BoxTree edges = tree_of(surface.edges, {}, surface), triangles = tree_of(surface.triangles, {}, surface);
  edges.fit(boxes);
  triangles.fit(boxes);
  PairList near(edges, triangles);
  for (int i = 0; i < static_cast<int>(surface.radius.size()); ++i) {
    for (int j = 0; j < static_cast<int>(surface.radius.size()); ++j) {
      if (surface.meet[static_cast<size_t>(i)][static_cast<size_t>(j)]) near.add(i, j, Shift{});
    }
  }
  std::vector<std::array<int, 2>> pairs, meeting;
  near.write(pairs);
  const auto count = static_cast<std::ptrdiff_t>(pairs.size());
#pragma omp parallel for schedule(dynamic, 256) if (count >= kSerial)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const auto& pair = pairs[static_cast<size_t>(i)];
    const auto& e = surface.edges[static_cast<size_t>(pair[0])];
    const auto& t = surface.triangles[static_cast<size_t>(pair[1])];
    if (std::find_first_of(e.begin(), e.end(), t.begin(), t.end()) != e.end()) continue;
    if (!segment_meets_triangle(x.col(e[0]), x.col(e[1]), x.col(t[0]), x.col(t[1]), x.col(t[2]))) continue;
#pragma omp critical
    meeting.push_back(pair);
  }
  std::sort(meeting.begin(), meeting.end());
  for (const auto& [edge, triangle] : meeting) {
    found.push_back({surface.edges[static_cast<size_t>(edge)], surface.triangles[static_cast<size_t>(triangle)]});
  }
  return found;
}

}  // namespace ergon
