#pragma once
// The projections of runtime/lanes by width and size, for code that is compiled for any machine (tests, measurements).

namespace ergon::lanes {

struct ProjectionTable {
  static constexpr int kLargest = 15;
  int lanes = 0;
  // Indexed by N; see definite<N> and project_lanes<N> in runtime/lanes/projection.h.
  double definite_tolerance[kLargest + 1] = {};
  unsigned (*definite[kLargest + 1])(const double* packed) = {};
  void (*project[kLargest + 1])(double* packed, bool absolute, unsigned lanes) = {};
  void (*project_two[kLargest + 1])(double* first, unsigned first_lanes, double* second, unsigned second_lanes,
                                    bool absolute) = {};
  // F, U, V column by column: f[9][lanes] -> u[9][lanes], s[3][lanes], v[9][lanes]; see svd3 in runtime/lanes/svd3.h.
  void (*svd3)(const double* f, double* u, double* s, double* v) = nullptr;
  // Indexed by the columns of F: F[3*columns] and singular values s[columns] by the decomposition in use.
  void (*stretches[4])(const double* f, double* s) = {};
  // Indexed by the columns of F: its blocks (codegen/principal.h) -> packed Hessian, projected; see
  // runtime/lanes/projection_isotropic.h. Returns the changed lanes.
  unsigned (*isotropic[4])(const double* f, const double* blocks, bool absolute, double* packed) = {};
};

// Throws std::invalid_argument when this machine or build lacks that width.
const ProjectionTable& projection_table(int lanes);

}  // namespace ergon::lanes
