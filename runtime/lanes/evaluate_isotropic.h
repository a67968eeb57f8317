#pragma once
// The projected Hessian of an isotropic density by its closed form, block by block. Included only by files in
// runtime/lanes.

#include "runtime/lanes/evaluate_frame.h"
#include "runtime/lanes/projection_isotropic.h"

namespace ergon::lanes {
namespace {

inline Vector column_of(const Scalar* f, int column) {
  f += 3L * column * kWidth;
  return {load(f), load(f + kWidth), load(f + 2 * kWidth)};
}

// F from q; `displacement`: q is F - I.
template <int Q>
inline void deformation(const Scalar* q, bool displacement, Vector* f) {
  for (int c = 0; c < Q; ++c) f[c] = column_of(q, c);
  if (!displacement) return;
  f[0].x += 1;
  if (Q > 1) f[1].y += 1;
  if (Q > 2) f[2].z += 1;
}

// Hessian of the density at q, projected, packed as in projection.h, in the axes of space. Returns in how many of the
// first `count` lanes something was changed.
template <class S>
inline int closed_form_hessian(const Stencils& s, int block, int quadrature, int count, const Frame<S>& frame,
                               const Scalar* q, Negative mode, Scalar* packed) {
  if constexpr (!S::kDensity) return 0;
  constexpr int Q = S::kDensity ? S::kVectors : 1;
  Vector f[Q];
  deformation<Q>(q, s.kernel->displacement != 0, f);
  alignas(64) Scalar stretch[Q * kWidth], blocks[IsotropicHessian<Q>::kBlocks * kWidth];
  Svd<Q> svd = decompose<Q>(f);
  for (int i = 0; i < Q; ++i) store(stretch + i * kWidth, svd.s[i]);
  entries_of(s).principal(stretch, data_of(s, block, quadrature), uniforms_of(s), blocks);
  IsotropicHessian<Q> h(blocks);
  const unsigned changed = project_isotropic(h, mode) & ((1u << count) - 1);
  if (frame.turns()) {
    for (Vector& axis : svd.u) frame.to_space(axis);
  }
  rotate_isotropic(svd, h, packed);
  return __builtin_popcount(changed);
}

}  // namespace
}  // namespace ergon::lanes
