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

template <int N>
void project_two(double* first, unsigned first_lanes, double* second, unsigned second_lanes, bool absolute) {
  project_lanes<N>(first, first_lanes, second, second_lanes, absolute ? Negative::absolute : Negative::clamp);
}

Vector load_vector(const double* p) { return {load(p), load(p + kWidth), load(p + 2 * kWidth)}; }

void store_vector(double* p, const Vector& a) {
  store(p, a.x);
  store(p + kWidth, a.y);
  store(p + 2 * kWidth, a.z);
}

void singular_values(const double* f, double* u, double* s, double* v) {
  const Svd3 r = svd3(load_vector(f), load_vector(f + 3 * kWidth), load_vector(f + 6 * kWidth));
  for (int i = 0; i < 3; ++i) {
    store_vector(u + 3 * i * kWidth, r.u[i]);
    store_vector(v + 3 * i * kWidth, r.v[i]);
    store(s + i * kWidth, r.s[i]);
  }
}

template <int Q>
Svd<Q> decompose_columns(const double* f) {
  Vector columns[Q];
  for (int c = 0; c < Q; ++c) columns[c] = load_vector(f + 3L * c * kWidth);
  return decompose<Q>(columns);
}

template <int Q>
void stretches(const double* f, double* s) {
  const Svd<Q> r = decompose_columns<Q>(f);
  for (int i = 0; i < Q; ++i) store(s + i * kWidth, r.s[i]);
}

template <int Q>
unsigned isotropic(const double* f, const double* blocks, bool absolute, double* packed) {
  IsotropicHessian<Q> h(blocks);
  const unsigned changed = project_isotropic(h, absolute ? Negative::absolute : Negative::clamp);
  rotate_isotropic(decompose_columns<Q>(f), h, packed);
  return changed;
}

template <int Q>
void fill_isotropic(ProjectionTable& table) {
  table.stretches[Q] = stretches<Q>;
  table.isotropic[Q] = isotropic<Q>;
  if constexpr (Q > 1) fill_isotropic<Q - 1>(table);
}

template <int N>
void fill(ProjectionTable& table) {
  table.definite_tolerance[N] = definite_tolerance(N);
  table.definite[N] = definite<N>;
  table.project[N] = project<N>;
  table.project_two[N] = project_two<N>;
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
    fill_isotropic<3>(t);
    return t;
  }();
  return table;
}

}  // namespace ergon::lanes
