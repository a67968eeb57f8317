#pragma once
// The shape of a stencil: how many points, how many 3-vectors in q, and the weights that lead from points to q. Common
// shapes are known when this is compiled, so that their loops unroll; all others run the same text with counts read
// from the data. Included only by files in runtime/lanes.

#include "runtime/lanes/evaluate_block.h"

namespace ergon::lanes {
namespace {

// The kernel's entry points and what it keeps, in the precision that this is compiled for.
#ifdef ERGON_SINGLE
constexpr bool kSingle = true;
inline const ErgonSingle& entries_of(const Stencils& s) { return *s.kernel->single; }
inline const Scalar* uniforms_of(const Stencils& s) { return s.single_uniforms; }
inline const Scalar* elements_of(const Stencils& s) { return s.single_elements; }
#else
constexpr bool kSingle = false;
inline const ErgonKernel& entries_of(const Stencils& s) { return *s.kernel; }
inline const Scalar* uniforms_of(const Stencils& s) { return s.uniforms; }
inline const Scalar* elements_of(const Stencils& s) { return s.elements; }
#endif

// Where weights come from: constants of a stencil energy's kernel, the same in all lanes; given for each stencil;
// gradients of shape functions in each lane; or their gradients in the reference element, the same in all lanes, times
// an inverse map in each.
enum class Source { kernel, given, gradients, table };

// P points (0: read from the data) and Q vectors in q.
template <int P, int Q, Source W>
struct Shape {
  static constexpr int kPoints = P;
  static constexpr int kVectors = Q;
  static constexpr Source kSource = W;
  static constexpr bool kDensity = W == Source::gradients || W == Source::table;
  // All points but the last are gathered relative to it: floats have no digits to spare.
  static constexpr bool kRelative = W != Source::kernel || kSingle;
  static constexpr bool kTable = W == Source::table;
  static constexpr bool kAscending = W == Source::gradients;  // points stand in ascending order of vertex
  static constexpr int kMost = P != 0 ? P : kMaxPoints;
  static constexpr int kSize = 3 * Q;
  static constexpr int kPacked = kSize * (kSize + 1) / 2;
  static int points(const Stencils& s) { return P != 0 ? P : s.points; }
};

// Calls f with the Shape of these stencils.
template <class F>
auto with_shape(const Stencils& s, F f) {
  const int points = s.points, vectors = s.kernel->q_vectors;
  if (s.kernel->density && s.table != nullptr) {
    if (vectors == 3) return points == 10 ? f(Shape<10, 3, Source::table>{}) : f(Shape<0, 3, Source::table>{});
    return vectors == 2 ? f(Shape<0, 2, Source::table>{}) : f(Shape<0, 1, Source::table>{});
  }
  if (s.kernel->density) {
    if (vectors == 3) return f(Shape<4, 3, Source::gradients>{});
    return vectors == 2 ? f(Shape<3, 2, Source::gradients>{}) : f(Shape<2, 1, Source::gradients>{});
  }
  if (s.combined) {
    if (vectors == 1) return f(Shape<0, 1, Source::given>{});
    if (vectors == 2) return f(Shape<0, 2, Source::given>{});
    return vectors == 3 ? f(Shape<0, 3, Source::given>{}) : f(Shape<0, 4, Source::given>{});
  }
  if (vectors == 1) {
    if (points == 1) return f(Shape<1, 1, Source::kernel>{});
    return points == 2 ? f(Shape<2, 1, Source::kernel>{}) : f(Shape<0, 1, Source::kernel>{});
  }
  if (vectors == 2) return points == 3 ? f(Shape<3, 2, Source::kernel>{}) : f(Shape<0, 2, Source::kernel>{});
  if (vectors == 3) return points == 4 ? f(Shape<4, 3, Source::kernel>{}) : f(Shape<0, 3, Source::kernel>{});
  return vectors == 4 ? f(Shape<0, 4, Source::kernel>{}) : f(Shape<6, 5, Source::kernel>{});
}

inline const Scalar* data_of(const Stencils& s, int block, int quadrature) {
  return elements_of(s) + (static_cast<long>(block) * s.quadrature + quadrature) * s.kernel->elements * kWidth;
}

template <class S, Source = S::kSource>
class Weights;

// A density: gradients of the shape functions at one point of quadrature. They sum to zero over the points.
template <class S>
class Weights<S, Source::gradients> {
 public:
  Weights(const Stencils& s, int block, int quadrature) {
    const int free = S::points(s) - 1;
    const long place = static_cast<long>(block) * s.quadrature + quadrature;
    const double* w = s.weights + place * S::kVectors * free * kWidth;
    for (int k = 0; k < S::kVectors; ++k) {
      Real sum = splat(0);
      for (int a = 0; a < free; ++a, w += kWidth) {
        weight_[k][a] = load(w);
        sum += weight_[k][a];
      }
      weight_[k][free] = -sum;
    }
    volume_ = load(s.volumes + place * kWidth);
  }
  Real at(int k, int a) const { return weight_[k][a]; }
  Real times_volume(Real a) const { return a * volume_; }

 private:
  Real weight_[S::kVectors][S::kMost];
  Real volume_;
};

// A stencil energy: constants of the kernel.
template <class S>
class Weights<S, Source::kernel> {
 public:
  Weights(const Stencils& s, int, int) : weight_(s.weights), points_(S::points(s)) {}
  Real at(int k, int a) const { return splat(weight_[k * points_ + a]); }
  Real sum(int k) const {
    double sum = 0;
    for (int a = 0; a < points_; ++a) sum += weight_[k * points_ + a];
    return splat(sum);
  }
  static Real times_volume(Real a) { return a; }

 private:
  const double* weight_;
  int points_;
};

// A stencil energy with weights of each stencil's own.
template <class S>
class Weights<S, Source::given> {
 public:
  Weights(const Stencils& s, int block, int)
      : weight_(s.weights + static_cast<long>(block) * S::kVectors * (S::points(s) + 1) * kWidth),
        points_(S::points(s)) {}
  Real at(int k, int a) const { return load(weight_ + (k * (points_ + 1) + a) * kWidth); }
  Real sum(int k) const { return at(k, points_); }
  static Real times_volume(Real a) { return a; }

 private:
  const double* weight_;
  int points_;
};

// A density on an element whose gradients vary: those in the reference element, and the inverse of its map. The
// gradient of point a along axis k of the rest shape is sum_j map(j, k) table(j)[a].
template <class S>
class Weights<S, Source::table> {
 public:
  Weights(const Stencils& s, int block, int quadrature) : points_(S::points(s)) {
    constexpr int Q = S::kVectors;
    const long place = static_cast<long>(block) * s.quadrature + quadrature;
    const double* m = s.weights + place * Q * Q * kWidth;
    for (int i = 0; i < Q * Q; ++i) map_[i] = load(m + i * kWidth);
    volume_ = load(s.volumes + place * kWidth);
    table_ = s.table + static_cast<long>(quadrature) * Q * points_;
  }
  Real map(int j, int k) const { return map_[j * S::kVectors + k]; }
  const double* table(int j) const { return table_ + j * points_; }
  Real times_volume(Real a) const { return a * volume_; }

 private:
  Real map_[S::kVectors * S::kVectors];
  Real volume_;
  const double* table_;
  int points_;
};

inline void prefetch(const void* first, long bytes) {
  for (long at = 0; at < bytes; at += 64) __builtin_prefetch(static_cast<const char*>(first) + at);
}

// Asks for the data of a block that will be evaluated soon: chunks of a colour lie far apart, so the processor does not
// see the next one coming.
template <class S>
inline void prefetch_block(const Stencils& s, int block) {
  const int n = S::points(s);
  const long vector = 8L * kWidth, points = static_cast<long>(block) * n * kWidth;
  const long places = static_cast<long>(block) * s.quadrature;
  prefetch(s.vertices + points, 4L * kWidth * n);
  if constexpr (S::kDensity) {
    const long weights = vector * S::kVectors * (S::kTable ? S::kVectors : n - 1);
    prefetch(s.weights + places * (weights / 8), weights * s.quadrature);
    prefetch(s.volumes + places * kWidth, vector * s.quadrature);
    if (s.frames != nullptr) prefetch(s.frames + places * 9 * kWidth, vector * 9 * s.quadrature);
  }
  if constexpr (S::kSource == Source::given) {
    const long weights = static_cast<long>(S::kVectors) * (n + 1);
    prefetch(s.weights + block * weights * kWidth, vector * weights);
  }
  prefetch(data_of(s, block, 0), static_cast<long>(sizeof(Real)) * s.kernel->elements * s.quadrature);
}

template <class S>
inline void gather_points(const Stencils& s, int block, const double* x, Vector3* points) {
  const int n = S::points(s);
  const int* vertices = s.vertices + static_cast<long>(block) * n * kWidth;
#ifdef ERGON_SINGLE
  const int* last = vertices + (n - 1) * kWidth;
  for (int a = 0; a + 1 < n; ++a) points[a] = gather(x, vertices + a * kWidth, last);
  points[n - 1] = gather(x, last);
#else
  for (int a = 0; a < n; ++a) points[a] = gather(x, vertices + a * kWidth);
  if constexpr (S::kRelative) {
    // Relative to the last point, so that its weights are not needed and nothing cancels far from the origin.
    for (int a = 0; a + 1 < n; ++a) {
      for (int c = 0; c < 3; ++c) points[a].c[c] -= points[n - 1].c[c];
    }
  }
#endif
}

// q = (weights (x) I3) x, from what gather_points gave.
template <class S>
inline void form_q(const Stencils& s, const Weights<S>& w, const Vector3* points, Scalar* q) {
  const int n = S::kRelative ? S::points(s) - 1 : S::points(s);
  if constexpr (S::kTable) {
    constexpr int Q = S::kVectors;
    Real by_axis[Q][3] = {};
    for (int a = 0; a < n; ++a) {
      for (int j = 0; j < Q; ++j) {
        const Real weight = splat(w.table(j)[a]);
        for (int c = 0; c < 3; ++c) by_axis[j][c] += weight * points[a].c[c];
      }
    }
    for (int k = 0; k < Q; ++k) {
      for (int c = 0; c < 3; ++c) {
        Real sum = w.map(0, k) * by_axis[0][c];
        for (int j = 1; j < Q; ++j) sum += w.map(j, k) * by_axis[j][c];
        store(q + (3 * k + c) * kWidth, sum);
      }
    }
    return;
  } else
    for (int k = 0; k < S::kVectors; ++k) {
      Real sum[3] = {splat(0), splat(0), splat(0)};
      if constexpr (S::kRelative && !S::kDensity) {
        for (int c = 0; c < 3; ++c) sum[c] = w.sum(k) * points[n].c[c];
      }
      for (int a = 0; a < n; ++a) {
        for (int c = 0; c < 3; ++c) sum[c] += w.at(k, a) * points[a].c[c];
      }
      for (int c = 0; c < 3; ++c) store(q + (3 * k + c) * kWidth, sum[c]);
    }
}

// g_a += volume * sum_k w_ka dpsi/dq_k for all points but a density's last, whose gradient is minus the sum.
template <class S>
inline void chain_gradient(const Stencils& s, const Weights<S>& w, const Scalar* by_q, Vector3* by_point) {
  const int n = S::kDensity ? S::points(s) - 1 : S::points(s);
  if constexpr (S::kTable) {
    constexpr int Q = S::kVectors;
    Real by_axis[Q][3];
    for (int j = 0; j < Q; ++j) {
      for (int c = 0; c < 3; ++c) {
        Real sum = w.map(j, 0) * load(by_q + c * kWidth);
        for (int k = 1; k < Q; ++k) sum += w.map(j, k) * load(by_q + (3 * k + c) * kWidth);
        by_axis[j][c] = w.times_volume(sum);
      }
    }
    for (int a = 0; a < n; ++a) {
      for (int j = 0; j < Q; ++j) {
        const Real weight = splat(w.table(j)[a]);
        for (int c = 0; c < 3; ++c) by_point[a].c[c] += weight * by_axis[j][c];
      }
    }
    return;
  } else
    for (int k = 0; k < S::kVectors; ++k) {
      for (int c = 0; c < 3; ++c) {
        const Real g = w.times_volume(load(by_q + (3 * k + c) * kWidth));
        for (int a = 0; a < n; ++a) by_point[a].c[c] += w.at(k, a) * g;
      }
    }
}

template <class S>
inline void scatter_points(const Stencils& s, int block, int count, Vector3* by_point, double* gradient) {
  const int n = S::points(s);
  if constexpr (S::kDensity) {
    for (int c = 0; c < 3; ++c) {
      Real sum = splat(0);
      for (int a = 0; a + 1 < n; ++a) sum += by_point[a].c[c];
      by_point[n - 1].c[c] = -sum;
    }
  }
  const int* vertices = s.vertices + static_cast<long>(block) * n * kWidth;
  for (int a = 0; a < n; ++a) scatter(gradient, vertices + a * kWidth, count, by_point[a]);
}

}  // namespace
}  // namespace ergon::lanes
