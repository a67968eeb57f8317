#pragma once
// Continuous collision detection by subdivision of time and of both primitives: what ccd.h establishes, by another way,
// slower and independent of it.
// Source: Wang, Ferguson, Schneider, Jiang, Attene, Panozzo 2021, A Large-Scale Benchmark and an Inclusion-Based
// Algorithm for Continuous Collision Detection, TOG 40(5), with the earliest box first, and hulls of corners instead of
// boxes around them.

#include "runtime/contact/ccd.h"

namespace ergon {

// Steps in [0, at_most]. Where more boxes are needed than there is room for, the step ends at the earliest that is
// left.
double point_triangle_step_by_inclusion(const CcdQuery& query);  // p, t0, t1, t2
double edge_edge_step_by_inclusion(const CcdQuery& query);       // a0, a1, b0, b1

}  // namespace ergon
