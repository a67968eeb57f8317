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

// s - 1 of the eigenvalue l = s^2 - 1.
inline Real strain_of(Real l) { return l / (1 + sqrt(1 + l)); }

// Where F is the first columns of I + G and |G| is small: the right singular vectors are the eigenvectors of
// F'F - I = G + G' + G'G, which keeps the digits of G. In space two steps as in svd3: an isolated eigenvector, then a
// rotation of its complement.
inline StretchFrame<3> frame_near_rest(const Vector (&g)[3]) {
  const Symmetric e{2 * g[0].x + dot(g[0], g[0]),      g[0].y + g[1].x + dot(g[0], g[1]), 2 * g[1].y + dot(g[1], g[1]),
                    g[0].z + g[2].x + dot(g[0], g[2]), g[1].z + g[2].y + dot(g[1], g[2]), 2 * g[2].z + dot(g[2], g[2])};
  Real size = max(max(abs(e.a00), abs(e.a10)), max(abs(e.a11), abs(e.a20)));
  size = max(max(max(abs(e.a21), abs(e.a22)), size), splat(kNegligible));
  const Real scale = 1 / size;
  const Symmetric n{scale * e.a00, scale * e.a10, scale * e.a11, scale * e.a20, scale * e.a21, scale * e.a22};
  Vector v[3];
  const Isolated isolated = isolated_eigenvector(n);
  v[0] = isolated.v;
  frame(v[0], v[1], v[2]);
  const Vector n1 = n * v[1], n2 = n * v[2];
  const PlaneTurn turn = plane_turn(dot(v[1], n1) - dot(v[2], n2), 2 * dot(v[1], n2));
  const Vector v1 = turn.c * v[1] + turn.s * v[2], v2 = turn.c * v[2] + (-turn.s) * v[1];
  const Mask highest = isolated.highest;
  StretchFrame<3> out;
  out.svd.v[0] = select(highest, v[0], v1);
  out.svd.v[1] = select(highest, v1, v2);
  out.svd.v[2] = select(highest, v2, v[0]);
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    const Vector& w = out.svd.v[i];
    out.strain[i] = strain_of(dot(w, e * w));
    out.svd.s[i] = 1 + out.strain[i];
    out.svd.u[i] = (1 / out.svd.s[i]) * (w + (w.x * g[0] + w.y * g[1] + w.z * g[2]));  // F v/s
  }
  return out;
}

inline StretchFrame<2> frame_near_rest(const Vector (&g)[2]) {
  const Real e00 = 2 * g[0].x + dot(g[0], g[0]), e10 = g[0].y + g[1].x + dot(g[0], g[1]),
             e11 = 2 * g[1].y + dot(g[1], g[1]);
  const Real scale = 1 / max(max(abs(e00), abs(e10)), max(abs(e11), splat(kNegligible)));
  const PlaneTurn turn = plane_turn(scale * (e00 - e11), 2 * scale * e10);
  StretchFrame<2> out;
  const Real v[2][2] = {{turn.c, turn.s}, {-turn.s, turn.c}};
#pragma GCC unroll 2
  for (int i = 0; i < 2; ++i) {
    const Real a = v[i][0], b = v[i][1];
    out.svd.v[i][0] = a;
    out.svd.v[i][1] = b;
    out.strain[i] = strain_of(a * a * e00 + 2 * (a * b) * e10 + b * b * e11);
    out.svd.s[i] = 1 + out.strain[i];
    out.svd.u[i] = (1 / out.svd.s[i]) * (Vector{a, b, splat(0)} + (a * g[0] + b * g[1]));
  }
  out.svd.u[2] = cross(out.svd.u[0], out.svd.u[1]);
  return out;
}

inline StretchFrame<1> frame_near_rest(const Vector (&g)[1]) {
  StretchFrame<1> out;
  out.strain[0] = strain_of(2 * g[0].x + dot(g[0], g[0]));
  out.svd.s[0] = 1 + out.strain[0];
  out.svd.u[0] = (1 / out.svd.s[0]) * Vector{1 + g[0].x, g[0].y, g[0].z};
  frame(out.svd.u[0], out.svd.u[1], out.svd.u[2]);
  return out;
}

inline void choose(Mask near, const Svd3& far, Svd3& out) {
  for (int i = 0; i < 3; ++i) out.v[i] = select(near, out.v[i], far.v[i]);
}
inline void choose(Mask near, const Svd2& far, Svd2& out) {
  for (int i = 0; i < 4; ++i) out.v[i / 2][i % 2] = select(near, out.v[i / 2][i % 2], far.v[i / 2][i % 2]);
}
inline void choose(Mask, const Svd1&, Svd1&) {}

// Of q: F, or G where `displacement` is set.
template <int Q>
inline StretchFrame<Q> stretch_frame(const Scalar* q, bool displacement) {
  StretchFrame<Q> out;
  Vector f[Q];
  Mask near = less(splat(1), splat(0));
  unsigned lanes = 0;
  if (displacement) {
    Vector g[Q];
    Real squares = splat(0);
    for (int c = 0; c < Q; ++c) {
      g[c] = column_of(q, c);
      squares += dot(g[c], g[c]);
    }
    near = less(squares, splat(kNearRest));
    lanes = bits(near) & kAllLanes;
    if (lanes != 0) out = frame_near_rest(g);
    if (lanes == kAllLanes) return out;
  }
  deformation<Q>(q, displacement, f);
  const Svd<Q> far = decompose<Q>(f);
  if (lanes == 0) {
    out.svd = far;
    for (int i = 0; i < Q; ++i) out.strain[i] = far.s[i] - 1;
    return out;
  }
  for (int i = 0; i < 3; ++i) out.svd.u[i] = select(near, out.svd.u[i], far.u[i]);
  choose(near, far, out.svd);
  for (int i = 0; i < Q; ++i) {
    out.svd.s[i] = select(near, out.svd.s[i], far.s[i]);
    out.strain[i] = select(near, out.strain[i], far.s[i] - 1);
  }
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
