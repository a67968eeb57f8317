#pragma once
// Where the parts of an active stencil are nearest: its points with weights whose sum is the way from one part to the
// other, which is what forces, friction and gaps of all kinds of stencils are made of.

#include <Eigen/Core>
#include <array>

#include "runtime/contact/active_set.h"

namespace ergon {

// In the order of ActiveSet's lists.
enum class ContactKind {
  point_point,
  point_edge,
  point_triangle,
  edge_edge,
  parallel_point_edge,
  parallel_point_point
};
constexpr int kContactKinds = 6;

ActiveList& list_of(ActiveSet& active, ContactKind kind);
const ActiveList& list_of(const ActiveSet& active, ContactKind kind);

struct ContactFrame {
  std::array<double, 4> weight{};  // of the stencil's points; those of either part add to 1 and -1
  Eigen::Vector3d normal;          // from the second part to the first, of length 1; zero where they touch
  double distance = 0;             // m: sum of weight*x = normal*distance
};

// `vertices`: those of one stencil; x: 3 x vertices of the system, m.
ContactFrame contact_frame(ContactKind kind, const int* vertices, const Eigen::Matrix3Xd& x);

// The factor by which nearly parallel edges are faded out: y*(2 - y) of y = |cross|^2/(1e-3 |A|^2 |B|^2), A and B at
// rest; 1 where y is above 1. Source: Li et al. 2020, Incremental Potential Contact, TOG 39(4), the mollifier.
double parallel_factor(const int* edges, const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& X);

}  // namespace ergon
