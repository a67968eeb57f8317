#pragma once
// The Hessian of an isotropic density from the function g(s0, s1, s2) of the singular values that it is: projection of
// its blocks and rotation to the frame of F. Included only by files in runtime/lanes.
//
// Source: Smith, de Goes, Kim 2019, Analytic eigensystems for isotropic distortion energies, TOG 38(1).
// With F = U diag(s) V' and E(i, j) = u[i] v[j]', the Hessian is
//   stretch: sum over i, j of g_ij E(i, i) E(j, j)', g_ij the second derivatives of g;
//   twist:   eigenvector (E(i, j) - E(j, i))/sqrt(2), eigenvalue (g_i + g_j)/(s_i + s_j);
//   flip:    eigenvector (E(i, j) + E(j, i))/sqrt(2), eigenvalue (g_i - g_j)/(s_i - s_j), g_ii - g_ij where s_i = s_j.

#include "runtime/lanes/projection.h"
#include "runtime/lanes/svd3.h"

namespace ergon::lanes {
namespace {

struct IsotropicHessian {
  Real stretch[6];  // packed: g_00, g_10, g_11, g_20, g_21, g_22
  Real twist[3];    // [k] belongs to the two axes other than k
  Real flip[3];
};

// Returns the lanes in which something was changed. Entries that are not finite stay as they are.
inline unsigned project_isotropic(IsotropicHessian& h, Negative mode) {
  alignas(64) double packed[6 * kWidth];
  for (int i = 0; i < 6; ++i) store(packed + i * kWidth, h.stretch[i]);
  unsigned changed = ~definite<3>(packed) & kAllLanes;
  if (changed != 0) {
    project_lanes<3>(packed, mode, changed);
    for (int i = 0; i < 6; ++i) h.stretch[i] = load(packed + i * kWidth);
  }
  const double factor = mode == Negative::clamp ? 0.0 : -1.0;
#pragma GCC unroll 3
  for (int k = 0; k < 3; ++k) {
    const Mask twist = less(h.twist[k], splat(0)), flip = less(h.flip[k], splat(0));
    h.twist[k] = select(twist, factor * h.twist[k], h.twist[k]);
    h.flip[k] = select(flip, factor * h.flip[k], h.flip[k]);
    changed |= bits(either(twist, flip));
  }
  return changed;
}

// Writes the 9x9 Hessian with respect to F, column by column, packed as in projection.h.
// Its 3x3 block of columns c and d of F is U K U' with K_ij = g_ij v_i[c] v_j[d] + b_ij v_j[c] v_i[d] off the diagonal
// and K_ii = g_ii v_i[c] v_i[d] + sum over j of a_ij v_j[c] v_j[d], a and b half the sum and the difference of flip and
// twist.
inline void rotate_isotropic(const Svd3& f, const IsotropicHessian& h, double* packed) {
  const Real u[3][3] = {{f.u[0].x, f.u[0].y, f.u[0].z}, {f.u[1].x, f.u[1].y, f.u[1].z}, {f.u[2].x, f.u[2].y, f.u[2].z}};
  const Real v[3][3] = {{f.v[0].x, f.v[0].y, f.v[0].z}, {f.v[1].x, f.v[1].y, f.v[1].z}, {f.v[2].x, f.v[2].y, f.v[2].z}};
  Real a[3], b[3];
#pragma GCC unroll 3
  for (int k = 0; k < 3; ++k) {
    a[k] = 0.5 * (h.flip[k] + h.twist[k]);
    b[k] = 0.5 * (h.flip[k] - h.twist[k]);
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
  }
}

}  // namespace
}  // namespace ergon::lanes
