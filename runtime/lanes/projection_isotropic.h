#pragma once
// The Hessian of an isotropic density from the function g of the singular values that it is: projection of its blocks
// and rotation to the frame of F. Included only by files in runtime/lanes.
//
// Source: Smith, de Goes, Kim 2019, Analytic eigensystems for isotropic distortion energies, TOG 38(1).
// With F = U diag(s) V' and E(i, j) = u[i] v[j]', the Hessian is
//   stretch: sum over i, j of g_ij E(i, i) E(j, j)', g_ij the second derivatives of g;
//   twist:   eigenvector (E(i, j) - E(j, i))/sqrt(2), eigenvalue (g_i + g_j)/(s_i + s_j);
//   flip:    eigenvector (E(i, j) + E(j, i))/sqrt(2), eigenvalue (g_i - g_j)/(s_i - s_j), g_ii - g_ij where s_i = s_j;
//   normal:  eigenvector n v[i]' for a unit vector n normal to all u[i] (F of 3x2 and 3x1), eigenvalue g_i/s_i.

#include "runtime/lanes/projection.h"
#include "runtime/lanes/svd3.h"
#include "runtime/lanes/svd_flat.h"

namespace ergon::lanes {
namespace {

// Q columns of F. Blocks are in the order of codegen/principal.h.
template <int Q>
struct IsotropicHessian {
  static constexpr int kStretch = Q * (Q + 1) / 2;
  static constexpr int kTwists = Q * (Q - 1) / 2;
  static constexpr int kNormals = Q == 3 ? 0 : Q;
  static constexpr int kBlocks = kStretch + 2 * kTwists + kNormals;

  Real stretch[kStretch];  // packed: g_00, g_10, g_11, ...
  // All twists, all flips, all normals. For a solid number k of the twists belongs to the two axes other than k.
  Real eigenvalue[kBlocks - kStretch];

  explicit IsotropicHessian(const Scalar* blocks) {
    for (int i = 0; i < kStretch; ++i) stretch[i] = load(blocks + i * kWidth);
    for (int i = kStretch; i < kBlocks; ++i) eigenvalue[i - kStretch] = load(blocks + i * kWidth);
  }
  Real twist(int k) const { return eigenvalue[k]; }
  Real flip(int k) const { return eigenvalue[kTwists + k]; }
  Real normal(int i) const { return eigenvalue[2 * kTwists + i]; }
};

template <int Q>
struct SvdOf;
template <>
struct SvdOf<3> {
  using Type = Svd3;
};
template <>
struct SvdOf<2> {
  using Type = Svd2;
};
template <>
struct SvdOf<1> {
  using Type = Svd1;
};
template <int Q>
using Svd = typename SvdOf<Q>::Type;

template <int Q>
inline Svd<Q> decompose(const Vector* f) {
  if constexpr (Q == 3) {
    return svd3(f[0], f[1], f[2]);
  } else if constexpr (Q == 2) {
    return svd2(f[0], f[1]);
  } else {
    return svd1(f[0]);
  }
}

// Returns the lanes in which something was changed. Entries that are not finite stay as they are.
template <int Q>
inline unsigned project_isotropic(IsotropicHessian<Q>& h, Negative mode) {
  using H = IsotropicHessian<Q>;
  alignas(64) Scalar packed[H::kStretch * kWidth];
  for (int i = 0; i < H::kStretch; ++i) store(packed + i * kWidth, h.stretch[i]);
  unsigned changed = ~definite<Q>(packed) & kAllLanes;
  if (changed != 0) {
    project_lanes<Q>(packed, mode, changed);
    for (int i = 0; i < H::kStretch; ++i) h.stretch[i] = load(packed + i * kWidth);
  }
  const Scalar factor = mode == Negative::clamp ? 0 : -1;
#pragma GCC unroll 6
  for (Real& eigenvalue : h.eigenvalue) {
    const Mask negative = less(eigenvalue, splat(0));
    eigenvalue = select(negative, factor * eigenvalue, eigenvalue);
    changed |= bits(negative);
  }
  return changed;
}

// Stores the symmetric 3x3 block U K U' of columns c and d <= c of F; of a diagonal block the lower triangle.
inline void store_rotated(const Real (&u)[3][3], const Real (&k)[3][3], int c, int d, Scalar* packed) {
#pragma GCC unroll 3
  for (int r = 0; r < 3; ++r) {
    Real t[3];
#pragma GCC unroll 3
    for (int j = 0; j < 3; ++j) t[j] = u[0][r] * k[0][j] + u[1][r] * k[1][j] + u[2][r] * k[2][j];
    const int row = 3 * c + r;
#pragma GCC unroll 3
    for (int q = 0; q < 3; ++q) {
      const int column = 3 * d + q;
      if (column > row) continue;
      store(packed + (row * (row + 1) / 2 + column) * kWidth, t[0] * u[0][q] + t[1] * u[1][q] + t[2] * u[2][q]);
    }
  }
}

// The rest writes the Hessian with respect to F, column by column, packed as in projection.h. Its 3x3 block of columns
// c and d of F is U K U' with K_ij = g_ij v_i[c] v_j[d] + b_ij v_j[c] v_i[d] off the diagonal and
// K_ii = g_ii v_i[c] v_i[d] + sum over j of a_ij v_j[c] v_j[d], a and b half the sum and the difference of flip and
// twist; the normal's diagonal entry is the sum over i of normal_i v_i[c] v_i[d].
inline void rotate_isotropic(const Svd3& f, const IsotropicHessian<3>& h, Scalar* packed) {
  const Real u[3][3] = {{f.u[0].x, f.u[0].y, f.u[0].z}, {f.u[1].x, f.u[1].y, f.u[1].z}, {f.u[2].x, f.u[2].y, f.u[2].z}};
  const Real v[3][3] = {{f.v[0].x, f.v[0].y, f.v[0].z}, {f.v[1].x, f.v[1].y, f.v[1].z}, {f.v[2].x, f.v[2].y, f.v[2].z}};
  Real a[3], b[3];
#pragma GCC unroll 3
  for (int k = 0; k < 3; ++k) {
    a[k] = 0.5 * (h.flip(k) + h.twist(k));
    b[k] = 0.5 * (h.flip(k) - h.twist(k));
  }
#pragma GCC unroll 3
  for (int c = 0; c < 3; ++c) {
#pragma GCC unroll 3
    for (int d = 0; d <= c; ++d) {
      Real k[3][3];
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, l = (i + 2) % 3;
        k[i][i] =
            h.stretch[i * (i + 3) / 2] * (v[i][c] * v[i][d]) + a[l] * (v[j][c] * v[j][d]) + a[j] * (v[l][c] * v[l][d]);
#pragma GCC unroll 3
        for (int m = 0; m < 3; ++m) {
          if (m == i) continue;
          const Real g = m < i ? h.stretch[i * (i + 1) / 2 + m] : h.stretch[m * (m + 1) / 2 + i];
          k[i][m] = g * (v[i][c] * v[m][d]) + b[3 - i - m] * (v[m][c] * v[i][d]);
        }
      }
      store_rotated(u, k, c, d, packed);
    }
  }
}

inline void rotate_isotropic(const Svd2& f, const IsotropicHessian<2>& h, Scalar* packed) {
  const Real u[3][3] = {{f.u[0].x, f.u[0].y, f.u[0].z}, {f.u[1].x, f.u[1].y, f.u[1].z}, {f.u[2].x, f.u[2].y, f.u[2].z}};
  const Real a = 0.5 * (h.flip(0) + h.twist(0)), b = 0.5 * (h.flip(0) - h.twist(0)), zero = splat(0);
  for (int c = 0; c < 2; ++c) {
    for (int d = 0; d <= c; ++d) {
      const Real v00 = f.v[0][c] * f.v[0][d], v11 = f.v[1][c] * f.v[1][d];
      const Real v01 = f.v[0][c] * f.v[1][d], v10 = f.v[1][c] * f.v[0][d];
      const Real k[3][3] = {{h.stretch[0] * v00 + a * v11, h.stretch[1] * v01 + b * v10, zero},
                            {h.stretch[1] * v10 + b * v01, h.stretch[2] * v11 + a * v00, zero},
                            {zero, zero, h.normal(0) * v00 + h.normal(1) * v11}};
      store_rotated(u, k, c, d, packed);
    }
  }
}

inline void rotate_isotropic(const Svd1& f, const IsotropicHessian<1>& h, Scalar* packed) {
  const Real u[3] = {f.u[0].x, f.u[0].y, f.u[0].z};
  const Real along = h.stretch[0] - h.normal(0);
  for (int r = 0; r < 3; ++r) {
    for (int q = 0; q <= r; ++q) {
      const Real outer = along * u[r] * u[q];
      store(packed + (r * (r + 1) / 2 + q) * kWidth, r == q ? outer + h.normal(0) : outer);
    }
  }
}

}  // namespace
}  // namespace ergon::lanes
