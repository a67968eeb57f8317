#pragma once
// The projection of 1x1, 2x2 and 3x3 matrices in closed form, without branches.

#include "runtime/lanes/projection_isolated.h"
#include "runtime/lanes/projection_vector.h"

namespace ergon::lanes {
namespace {

inline void project_1(Scalar* packed, bool absolute, unsigned lanes) {
  const Real a = load(packed);
  const Mask negative = both(from_bits(lanes), both(less(a, splat(0)), less(splat(-__builtin_inf()), a)));
  store(packed, select(negative, absolute ? -a : splat(0), a));
}

// What projection adds to a 2x2 matrix, for Negative::clamp. A = m I + S with S = [d b; b -d], S^2 = r^2 I: the
// eigenvalues are m + r and m - r with projectors (I + S/r)/2 and (I - S/r)/2.
struct Change {
  Real c00, c10, c11;
};

inline Change projection_change(Real a00, Real a10, Real a11) {
  const Real m = 0.5 * (a00 + a11), d = 0.5 * (a00 - a11), r = sqrt(d * d + a10 * a10);
  const Mask positive = less_equal(r, m), negative = less_equal(r, -m);
  const Real over_r = 1 / select(negative, splat(1), max(r, splat(kNegligible)));
  const Real g = 0.5 * (r - m);
  Change c{g * (1 - d * over_r), -g * (a10 * over_r), g * (1 + d * over_r)};
  c = {select(negative, -a00, c.c00), select(negative, -a10, c.c10), select(negative, -a11, c.c11)};
  return {select(positive, splat(0), c.c00), select(positive, splat(0), c.c10), select(positive, splat(0), c.c11)};
}

inline void project_2(Scalar* packed, bool absolute, unsigned lanes) {
  const Real a00 = load(packed), a10 = load(packed + kWidth), a11 = load(packed + 2 * kWidth);
  const Real largest = max(max(abs(a00), abs(a11)), abs(a10));
  const Real sum = abs(a00) + abs(a11) + abs(a10);  // not finite if an entry is not
  const Mask chosen = both(from_bits(lanes), less(sum, splat(__builtin_inf())));
  const Real size = max(largest, splat(kNegligible));
  const Real scale = 1 / size;
  const Change c = projection_change(a00 * scale, a10 * scale, a11 * scale);
  const Real factor = size * Scalar(absolute ? 2 : 1);
  store(packed, select(chosen, a00 + factor * c.c00, a00));
  store(packed + kWidth, select(chosen, a10 + factor * c.c10, a10));
  store(packed + 2 * kWidth, select(chosen, a11 + factor * c.c11, a11));
}

// By the isolated eigenvector v, which leaves a 2x2 matrix on its complement.
inline void project_3(Scalar* packed, bool absolute, unsigned lanes) {
  Real entry[6];
  Real largest = splat(0), sum = splat(0);
#pragma GCC unroll 6
  for (int i = 0; i < 6; ++i) {
    entry[i] = load(packed + i * kWidth);
    largest = max(abs(entry[i]), largest);
    sum += abs(entry[i]);
  }
  const Mask chosen = both(from_bits(lanes), less(sum, splat(__builtin_inf())));
  const Real size = max(largest, splat(kNegligible));
  const Real scale = 1 / size;
  const Symmetric a{entry[0] * scale, entry[1] * scale, entry[2] * scale,
                    entry[3] * scale, entry[4] * scale, entry[5] * scale};
  const Vector v = isolated_eigenvector(a).v;
  Vector w, y;
  frame(v, w, y);
  const Real change = max(-dot(v, a * v), splat(0));
  const Vector aw = a * w;
  const Change c = projection_change(dot(w, aw), dot(y, aw), dot(y, a * y));
  const Real factor = size * Scalar(absolute ? 2 : 1);
  const Vector p = (factor * change) * v;
  const Vector q = (factor * c.c00) * w + (factor * c.c10) * y;
  const Vector r = (factor * c.c10) * w + (factor * c.c11) * y;
  const Real added[6] = {p.x * v.x + q.x * w.x + r.x * y.x, p.y * v.x + q.y * w.x + r.y * y.x,
                         p.y * v.y + q.y * w.y + r.y * y.y, p.z * v.x + q.z * w.x + r.z * y.x,
                         p.z * v.y + q.z * w.y + r.z * y.y, p.z * v.z + q.z * w.z + r.z * y.z};
#pragma GCC unroll 6
  for (int i = 0; i < 6; ++i) store(packed + i * kWidth, select(chosen, entry[i] + added[i], entry[i]));
}

}  // namespace
}  // namespace ergon::lanes
