#pragma once
// The natural cubic spline through a table, in terms of an algebra's scalars: the interpolant with two continuous
// derivatives whose second derivative is zero at both ends, beyond which it goes on straight.
// Source: de Boor 2001, A Practical Guide to Splines, revised ed., Chapter IV, cubic spline interpolation.
//
// It is a sum over the intervals of what each adds from its left end to x, with x clamped to the interval. There are no
// branches in it, nothing cancels beyond what the values do, and at every x all intervals but one have the slope 0, at
// knots as well: where max(knot, x) and min(.., next knot) have equal arguments, either all take the first or all the
// second.

#include <string>
#include <vector>

#include "symbolic/functions.h"

namespace ergon {

template <class A>
class NaturalSpline {
 public:
  using S = typename A::Scalar;

  // At least two knots, ascending numbers, and as many values.
  NaturalSpline(A& algebra, const std::vector<S>& knots, const std::vector<S>& values)
      : a_(algebra), knots_(knots), values_(values) {
    for (size_t i = 0; i + 1 < knots.size(); ++i) {
      width_.push_back(a_.subtract(knots[i + 1], knots[i]));
      const S rise = a_.subtract(values[i + 1], values[i]);
      chord_.push_back(a_.divide(rise, width_[i]));
    }
    find_curvatures();
  }

  S at(const S& x) {
    const size_t intervals = width_.size();
    S sum = values_[0];
    for (size_t i = 0; i < intervals; ++i) {
      const S above = i == 0 ? x : a_.call(Function::max, {knots_[i], x});
      const S clamped = a_.call(Function::min, {above, knots_[i + 1]});
      const S from_left = a_.subtract(clamped, knots_[i]);
      sum = a_.add(sum, increment(i, from_left));
    }
    const S beyond = a_.call(Function::max, {a_.number("0"), a_.subtract(x, knots_[intervals])});
    const S bend = a_.multiply(width_[intervals - 1], curvature_[intervals - 1]);
    const S slope = a_.add(chord_[intervals - 1], a_.divide(bend, a_.number("6")));
    const S end = a_.multiply(slope, beyond);
    return a_.add(sum, end);
  }

 private:
  // Of the first interval goes on straight to the left, where `t` is negative.
  S increment(size_t i, const S& t) {
    const S six = a_.number("6");
    const S two = a_.number("2");
    const S& left = curvature_[i];
    const S& right = curvature_[i + 1];
    const S twice = a_.multiply(two, left);
    const S both = a_.add(twice, right);
    const S bend = a_.divide(a_.multiply(width_[i], both), six);
    const S slope = a_.subtract(chord_[i], bend);
    const S change = a_.subtract(right, left);
    const S cubic = a_.divide(change, a_.multiply(six, width_[i]));
    if (i == 0) {
      const S inside = a_.call(Function::max, {a_.number("0"), t});
      const S linear = a_.multiply(slope, t);
      return a_.add(linear, a_.multiply(cubic, a_.power(inside, 3, 1)));
    }
    // Times t as a whole: a sum of slope*x over the intervals, less their slope*knot, would cancel.
    const S quadratic = a_.divide(left, two);
    const S bending = a_.add(quadratic, a_.multiply(cubic, t));
    const S secant = a_.add(slope, a_.multiply(t, bending));
    return a_.multiply(t, secant);
  }

  // Second derivatives at the knots: a tridiagonal system, by elimination from the left.
  void find_curvatures() {
    const size_t intervals = width_.size();
    const S zero = a_.number("0");
    const S two = a_.number("2");
    const S six = a_.number("6");
    std::vector<S> diagonal(1, zero), right(1, zero);  // of the knots between the ends, counted from 1
    for (size_t i = 1; i < intervals; ++i) {
      const S both = a_.add(width_[i - 1], width_[i]);
      S pivot = a_.multiply(two, both);
      const S bend = a_.subtract(chord_[i], chord_[i - 1]);
      S wanted = a_.multiply(six, bend);
      if (i > 1) {
        const S factor = a_.divide(width_[i - 1], diagonal[i - 1]);
        const S taken = a_.multiply(factor, width_[i - 1]);
        pivot = a_.subtract(pivot, taken);
        const S moved = a_.multiply(factor, right[i - 1]);
        wanted = a_.subtract(wanted, moved);
      }
      diagonal.push_back(pivot);
      right.push_back(wanted);
    }
    curvature_.assign(intervals + 1, zero);
    for (size_t i = intervals - 1; i > 0; --i) {
      const S moved = a_.multiply(width_[i], curvature_[i + 1]);
      const S left = a_.subtract(right[i], moved);
      curvature_[i] = a_.divide(left, diagonal[i]);
    }
  }

  A& a_;
  std::vector<S> knots_, values_, width_, chord_, curvature_;
};

}  // namespace ergon
