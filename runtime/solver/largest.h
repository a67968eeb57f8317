#pragma once
// The largest component of a field over vertices, and where it is; a number that is not finite is largest.

#include <Eigen/Core>

#include "runtime/system.h"

namespace ergon {

struct Largest {
  double value = 0;
  int vertex = -1;
};

template <class Chosen>
Largest largest_component(const Eigen::Matrix3Xd& field, Chosen chosen) {
  Largest largest;
  for (int v = 0; v < static_cast<int>(field.cols()); ++v) {
    if (!chosen(v)) continue;
    const double size = field.col(v).cwiseAbs().maxCoeff();
    if (!(size <= largest.value)) largest = {size, v};
  }
  return largest;
}

// Over vertices with degrees of freedom of their own.
inline Largest largest_free_component(const System& system, const Eigen::Matrix3Xd& field) {
  return largest_component(field, [&](int v) { return system.block_of(v) >= 0; });
}

// Over all vertices that move.
inline Largest largest_motion(const System& system, const Eigen::Matrix3Xd& field) {
  return largest_component(field, [&](int v) { return system.moves(v); });
}

}  // namespace ergon
