#pragma once
// Continuous collision detection: how far vertices may go along straight lines. It establishes, rounding included, that
// at every time in [0, step] the distance of the two primitives is above
// separation + kept*(distance at the start - separation); a step of 0 says that not even the start can be shown to be.

#include <Eigen/Core>

namespace ergon {

struct CcdQuery {
  const Eigen::Vector3d* x = nullptr;       // m, positions at time 0: as named at each function
  const Eigen::Vector3d* motion = nullptr;  // m, displacement from time 0 to 1
  double separation = 0;                    // m, at least 0
  double kept = 0.1;                        // in (0, 1)
};

// Steps in [0, 1].
double point_point_step(const CcdQuery& query);     // p, q
double point_edge_step(const CcdQuery& query);      // p, e0, e1
double point_triangle_step(const CcdQuery& query);  // p, t0, t1, t2
double edge_edge_step(const CcdQuery& query);       // a0, a1, b0, b1

}  // namespace ergon
