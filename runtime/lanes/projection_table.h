#pragma once
// The projections of runtime/lanes by width and size, for code that is compiled for any machine (tests, measurements).

namespace ergon::lanes {

struct ProjectionTable {
  static constexpr int kLargest = 12;
  int lanes = 0;
  // Indexed by N; see definite<N> and project_lanes<N> in runtime/lanes/projection.h.
  double definite_tolerance[kLargest + 1] = {};
  unsigned (*definite[kLargest + 1])(const double* packed) = {};
  void (*project[kLargest + 1])(double* packed, bool absolute, unsigned lanes) = {};
};

// Throws std::invalid_argument when this machine or build lacks that width.
const ProjectionTable& projection_table(int lanes);

}  // namespace ergon::lanes
