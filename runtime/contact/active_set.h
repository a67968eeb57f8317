#pragma once
// Narrow phase: the stencils that are within dhat of each other at x, by the parts that are nearest. It establishes
// lists in which every stencil stands once, with its multiplicity, in ascending order; those with an offset that was
// lowered (runtime/contact/rest_offsets.h) come last, once for each offset.
// It depends on the positions and on which pairs are within dhat, not on the order of candidates or on others among
// them. Source: Li et al. 2020, Incremental Potential Contact, TOG 39(4): cases of distances and mollified parallel
// edges.

#include <Eigen/Core>
#include <vector>

#include "runtime/contact/broad_phase.h"
#include "runtime/contact/collision_surface.h"
#include "runtime/contact/merge_stencils.h"

namespace ergon {

// Stencils of one case, one after the other.
struct ActiveList {
  int points = 0;                    // per stencil
  std::vector<int> vertices;         // of the system
  std::vector<double> multiplicity;  // per stencil: the sum of the weights of the pairs that are nearest in these parts
  std::vector<double> offset;        // m, per stencil
  size_t count() const { return multiplicity.size(); }
};

struct ActiveSet {
  ActiveList point_point{2, {}, {}, {}};     // p, q
  ActiveList point_edge{3, {}, {}, {}};      // p, e0, e1: p is nearest to the inside of the edge
  ActiveList point_triangle{4, {}, {}, {}};  // p, t0, t1, t2: nearest to the inside of the face
  ActiveList edge_edge{4, {}, {}, {}};       // a0, a1, b0, b1: the insides are nearest
  // Edges so nearly parallel that the mollifier is below 1 and that are nearest elsewhere: point_edge: a0 and the
  // inside of b; point_point: a0 and b0.
  ActiveList parallel_point_edge{4, {}, {}, {}};
  ActiveList parallel_point_point{4, {}, {}, {}};
  double smallest_gap = 0;  // m, beyond offsets, over all candidates; +inf without any

  // What find_active keeps from call to call.
  std::vector<FoundStencils> found;      // per thread
  std::vector<LoweredStencils> lowered;  // per thread
  MergeRoom room;
  std::vector<LoweredStencil> lowered_room;
};

// |cross(a, b)|^2 below which edges of lengths |A| and |B| at rest are mollified, over |A|^2 |B|^2.
constexpr double kMollified = 1e-3;

// Fills `active` with the pairs whose distance is below dhat + their offset at x. X: rest positions, for the mollifier;
// all 3 x vertices of the system, m. Room is reused.
void find_active(const CollisionSurface& surface, const Candidates& candidates, const Eigen::Matrix3Xd& x,
                 const Eigen::Matrix3Xd& X, double dhat, ActiveSet& active);

}  // namespace ergon
