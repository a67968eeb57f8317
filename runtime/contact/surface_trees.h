#pragma once
// Trees over the primitives of a surface. Its points are numbered in the order of surface.points: boxes that a tree is
// fitted to are in that order.

#include <array>
#include <utility>
#include <vector>

#include "runtime/contact/box_tree.h"
#include "runtime/contact/collision_surface.h"

namespace ergon {

// Per vertex of the system: its number; -1: it is no point.
inline std::vector<int> point_numbers(const CollisionSurface& surface) {
  std::vector<int> numbers(surface.object.size(), -1);
  for (size_t i = 0; i < surface.points.size(); ++i) {
    numbers[static_cast<size_t>(surface.points[i])] = static_cast<int>(i);
  }
  return numbers;
}

// Primitives of one kind; `kept` says which, or is empty for all.
template <size_t N>
BoxTree tree_of(const std::vector<std::array<int, N>>& primitives, const std::vector<char>& kept,
                const CollisionSurface& surface) {
  const std::vector<int> numbers = point_numbers(surface);
  std::vector<int> corners, ids, object;
  std::vector<char> moving;
  for (const int v : surface.points) {
    object.push_back(surface.object[static_cast<size_t>(v)]);
    moving.push_back(surface.moving[static_cast<size_t>(v)]);
  }
  for (size_t i = 0; i < primitives.size(); ++i) {
    if (!kept.empty() && !kept[i]) continue;
    for (const int v : primitives[i]) corners.push_back(numbers[static_cast<size_t>(v)]);
    ids.push_back(static_cast<int>(i));
  }
  return {static_cast<int>(N), corners, ids, object, moving, static_cast<int>(surface.radius.size())};
}

}  // namespace ergon
