#include "runtime/contact/object_pairs.h"

#include <algorithm>

namespace ergon {

namespace {

bool meet(const BoxTree::Node& a, const BoxTree::Node& b, const Shift& shift) {
  for (size_t k = 0; k < 3; ++k) {
    if (a.lower[k] > b.upper[k] + shift.upper[k] || b.lower[k] + shift.lower[k] > a.upper[k]) return false;
  }
  return true;
}

}  // namespace

// Sweep and prune along the first axis.
void find_object_pairs(const CollisionSurface& surface, const MotionBoxes& motion, const BoxTree& points,
                       std::vector<std::array<int, 2>>& pairs) {
  pairs.clear();
  const int objects = static_cast<int>(surface.radius.size());
  const auto begin = [&](int o) { return points.root(o)->lower[0] + motion.drift(o).lower[0]; };
  // First each object with itself: their order is that of the sweep until all pairs are sorted.
  for (int o = 0; o < objects; ++o) {
    if (points.root(o) != nullptr) pairs.push_back({o, o});
  }
  std::sort(pairs.begin(), pairs.end(), [&](const auto& a, const auto& b) {
    return begin(a[0]) != begin(b[0]) ? begin(a[0]) < begin(b[0]) : a[0] < b[0];
  });
  const size_t count = pairs.size();
  for (size_t n = 0; n < count; ++n) {
    const int a = pairs[n][0];
    const BoxTree::Node& root = *points.root(a);
    const int end = root.upper[0] + motion.drift(a).upper[0];
    for (size_t m = n + 1; m < count && begin(pairs[m][0]) <= end; ++m) {
      const int b = pairs[m][0];
      if (!surface.meet[static_cast<size_t>(a)][static_cast<size_t>(b)]) continue;
      const BoxTree::Node& other = *points.root(b);
      if (!root.moving && !other.moving) continue;
      if (meet(root, other, motion.shift(a, b))) pairs.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  pairs.erase(std::remove_if(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(count),
                             [&](const auto& pair) {
                               const auto o = static_cast<size_t>(pair[0]);
                               return !surface.meet[o][o] || !points.root(pair[0])->moving;
                             }),
              pairs.begin() + static_cast<std::ptrdiff_t>(count));
  std::sort(pairs.begin(), pairs.end());
}

}  // namespace ergon
