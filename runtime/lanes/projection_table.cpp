#include "runtime/lanes/projection_table.h"

#include "runtime/lanes/projection.h"

#define ERGON_JOIN_(a, b) a##b
#define ERGON_JOIN(a, b) ERGON_JOIN_(a, b)

namespace ergon::lanes {
namespace {

template <int N>
void project(double* packed, bool absolute, unsigned lanes) {
  project_lanes<N>(packed, absolute ? Negative::absolute : Negative::clamp, lanes);
}

template <int N>
void fill(ProjectionTable& table) {
  table.definite_tolerance[N] = definite_tolerance(N);
  table.definite[N] = definite<N>;
  table.project[N] = project<N>;
  if constexpr (N > 1) fill<N - 1>(table);
}

}  // namespace

const ProjectionTable& ERGON_JOIN(projection_table_, ERGON_LANES)();
const ProjectionTable& ERGON_JOIN(projection_table_, ERGON_LANES)() {
  static const ProjectionTable table = [] {
    ProjectionTable t;
    t.lanes = ERGON_LANES;
    fill<ProjectionTable::kLargest>(t);
    return t;
  }();
  return table;
}

}  // namespace ergon::lanes
