#pragma once
// The shape of a stencil: how many points, how many 3-vectors in q, and the weights that lead from points to q. Common
// shapes are known when this is compiled, so that their loops unroll; all others run the same text with counts read
// from the data. Included only by files in runtime/lanes.

#include "runtime/lanes/evaluate_block.h"

namespace ergon::lanes {
namespace {

// P points (0: read from the data), Q vectors in q, weights per lane (a density) or the same for all (a stencil
// energy).
template <int P, int Q, bool D>
struct Shape {
  static constexpr int kPoints = P;
  static constexpr int kVectors = Q;
  static constexpr bool kDensity = D;
  static constexpr int kMost = P != 0 ? P : kMaxPoints;
  static constexpr int kSize = 3 * Q;
  static constexpr int kPacked = kSize * (kSize + 1) / 2;
  static int points(const Stencils& s) { return P != 0 ? P : s.points; }
};

// Calls f with the Shape of these stencils.
template <class F>
auto with_shape(const Stencils& s, F f) {
  const int points = s.points, vectors = s.kernel->q_vectors;
  if (s.kernel->density) {
    if (vectors == 3) return points == 4 ? f(Shape<4, 3, true>{}) : f(Shape<0, 3, true>{});
    if (vectors == 2) return points == 3 ? f(Shape<3, 2, true>{}) : f(Shape<0, 2, true>{});
    return f(Shape<0, 1, true>{});
  }
  if (vectors == 1) {
    if (points == 1) return f(Shape<1, 1, false>{});
    return points == 2 ? f(Shape<2, 1, false>{}) : f(Shape<0, 1, false>{});
  }
  if (vectors == 2) return f(Shape<0, 2, false>{});
  if (vectors == 3) return points == 4 ? f(Shape<4, 3, false>{}) : f(Shape<0, 3, false>{});
  return f(Shape<0, 4, false>{});
}

inline const double* data_of(const Stencils& s, int block) {
  return s.elements + static_cast<long>(block) * s.kernel->elements * kWidth;
}

template <class S, bool = S::kDensity>
class Weights;

// A density: gradients of the shape functions at one point of quadrature. They sum to zero over the points.
template <class S>
class Weights<S, true> {
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
class Weights<S, false> {
 public:
  Weights(const Stencils& s, int, int) : weight_(s.kernel->weights), points_(S::points(s)) {}
  Real at(int k, int a) const { return splat(weight_[k * points_ + a]); }
  static Real times_volume(Real a) { return a; }

 private:
  const double* weight_;
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
    const long weights = vector * S::kVectors * (n - 1);
    prefetch(s.weights + places * (weights / 8), weights * s.quadrature);
    prefetch(s.volumes + places * kWidth, vector * s.quadrature);
  }
  prefetch(data_of(s, block), vector * s.kernel->elements);
}

template <class S>
inline void gather_points(const Stencils& s, int block, const double* x, Vector3* points) {
  const int n = S::points(s);
  const int* vertices = s.vertices + static_cast<long>(block) * n * kWidth;
  for (int a = 0; a < n; ++a) points[a] = gather(x, vertices + a * kWidth);
  if constexpr (S::kDensity) {
    // Relative to the last point, so that its weights are not needed and nothing cancels far from the origin.
    for (int a = 0; a + 1 < n; ++a) {
      for (int c = 0; c < 3; ++c) points[a].c[c] -= points[n - 1].c[c];
    }
  }
}

// q = (weights (x) I3) x, from what gather_points gave.
template <class S>
inline void form_q(const Stencils& s, const Weights<S>& w, const Vector3* points, double* q) {
  const int n = S::kDensity ? S::points(s) - 1 : S::points(s);
  for (int k = 0; k < S::kVectors; ++k) {
    Real sum[3] = {splat(0), splat(0), splat(0)};
    for (int a = 0; a < n; ++a) {
      for (int c = 0; c < 3; ++c) sum[c] += w.at(k, a) * points[a].c[c];
    }
    for (int c = 0; c < 3; ++c) store(q + (3 * k + c) * kWidth, sum[c]);
  }
}

// g_a += volume * sum_k w_ka dpsi/dq_k for all points but a density's last, whose gradient is minus the sum.
template <class S>
inline void chain_gradient(const Stencils& s, const Weights<S>& w, const double* by_q, Vector3* by_point) {
  const int n = S::kDensity ? S::points(s) - 1 : S::points(s);
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
