#pragma once
// Singular value decomposition F = sum of s_i u_i v_i' of a 3x3, 3x2 or 3x1 matrix over any real numbers, by one-sided
// Jacobi rotations (Hestenes 1958, Inversion of matrices by biorthogonalization and related results, J. SIAM 6(1)):
// every singular value has the relative accuracy of the numbers. U and V are rotations, so that of a 3x3 matrix the
// smallest singular value has the sign of det(F), as in runtime/lanes/svd3.h.

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace ergon {

template <class N>
using Triple = std::array<N, 3>;

template <class N>
struct Decomposed {
  std::vector<N> s;          // descending; as many as F has columns
  std::vector<Triple<N>> u;  // always three: those without a singular value are normal to the columns of F
  std::vector<Triple<N>> v;  // as many as singular values; entries beyond the columns of F are zero
};

namespace singular {

template <class N>
N dot(const Triple<N>& a, const Triple<N>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class N>
Triple<N> cross(const Triple<N>& a, const Triple<N>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class N>
void turn(Triple<N>& a, Triple<N>& b, const N& c, const N& s) {
  for (size_t i = 0; i < 3; ++i) {
    const N left = c * a[i] - s * b[i];
    b[i] = s * a[i] + c * b[i];
    a[i] = left;
  }
}

// A unit vector normal to the unit vector a.
template <class N>
Triple<N> normal_to(const Triple<N>& a, const N& one) {
  using std::abs;
  using std::sqrt;
  size_t least = 0;
  for (size_t i = 1; i < 3; ++i)
    if (abs(a[i]) < abs(a[least])) least = i;
  Triple<N> axis = {one - one, one - one, one - one};
  axis[least] = one;
  Triple<N> n = cross(a, axis);
  const N length = sqrt(dot(n, n));
  for (N& x : n) x = x / length;
  return n;
}

}  // namespace singular

// `f` column by column; `rounding` is the relative rounding of the numbers, `one` the number 1.
template <class N>
Decomposed<N> decompose(const std::vector<N>& f, const N& one, const N& rounding) {
  using std::abs;
  using std::sqrt;
  const size_t n = f.size() / 3;
  const N zero = one - one;
  std::vector<Triple<N>> a, v;
  for (size_t j = 0; j < n; ++j) {
    a.push_back({f[3 * j], f[3 * j + 1], f[3 * j + 2]});
    v.push_back({zero, zero, zero});
    v[j][j] = one;
  }
  bool turned = n > 1;
  for (int sweep = 0; sweep < 60 && turned; ++sweep) {
    turned = false;
    for (size_t p = 0; p + 1 < n; ++p) {
      for (size_t q = p + 1; q < n; ++q) {
        const N pp = singular::dot(a[p], a[p]), qq = singular::dot(a[q], a[q]), pq = singular::dot(a[p], a[q]);
        if (!(abs(pq) > rounding * sqrt(pp) * sqrt(qq))) continue;
        turned = true;
        const N zeta = (qq - pp) / (pq + pq);
        const N size = one / (abs(zeta) + sqrt(one + zeta * zeta));
        const N t = zeta < zero ? -size : size, c = one / sqrt(one + t * t), s = c * t;
        singular::turn(a[p], a[q], c, s);
        singular::turn(v[p], v[q], c, s);
      }
    }
  }
  for (size_t p = 0; p + 1 < n; ++p) {  // descending; an exchange with one change of sign is a rotation
    for (size_t q = n - 1; q > p; --q) {
      if (!(singular::dot(a[q - 1], a[q - 1]) < singular::dot(a[q], a[q]))) continue;
      std::swap(a[q - 1], a[q]);
      std::swap(v[q - 1], v[q]);
      for (size_t i = 0; i < 3; ++i) a[q][i] = -a[q][i], v[q][i] = -v[q][i];
    }
  }
  Decomposed<N> out;
  out.v = v;
  for (size_t j = 0; j < 3; ++j) {
    if (j == 2) {
      out.u.push_back(singular::cross(out.u[0], out.u[1]));
      if (n == 3) out.s.push_back(singular::dot(out.u[2], a[2]));
      break;
    }
    const N length = j < n ? N(sqrt(singular::dot(a[j], a[j]))) : zero;
    if (length > zero)
      out.u.push_back({a[j][0] / length, a[j][1] / length, a[j][2] / length});
    else
      out.u.push_back(j == 0 ? Triple<N>{one, zero, zero} : singular::normal_to(out.u[0], one));
    if (j < n) out.s.push_back(length);
  }
  return out;
}

// Decimals of a fixed matrix in general position. A little of it added to F takes singular values apart that are equal,
// zero or opposite: their own derivatives are not finite there, while those of a smooth function of all of them are.
inline constexpr double general_position[9] = {0.31, -0.87, 0.44, 0.59, 0.73, -0.26, -0.64, 0.18, -0.95};

}  // namespace ergon
