#pragma once
// Trees of boxes over the primitives of one kind, one tree for each object: binary, with sixteen neighbours in space to
// a leaf, split at the median of the longest axis. It establishes, after build or refit, that each node's box holds
// those of its primitives. Source of the refitted tree: van den Bergen 1997, Efficient Collision Detection of Complex
// Deformable Models using AABB Trees, Journal of Graphics Tools 2(4).

#include <array>
#include <vector>

#include "runtime/aligned.h"
#include "runtime/lanes/overlaps.h"

namespace ergon {

// Closed, in whole units.
struct IntegerBox {
  std::array<int, 3> lower, upper;
};

class BoxTree {
 public:
  struct Node {
    std::array<int, 3> lower, upper;
    int next;     // inner: how far behind is its second child, the first is next; leaf: -1 - number of the leaf
    bool moving;  // some primitive
  };

  // `corners` vertices per primitive, 1 to 3; `primitives` and `ids` run side by side; `object` is per vertex.
  BoxTree(int corners, const std::vector<int>& primitives, const std::vector<int>& ids, const std::vector<int>& object,
          const std::vector<char>& moving, int objects);

  int corners() const { return corners_; }
  bool empty() const { return ids_.empty(); }
  // Boxes are per vertex. Fitting keeps the structure; it is made anew the first time, and when the leaves have grown
  // past the primitives in them.
  void fit(const std::vector<IntegerBox>& boxes);
  long builds() const { return builds_; }

  const lanes::BoxLeaf* leaves() const { return leaves_.data(); }
  // Of an object; null without primitives.
  const Node* root(int object) const;

  // Appends the pairs of leaves whose boxes meet and of which one moves: of this tree's root `a` with those of `b`,
  // which are shifted by up to shift_lower to shift_upper. Where a == b, each pair once.
  static void meet(const Node* a, const Node* b, const int* shift_lower, const int* shift_upper,
                   std::vector<lanes::LeafPair>& pairs);

 private:
  struct Item {
    std::array<int, 3> centre;
    int primitive;
  };
  void build(const std::vector<IntegerBox>& boxes);
  void split(Item* first, Item* last);
  double refit(const std::vector<IntegerBox>& boxes);  // extents of leaves over those of primitives

  int corners_;
  std::vector<int> primitives_, ids_;
  std::vector<char> moving_;  // per primitive
  std::vector<int> starts_;   // per object: its first primitive
  std::vector<int> roots_;    // per object, -1: none
  std::vector<Node> nodes_;
  AlignedVector<lanes::BoxLeaf> leaves_;
  std::vector<Item> items_;
  std::vector<double> leaf_extents_, primitive_extents_;  // per leaf
  double ratio_ = 0;                                      // as refit gave it after the last build
  long builds_ = 0;
};

}  // namespace ergon
