#include "runtime/lanes/projection_table.h"

#include "runtime/lanes/projection.h"
#include "runtime/lanes/projection_isotropic.h"
#include "runtime/lanes/svd3.h"

#define ERGON_JOIN_(a, b) a##b
#define ERGON_JOIN(a, b) ERGON_JOIN_(a, b)

namespace ergon::lanes {
namespace {

template <int N>
void project(double* packed, bool absolute, unsigned lanes) {
  project_lanes<N>(packed, absolute ? Negative::absolute : Negative::clamp, lanes);
}

Vector load_vector(const double* p) { return {load(p), load(p + kWidth), load(p + 2 * kWidth)}; }

void store_vector(double* p, const Vector& a) {
  store(p, a.x);
  store(p + kWidth, a.y);
  store(p + 2 * kWidth, a.z);
}

Svd3 decompose(const double* f) {
  return svd3(load_vector(f), load_vector(f + 3 * kWidth), load_vector(f + 6 * kWidth));
}

void singular_values(const double* f, double* u, double* s, double* v) {
  const Svd3 r = decompose(f);
  for (int i = 0; i < 3; ++i) {
    store_vector(u + 3 * i * kWidth, r.u[i]);
    store_vector(v + 3 * i * kWidth, r.v[i]);
    store(s + i * kWidth, r.s[i]);
  }
}

unsigned isotropic(const double* f, const double* blocks, bool absolute, double* packed) {
  IsotropicHessian h;
  for (int i = 0; i < 6; ++i) h.stretch[i] = load(blocks + i * kWidth);
  for (int i = 0; i < 3; ++i) {
    h.twist[i] = load(blocks + (6 + i) * kWidth);
    h.flip[i] = load(blocks + (9 + i) * kWidth);
  }
  const unsigned changed = project_isotropic(h, absolute ? Negative::absolute : Negative::clamp);
  rotate_isotropic(decompose(f), h, packed);
  return changed;
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
    t.svd3 = singular_values;
    t.isotropic = isotropic;
    return t;
  }();
  return table;
}

}  // namespace ergon::lanes
