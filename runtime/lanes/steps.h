#pragma once
// Continuous collision detection of many pairs of primitives, one pair per lane: the first plane that
// runtime/contact/ccd.cpp tries. It establishes which pairs that plane does not keep apart all the way.

namespace ergon::lanes {

constexpr int kSteps = 128;  // pairs at a time

struct alignas(64) StepRoom {
  double coordinate[12][kSteps], motion[12][kSteps];  // m: of four vertices
  double separation[kSteps];                          // m, per pair
  int left[kSteps];                                   // which pairs are not known to be free up to at_most
};

struct StepTask {
  const double* x;          // m, 3 per vertex
  const double* direction;  // m, 3 per vertex
  double kept, at_most;     // as in runtime/contact/ccd.h
};

struct StepOperations {
  // Pairs index points and triangles, or edges; count is at most kSteps. Returns how many are left.
  int (*point_triangle)(const StepTask&, const int* points, const int (*triangles)[3], const int (*pairs)[2], int count,
                        StepRoom&);
  int (*edge_edge)(const StepTask&, const int (*edges)[2], const int (*pairs)[2], int count, StepRoom&);
};

// Throws std::invalid_argument for a width that is none of kWidths or that this machine lacks.
const StepOperations& step_operations(int lanes);

}  // namespace ergon::lanes
