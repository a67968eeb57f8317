#pragma once
// Densities in principal stretches: from q (F, or G = F - I) to the stretches, which the kernel sees, and back from
// derivatives by these to those by F. Included only by files in runtime/lanes. It establishes stretches less 1 with an
// error of the order of rounding times |G| where |G| < 1/4, and times the largest stretch elsewhere.

#include "runtime/lanes/evaluate_isotropic.h"

namespace ergon::lanes {
namespace {

constexpr Scalar kNearRest = 1.0 / 16;  // of |G|^2: no stretch is near 0

// F = U diag(s) V' and s - 1.
template <int Q>
struct StretchFrame {
  Svd<Q> svd;
  Real strain[Q];
};

// Where F = I + G and |G| is small: V holds the eigenvectors of F'F - I = G + G' + G'G, which keeps the digits of G,
// and s - 1 = l/(1 + sqrt(1 + l)) for its eigenvalues l. Two steps as in svd3: an isolated eigenvector, then a rotation
// of its complement.
inline StretchFrame<3> frame_near_rest(const Vector& g0, const Vector& g1, const Vector& g2) {
  const Symmetric e{2 * g0.x + dot(g0, g0),    g0.y + g1.x + dot(g0, g1), 2 * g1.y + dot(g1, g1),
                    g0.z + g2.x + dot(g0, g2), g1.z + g2.y + dot(g1, g2), 2 * g2.z + dot(g2, g2)};
  Real size = max(max(abs(e.a00), abs(e.a10)), max(abs(e.a11), abs(e.a20)));
  size = max(max(max(abs(e.a21), abs(e.a22)), size), splat(kNegligible));
  const Real scale = 1 / size;
  const Symmetric n{scale * e.a00, scale * e.a10, scale * e.a11, scale * e.a20, scale * e.a21, scale * e.a22};
  Vector v[3];
  const Isolated isolated = isolated_eigenvector(n);
  v[0] = isolated.v;
  frame(v[0], v[1], v[2]);
  // The rotation by b that takes the off-diagonal entry away: tan(2 b) = y/x.
  const Vector n1 = n * v[1], n2 = n * v[2];
  const Real x = dot(v[1], n1) - dot(v[2], n2), y = 2 * dot(v[1], n2);
  const Real hypotenuse = x * x + y * y;
  const Mask turned = less(splat(kNegligible), hypotenuse);
  const Real inverse = rsqrt(max(hypotenuse, splat(kNegligible)));
  const Real cos_2b = select(turned, abs(x) * inverse, splat(1)), sin_2b = select(turned, abs(y) * inverse, splat(0));
  const Real larger_squared = 0.5 + 0.5 * cos_2b;
  const Real inverse_larger = rsqrt(larger_squared);
  const Real larger = larger_squared * inverse_larger, smaller = 0.5 * sin_2b * inverse_larger;
  const Mask first = less_equal(splat(0), x);
  const Real c = select(first, larger, smaller), s = copysign(select(first, smaller, larger), y);
  const Vector v1 = c * v[1] + s * v[2], v2 = c * v[2] + (-s) * v[1];
  const Mask highest = isolated.highest;
  StretchFrame<3> out;
  out.svd.v[0] = select(highest, v[0], v1);
  out.svd.v[1] = select(highest, v1, v2);
  out.svd.v[2] = select(highest, v2, v[0]);
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    const Vector& w = out.svd.v[i];
    const Real l = dot(w, e * w);
    out.strain[i] = l / (1 + sqrt(1 + l));
    out.svd.s[i] = 1 + out.strain[i];
    const Vector image = w.x * g0 + w.y * g1 + w.z * g2;  // G v
    out.svd.u[i] = (1 / out.svd.s[i]) * (w + image);
  }
  return out;
}

// Of q: F, or G where `displacement` is set.
template <int Q>
inline StretchFrame<Q> stretch_frame(const Scalar* q, bool displacement) {
  StretchFrame<Q> out;
  Vector f[Q];
  if constexpr (Q == 3) {
    if (displacement) {
      const Vector g0 = column_of(q, 0), g1 = column_of(q, 1), g2 = column_of(q, 2);
      const Mask near = less(dot(g0, g0) + dot(g1, g1) + dot(g2, g2), splat(kNearRest));
      const unsigned lanes = bits(near) & kAllLanes;
      if (lanes != 0) out = frame_near_rest(g0, g1, g2);
      if (lanes == kAllLanes) return out;
      deformation<3>(q, true, f);
      const Svd3 far = decompose<3>(f);
      for (int i = 0; i < 3; ++i) {
        out.svd.u[i] = lanes == 0 ? far.u[i] : select(near, out.svd.u[i], far.u[i]);
        out.svd.v[i] = lanes == 0 ? far.v[i] : select(near, out.svd.v[i], far.v[i]);
        out.svd.s[i] = lanes == 0 ? far.s[i] : select(near, out.svd.s[i], far.s[i]);
        out.strain[i] = lanes == 0 ? far.s[i] - 1 : select(near, out.strain[i], far.s[i] - 1);
      }
      return out;
    }
  }
  deformation<Q>(q, displacement, f);
  out.svd = decompose<Q>(f);
  for (int i = 0; i < Q; ++i) out.strain[i] = out.svd.s[i] - 1;
  return out;
}

template <int Q>
inline void store_stretches(const StretchFrame<Q>& f, bool displacement, Scalar* out) {
  for (int i = 0; i < Q; ++i) store(out + i * kWidth, displacement ? f.strain[i] : f.svd.s[i]);
}

// Entry c of right singular vector i.
inline Real right_entry(const Svd3& f, int i, int c) { return c == 0 ? f.v[i].x : c == 1 ? f.v[i].y : f.v[i].z; }
inline Real right_entry(const Svd2& f, int i, int c) { return f.v[i][c]; }
inline Real right_entry(const Svd1&, int, int) { return splat(1); }

// dpsi/dF = sum of dpsi/ds_i u_i v_i', column by column.
template <int Q>
inline void gradient_from_stretches(const Svd<Q>& f, const Scalar* by_stretch, Scalar* gradient) {
  Real g[Q];
  for (int i = 0; i < Q; ++i) g[i] = load(by_stretch + i * kWidth);
  for (int c = 0; c < Q; ++c) {
    Vector column = (g[0] * right_entry(f, 0, c)) * f.u[0];
    for (int i = 1; i < Q; ++i) column = column + (g[i] * right_entry(f, i, c)) * f.u[i];
    store(gradient + (3L * c) * kWidth, column.x);
    store(gradient + (3L * c + 1) * kWidth, column.y);
    store(gradient + (3L * c + 2) * kWidth, column.z);
  }
}

template <class Entries, int Q>
struct StretchKernel {
  const Entries& entries;
  const bool displacement;
  const Scalar* e;
  const Scalar* u;

  void value(const Scalar* q, Scalar* value, Scalar* margin) const {
    alignas(64) Scalar s[Q * kWidth];
    store_stretches<Q>(stretch_frame<Q>(q, displacement), displacement, s);
    entries.value(s, e, u, value, margin);
  }

  void gradient(const Scalar* q, Scalar* value, Scalar* by_q) const {
    gradient_at(stretch_frame<Q>(q, displacement), value, by_q);
  }

  // The Hessian as in projection.h, and the lanes in which projection changed it.
  unsigned hessian(const Scalar* q, bool project, Negative mode, Scalar* value, Scalar* by_q, Scalar* packed) const {
    const StretchFrame<Q> f = stretch_frame<Q>(q, displacement);
    gradient_at(f, value, by_q);
    alignas(64) Scalar s[Q * kWidth], blocks[IsotropicHessian<Q>::kBlocks * kWidth];
    store_stretches<Q>(f, false, s);
    entries.principal(s, e, u, blocks);
    IsotropicHessian<Q> h(blocks);
    const unsigned changed = project ? project_isotropic(h, mode) : 0;
    rotate_isotropic(f.svd, h, packed);
    return changed;
  }

 private:
  void gradient_at(const StretchFrame<Q>& f, Scalar* value, Scalar* by_q) const {
    alignas(64) Scalar s[Q * kWidth], by_stretch[Q * kWidth];
    store_stretches<Q>(f, displacement, s);
    entries.gradient(s, e, u, value, by_stretch);
    gradient_from_stretches<Q>(f.svd, by_stretch, by_q);
  }
};

}  // namespace
}  // namespace ergon::lanes
