#pragma once
// Candidates of one kind: the primitives of two trees whose boxes meet and that pass a filter, in an order that depends
// on the trees alone.

#include <array>
#include <functional>
#include <vector>

#include "runtime/contact/box_tree.h"

namespace ergon {

// How far the second object may be displaced against the first.
struct Shift {
  std::array<int, 3> lower{}, upper{};  // units
  double length = 0;                    // m
};

class PairList {
 public:
  // Moves the pairs to keep to the front and returns how many there are. length: m, of the objects' shift.
  using Filter = std::function<long(std::array<int, 2>* pairs, long count, double length)>;

  // Both trees must outlive this. Without a filter all pairs stay.
  PairList(const BoxTree& a, const BoxTree& b, Filter filter = {}) : a_(&a), b_(&b), filter_(std::move(filter)) {}

  void clear();
  // Those of an object in the first tree with those of one in the second, which is displaced.
  void add(int object_a, int object_b, const Shift& shift);
  // All that was added since clear(). Shared out among threads; the result does not depend on how many there are.
  void write(std::vector<std::array<int, 2>>& out);

 private:
  struct Segment {
    Shift shift;
    size_t end;  // of its pairs of leaves
  };
  void write_range(size_t first, size_t last, size_t thread);

  const BoxTree *a_, *b_;
  Filter filter_;
  std::vector<lanes::LeafPair> leaves_;
  std::vector<Segment> segments_;
  struct Found {
    std::vector<std::array<int, 2>> pairs;  // as many as there has been room for
    long count = 0;
  };
  std::vector<Found> found_;  // per thread
};

}  // namespace ergon
