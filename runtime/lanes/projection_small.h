#pragma once
// The projection of 1x1 and 2x2 matrices in closed form.

#include "runtime/lanes/projection_vector.h"

namespace ergon::lanes {
namespace {

inline void project_1(double* packed, bool absolute, unsigned lanes) {
  const Real a = load(packed);
  const Mask negative = both(from_bits(lanes), both(less(a, splat(0)), less(splat(-__builtin_inf()), a)));
  store(packed, select(negative, absolute ? -a : splat(0), a));
}

// A = m I + S with S = [d b; b -d], S^2 = r^2 I: the eigenvalues are m + r and m - r with projectors (I + S/r)/2, (I -
// S/r)/2.
inline void project_2(double* packed, bool absolute, unsigned lanes) {
  const Real a00 = load(packed), a10 = load(packed + kWidth), a11 = load(packed + 2 * kWidth);
  const Real largest = max(max(abs(a00), abs(a11)), abs(a10));
  const Real sum = abs(a00) + abs(a11) + abs(a10);  // not finite if an entry is not
  const Real size = max(largest, splat(1e-290));
  const Real scale = 1 / size;
  const Real m = 0.5 * scale * a00 + 0.5 * scale * a11, d = 0.5 * scale * a00 - 0.5 * scale * a11, b = a10 * scale;
  const Real r = sqrt(d * d + b * b);
  const Mask changed = both(from_bits(lanes), both(less(m, r), less(sum, splat(__builtin_inf()))));
  const Mask all_negative = less_equal(r, -m);
  const Real over_r = 1 / select(all_negative, splat(1), r);
  Real p00, p10, p11;
  if (absolute) {
    const Real f = m * over_r;
    p00 = select(all_negative, -a00, size * (r + f * d));
    p11 = select(all_negative, -a11, size * (r - f * d));
    p10 = select(all_negative, -a10, size * (f * b));
  } else {
    const Real f = select(all_negative, splat(0), 0.5 * size * (m + r));
    p00 = f * (1 + d * over_r);
    p11 = f * (1 - d * over_r);
    p10 = f * (b * over_r);
  }
  store(packed, select(changed, p00, a00));
  store(packed + kWidth, select(changed, p10, a10));
  store(packed + 2 * kWidth, select(changed, p11, a11));
}

}  // namespace
}  // namespace ergon::lanes
