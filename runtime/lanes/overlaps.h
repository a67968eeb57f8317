#pragma once
// Overlaps of boxes, sixteen against sixteen. It establishes that every pair of primitives whose boxes meet is written
// out, once, unless both are at rest or they share a vertex.

namespace ergon::lanes {

constexpr int kLeaf = 16;

// Up to sixteen primitives of a tree. Boxes are closed and in units of the tree; those of the places without a
// primitive are empty.
struct alignas(64) BoxLeaf {
  int lower[3][kLeaf], upper[3][kLeaf];
  int vertex[3][kLeaf];  // corners; negative where a primitive has fewer
  int id[kLeaf];
  int lowest[3], highest[3];  // of all sixteen
  unsigned moving;            // bit i: primitive i moves
  int count;
};

struct LeafPair {
  int a, b;
};
struct IdPair {
  int a, b;
};

struct OverlapTask {
  const BoxLeaf* a;
  const BoxLeaf* b;
  int corners_a, corners_b;            // that may be shared; 0: none is
  bool same;                           // both are one tree: the lower id goes first, and a leaf meets itself
  int shift_lower[3], shift_upper[3];  // added to the boxes of b
};

constexpr int kMostOverlaps = kLeaf * kLeaf;  // of one pair of leaves

struct OverlapOperations {
  // Goes through pairs of leaves while another kMostOverlaps fit into `room`; returns how many were done and adds to
  // *found the pairs that were written.
  long (*overlaps)(const OverlapTask&, const LeafPair* pairs, long count, IdPair* out, long room, long* found);
};

// Throws std::invalid_argument for a width that is none of kWidths or that this machine lacks.
const OverlapOperations& overlap_operations(int lanes);

}  // namespace ergon::lanes
