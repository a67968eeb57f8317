#pragma once
// Broad phase: which primitives of a surface may come near each other. It establishes a list of candidates that holds
// every pair which gets within reach anywhere on a motion, and keeps it for as long as that can be shown to stay true.

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "runtime/contact/collision_surface.h"

namespace ergon {

// Pairs of indices into points, edges and triangles of the surface, each pair once.
struct Candidates {
  std::vector<std::array<int, 2>> point_triangle;
  std::vector<std::array<int, 2>> edge_edge;    // the lower index first
  std::vector<std::array<int, 2>> point_edge;   // only points that end no edge, and edges of no triangle
  std::vector<std::array<int, 2>> point_point;  // only points that end no edge; the lower index first
};

class BroadPhase {
 public:
  // `surface` must outlive this. What is in it may not change, but for which objects meet.
  explicit BroadPhase(const CollisionSurface& surface);
  ~BroadPhase();

  // From now on candidates() holds every pair that may meet and whose distance is below reach + their offset somewhere
  // on the straight motion of all vertices from x0 to x1 (3 x vertices, m). Returns whether the list changed: one that
  // holds them already stays as it is.
  bool cover(const Eigen::Matrix3Xd& x0, const Eigen::Matrix3Xd& x1, double reach);
  const Candidates& candidates() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ergon
