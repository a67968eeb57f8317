#include "runtime/contact/box_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace ergon {

namespace {

using lanes::BoxLeaf;
using lanes::kLeaf;

constexpr int kHighest = std::numeric_limits<int>::max(), kLowest = std::numeric_limits<int>::min();
constexpr std::ptrdiff_t kSerial = 256;  // leaves: fewer are not worth waking other threads
constexpr double kDecayed = 1.5;         // growth of leaves against their primitives at which a tree is built anew

template <class Box>
void include(Box& box, const std::array<int, 3>& lower, const std::array<int, 3>& upper) {
  for (size_t k = 0; k < 3; ++k) {
    box.lower[k] = std::min(box.lower[k], lower[k]);
    box.upper[k] = std::max(box.upper[k], upper[k]);
  }
}

double extent(const std::array<int, 3>& lower, const std::array<int, 3>& upper) {
  double sum = 0;
  for (size_t k = 0; k < 3; ++k) sum += static_cast<double>(upper[k]) - lower[k];
  return sum;
}

const IntegerBox kEmpty{{kHighest, kHighest, kHighest}, {kLowest, kLowest, kLowest}};

}  // namespace

BoxTree::BoxTree(int corners, const std::vector<int>& primitives, const std::vector<int>& ids,
                 const std::vector<int>& object, const std::vector<char>& moving, int objects)
    : corners_(corners) {
  const auto size = static_cast<size_t>(corners);
  const auto object_of = [&](size_t i) {
    return static_cast<size_t>(object[static_cast<size_t>(primitives[size * i])]);
  };
  starts_.assign(static_cast<size_t>(objects) + 1, 0);
  for (size_t i = 0; i < ids.size(); ++i) ++starts_[object_of(i) + 1];
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  primitives_.resize(primitives.size());
  ids_.resize(ids.size());
  moving_.resize(ids.size());
  std::vector<int> next(starts_.begin(), starts_.end() - 1);
  for (size_t i = 0; i < ids.size(); ++i) {
    const auto to = static_cast<size_t>(next[object_of(i)]++);
    ids_[to] = ids[i];
    char moves = 0;
    for (size_t k = 0; k < size; ++k) {
      const int v = primitives[size * i + k];
      primitives_[size * to + k] = v;
      moves |= moving[static_cast<size_t>(v)];
    }
    moving_[to] = moves;
  }
  roots_.assign(static_cast<size_t>(objects), -1);
}

void BoxTree::fit(const std::vector<IntegerBox>& boxes) {
  if (ids_.empty()) return;
  if (builds_ > 0 && refit(boxes) <= kDecayed * ratio_) return;
  build(boxes);
  ratio_ = refit(boxes);
  ++builds_;
}

const BoxTree::Node* BoxTree::root(int object) const {
  const int at = roots_[static_cast<size_t>(object)];
  return at < 0 ? nullptr : &nodes_[static_cast<size_t>(at)];
}

void BoxTree::build(const std::vector<IntegerBox>& boxes) {
  const auto size = static_cast<size_t>(corners_);
  items_.resize(ids_.size());
  for (size_t i = 0; i < items_.size(); ++i) {
    IntegerBox box = kEmpty;
    for (size_t k = 0; k < size; ++k) {
      const IntegerBox& corner = boxes[static_cast<size_t>(primitives_[size * i + k])];
      include(box, corner.lower, corner.upper);
    }
    items_[i].primitive = static_cast<int>(i);
    for (size_t k = 0; k < 3; ++k) items_[i].centre[k] = box.lower[k] + (box.upper[k] - box.lower[k]) / 2;
  }
  nodes_.clear();
  leaves_.clear();
  for (size_t o = 0; o + 1 < starts_.size(); ++o) {
    if (starts_[o] == starts_[o + 1]) continue;
    roots_[o] = static_cast<int>(nodes_.size());
    split(items_.data() + starts_[o], items_.data() + starts_[o + 1]);
  }
  leaf_extents_.resize(leaves_.size());
  primitive_extents_.resize(leaves_.size());
}

void BoxTree::split(Item* first, Item* last) {
  const std::ptrdiff_t count = last - first;
  const size_t at = nodes_.size();
  nodes_.push_back({kEmpty.lower, kEmpty.upper, 0, false});
  if (count <= kLeaf) {
    nodes_[at].next = -1 - static_cast<int>(leaves_.size());
    BoxLeaf leaf{};
    leaf.count = static_cast<int>(count);
    for (int i = 0; i < kLeaf; ++i) {
      for (int k = 0; k < 3; ++k) leaf.lower[k][i] = kHighest, leaf.upper[k][i] = kLowest, leaf.vertex[k][i] = -1;
      if (i >= leaf.count) continue;
      const auto primitive = static_cast<size_t>(first[i].primitive);
      leaf.id[i] = ids_[primitive];
      leaf.moving |= static_cast<unsigned>(moving_[primitive] != 0) << i;
      for (int k = 0; k < corners_; ++k) {
        leaf.vertex[k][i] = primitives_[primitive * static_cast<size_t>(corners_) + static_cast<size_t>(k)];
      }
    }
    nodes_[at].moving = leaf.moving != 0;
    leaves_.push_back(leaf);
    return;
  }
  IntegerBox centres = kEmpty;
  for (const Item* item = first; item != last; ++item) include(centres, item->centre, item->centre);
  size_t axis = 0;
  for (size_t k = 1; k < 3; ++k) {
    if (centres.upper[k] - centres.lower[k] > centres.upper[axis] - centres.lower[axis]) axis = k;
  }
  const std::ptrdiff_t leaves = (count + kLeaf - 1) / kLeaf;
  Item* const middle = first + (leaves + 1) / 2 * kLeaf;
  std::nth_element(first, middle, last, [axis](const Item& a, const Item& b) {
    return a.centre[axis] != b.centre[axis] ? a.centre[axis] < b.centre[axis] : a.primitive < b.primitive;
  });
  split(first, middle);
  const size_t second = nodes_.size();
  nodes_[at].next = static_cast<int>(second - at);
  split(middle, last);
  nodes_[at].moving = nodes_[at + 1].moving || nodes_[second].moving;
}

double BoxTree::refit(const std::vector<IntegerBox>& boxes) {
  const auto leaves = static_cast<std::ptrdiff_t>(leaves_.size());
#pragma omp parallel for schedule(static) if (leaves > kSerial)
  for (std::ptrdiff_t n = 0; n < leaves; ++n) {
    BoxLeaf& leaf = leaves_[static_cast<size_t>(n)];
    IntegerBox all = kEmpty;
    double sum = 0;
    for (int i = 0; i < leaf.count; ++i) {
      IntegerBox box = boxes[static_cast<size_t>(leaf.vertex[0][i])];
      for (int k = 1; k < corners_; ++k) {
        const IntegerBox& corner = boxes[static_cast<size_t>(leaf.vertex[k][i])];
        include(box, corner.lower, corner.upper);
      }
      for (size_t k = 0; k < 3; ++k) leaf.lower[k][i] = box.lower[k], leaf.upper[k][i] = box.upper[k];
      include(all, box.lower, box.upper);
      sum += extent(box.lower, box.upper);
    }
    for (size_t k = 0; k < 3; ++k) leaf.lowest[k] = all.lower[k], leaf.highest[k] = all.upper[k];
    leaf_extents_[static_cast<size_t>(n)] = leaf.count * extent(all.lower, all.upper);
    primitive_extents_[static_cast<size_t>(n)] = sum;
  }
  for (size_t n = nodes_.size(); n-- > 0;) {
    Node& node = nodes_[n];
    if (node.next < 0) {
      const BoxLeaf& leaf = leaves_[static_cast<size_t>(-1 - node.next)];
      std::copy(leaf.lowest, leaf.lowest + 3, node.lower.begin());
      std::copy(leaf.highest, leaf.highest + 3, node.upper.begin());
      continue;
    }
    const Node& second = nodes_[n + static_cast<size_t>(node.next)];
    node.lower = nodes_[n + 1].lower;
    node.upper = nodes_[n + 1].upper;
    include(node, second.lower, second.upper);
  }
  const double of_leaves = std::accumulate(leaf_extents_.begin(), leaf_extents_.end(), 0.0);
  return of_leaves / (1 + std::accumulate(primitive_extents_.begin(), primitive_extents_.end(), 0.0));
}

void BoxTree::meet(const Node* root_a, const Node* root_b, const int* shift_lower, const int* shift_upper,
                   std::vector<lanes::LeafPair>& pairs) {
  const auto overlap = [&](const Node& a, const Node& b) {
    if (!a.moving && !b.moving) return false;
    int apart = 0;
    for (size_t k = 0; k < 3; ++k) {
      apart |= static_cast<int>(a.lower[k] > b.upper[k] + shift_upper[k]) |
               static_cast<int>(b.lower[k] + shift_lower[k] > a.upper[k]);
    }
    return apart == 0;
  };
  const auto visit = [&](const auto& self, const Node* a, const Node* b) -> void {
    if (a == b) {
      if (!a->moving) return;
      if (a->next < 0) return pairs.push_back({-1 - a->next, -1 - a->next});
      self(self, a + 1, a + 1);
      self(self, a + 1, a + a->next);
      self(self, a + a->next, a + a->next);
      return;
    }
    if (!overlap(*a, *b)) return;
    if (a->next < 0 && b->next < 0) return pairs.push_back({-1 - a->next, -1 - b->next});
    if (b->next < 0 || (a->next >= 0 && extent(a->lower, a->upper) >= extent(b->lower, b->upper))) {
      self(self, a + 1, b);
      self(self, a + a->next, b);
    } else {
      self(self, a, b + 1);
      self(self, a, b + b->next);
    }
  };
  visit(visit, root_a, root_b);
}

}  // namespace ergon
