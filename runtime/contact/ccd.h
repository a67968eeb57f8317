#pragma once
// Continuous collision detection: how far vertices may go along straight lines. It establishes, rounding included, that
// at every time in [0, step] the distance of the two primitives is above
// separation + kept*(distance at the start - separation); a step of 0 says that not even the start can be shown to be.
// This holds of the lines x + t*motion of the numbers given, at any distance from the origin. Positions that are
// rounded to doubles lie beside them by up to 2^-53*(|x| + 2*|motion|) per coordinate: they are apart as long as that
// is less than a fraction of kept*(distance at the start - separation).
//
// Source: additive continuous collision detection, Li, Kaufman, Jiang 2021, Codimensional Incremental Potential
// Contact, TOG 40(4), with the motion bounded along the direction of the nearest points instead of by its length: pairs
// that move together, slide along each other or part are not held up.

#include <Eigen/Core>

namespace ergon {

struct CcdQuery {
  const Eigen::Vector3d* x = nullptr;       // m, positions at time 0: as named at each function
  const Eigen::Vector3d* motion = nullptr;  // m, displacement from time 0 to 1
  double separation = 0;                    // m, at least 0
  double kept = 0.1;                        // in (0, 1)
  double at_most = 1;                       // in (0, 1]: steps beyond it are of no interest
};

// Steps in [0, at_most]: the smaller of at_most and of the step that there is without it.
double point_point_step(const CcdQuery& query);     // p, q
double point_edge_step(const CcdQuery& query);      // p, e0, e1
double point_triangle_step(const CcdQuery& query);  // p, t0, t1, t2
double edge_edge_step(const CcdQuery& query);       // a0, a1, b0, b1

}  // namespace ergon
