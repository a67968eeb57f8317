#pragma once
// Tensor operations in terms of an algebra's scalars, each written once. Every scalar operation is a statement of its
// own where order matters: C++ leaves the order of arguments open, and the same text must give the same sequence.

#include <string>
#include <utility>
#include <vector>

#include "symbolic/functions.h"
#include "symbolic/tensor.h"

namespace ergon {

template <class A>
class TensorOperations {
 public:
  using S = typename A::Scalar;
  using T = Tensor<S>;

  explicit TensorOperations(A& algebra) : a_(algebra) {}

  static T scalar(S s) { return {{1, 1}, {std::move(s)}}; }

  T negate(const T& t) {
    T r{t.shape, {}};
    for (const S& s : t.at) r.at.push_back(a_.negate(s));
    return r;
  }

  T add(const T& x, const T& y) {
    T r{x.shape, {}};
    for (size_t i = 0; i < x.at.size(); ++i) r.at.push_back(a_.add(x.at[i], y.at[i]));
    return r;
  }

  T subtract(const T& x, const T& y) {
    T r{x.shape, {}};
    for (size_t i = 0; i < x.at.size(); ++i) r.at.push_back(a_.subtract(x.at[i], y.at[i]));
    return r;
  }

  T multiply(const T& x, const T& y) {
    if (x.shape.scalar()) return scaled(y, [&](const S& s) { return a_.multiply(x.at[0], s); });
    if (y.shape.scalar()) return scaled(x, [&](const S& s) { return a_.multiply(s, y.at[0]); });
    T r{{x.shape.rows, y.shape.cols}, {}};
    for (int j = 0; j < y.shape.cols; ++j) {
      for (int i = 0; i < x.shape.rows; ++i) {
        S sum = a_.multiply(x(i, 0), y(0, j));
        for (int k = 1; k < x.shape.cols; ++k) {
          const S product = a_.multiply(x(i, k), y(k, j));
          sum = a_.add(sum, product);
        }
        r.at.push_back(sum);
      }
    }
    return r;
  }

  T divide(const T& x, const S& by) {
    return scaled(x, [&](const S& s) { return a_.divide(s, by); });
  }

  T transpose(const T& x) {
    T r{{x.shape.cols, x.shape.rows}, {}};
    for (int j = 0; j < r.shape.cols; ++j)
      for (int i = 0; i < r.shape.rows; ++i) r.at.push_back(x(j, i));
    return r;
  }

  T column(const T& x, int j) {
    const auto first = x.at.begin() + j * x.shape.rows;
    return {{x.shape.rows, 1}, std::vector<S>(first, first + x.shape.rows)};
  }

  T columns(const std::vector<T>& vectors) {
    T r{{vectors[0].shape.rows, static_cast<int>(vectors.size())}, {}};
    for (const T& v : vectors) r.at.insert(r.at.end(), v.at.begin(), v.at.end());
    return r;
  }

  T identity(int n) {
    const S zero = a_.number("0");
    const S one = a_.number("1");
    T r{{n, n}, std::vector<S>(static_cast<size_t>(n) * n, zero)};
    for (int i = 0; i < n; ++i) r.at[static_cast<size_t>(i) * (n + 1)] = one;
    return r;
  }

  S dot(const T& x, const T& y) {
    S sum = a_.multiply(x.at[0], y.at[0]);
    for (size_t i = 1; i < x.at.size(); ++i) {
      const S product = a_.multiply(x.at[i], y.at[i]);
      sum = a_.add(sum, product);
    }
    return sum;
  }

  S norm2(const T& x) { return dot(x, x); }
  S norm(const T& x) { return a_.call(Function::sqrt, {norm2(x)}); }

  T cross(const T& x, const T& y) {
    T r{{3, 1}, {}};
    for (int i = 0; i < 3; ++i)
      r.at.push_back(minor_of(x((i + 1) % 3), x((i + 2) % 3), y((i + 1) % 3), y((i + 2) % 3)));
    return r;
  }

  T outer(const T& x, const T& y) {
    T r{{x.shape.rows, y.shape.rows}, {}};
    for (const S& right : y.at)
      for (const S& left : x.at) r.at.push_back(a_.multiply(left, right));
    return r;
  }

  S trace(const T& x) {
    S sum = x(0, 0);
    for (int i = 1; i < x.shape.rows; ++i) sum = a_.add(sum, x(i, i));
    return sum;
  }

  // 2x2 and 3x3, by cofactors of the first column.
  S determinant(const T& x) {
    if (x.shape.rows == 2) return minor_of(x(0, 0), x(1, 0), x(0, 1), x(1, 1));
    return dot(column(x, 0), cross(column(x, 1), column(x, 2)));
  }

  // 2x2 and 3x3, by cofactors.
  T inverse(const T& x) {
    if (x.shape.rows == 2) {
      const S det = determinant(x);
      const S upper = a_.negate(x(0, 1));
      const S lower = a_.negate(x(1, 0));
      return divide({x.shape, {x(1, 1), lower, upper, x(0, 0)}}, det);
    }
    const T c0 = column(x, 0), c1 = column(x, 1), c2 = column(x, 2);
    const T r0 = cross(c1, c2);
    const T r1 = cross(c2, c0);
    const T r2 = cross(c0, c1);
    const S det = dot(c0, r0);
    return divide(transpose(columns({r0, r1, r2})), det);
  }

  T symmetric_part(const T& x) {
    T r = x;
    const int n = x.shape.rows;
    const S half = a_.number("0.5");
    for (int j = 0; j < n; ++j) {
      for (int i = j + 1; i < n; ++i) {
        const S sum = a_.add(x(i, j), x(j, i));
        const S mean = a_.multiply(half, sum);
        r.at[static_cast<size_t>(j * n + i)] = mean;
        r.at[static_cast<size_t>(i * n + j)] = mean;
      }
    }
    return r;
  }

  // x - tr(x)/n I
  T deviator(const T& x) {
    const int n = x.shape.rows;
    const S tr = trace(x);
    const S size = a_.number(std::to_string(n));
    const S mean = a_.divide(tr, size);
    T r = x;
    for (int i = 0; i < n; ++i) r.at[static_cast<size_t>(i) * (n + 1)] = a_.subtract(x(i, i), mean);
    return r;
  }

  // The angle between the triangles (p0, p1, p2) and (p1, p0, p3) over their common edge p0p1: 0 when flat, and
  // positive when p3 lies below the plane of the first triangle, seen from the side its normal cross(p1 - p0, p2 - p0)
  // points to (a ridge on that side). With e = p1 - p0, n0 = cross(e, p2 - p0) and n1 = cross(p3 - p0, e) it is
  // atan2(dot(cross(n0, n1), e)/|e|, dot(n0, n1)), where dot(cross(n0, n1), e) = -|e|^2 dot(n0, p3 - p0).
  S dihedral(const T& p0, const T& p1, const T& p2, const T& p3) {
    const T e = subtract(p1, p0);
    const T a = subtract(p2, p0);
    const T b = subtract(p3, p0);
    const T n0 = cross(e, a);
    const T n1 = cross(b, e);
    const S height = dot(n0, b);
    const S below = a_.negate(height);
    const S length = norm(e);
    const S sine = a_.multiply(length, below);
    const S cosine = dot(n0, n1);
    return a_.call(Function::atan2, {sine, cosine});
  }

 private:
  template <class F>
  static T scaled(const T& t, F&& scale) {
    T r{t.shape, {}};
    for (const S& s : t.at) r.at.push_back(scale(s));
    return r;
  }

  // | a c |
  // | b d |
  S minor_of(const S& a, const S& b, const S& c, const S& d) {
    const S main = a_.multiply(a, d);
    const S other = a_.multiply(b, c);
    return a_.subtract(main, other);
  }

  A& a_;
};

}  // namespace ergon
