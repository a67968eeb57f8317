#pragma once
// Second-order forward differentiation as an algebra over any other algebra B: every scalar carries its gradient and
// the lower triangle of its Hessian, in B's numbers. Parts that are zero by structure are not stored or computed.
//
// Beyond what symbolic/elaborate.h asks of an algebra, B supplies
//   bool is_zero(const Scalar&);                 exactly zero, whatever the inputs
//   bool less(const Scalar&, const Scalar&);
//   Decomposed<Scalar> decompose_apart(const std::vector<Scalar>& F);   where energies may call `stretches`
// Derivatives may be limited to the first ones, and taken by every symbol instead of the dofs alone, or by none.
// The derivative of abs at 0 is 1; where the arguments of min or max are equal, the first is taken.

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "symbolic/energy.h"
#include "symbolic/functions.h"
#include "symbolic/tensor.h"

namespace ergon {

template <class S>
struct Jet {
  S value;
  std::vector<S> gradient;  // n entries, or none when constant
  std::vector<S> hessian;   // entry (i, j <= i) at i*(i + 1)/2 + j, or none when affine
};

template <class B>
class JetAlgebra {
 public:
  using S = typename B::Scalar;
  using Scalar = Jet<S>;

  enum class Variables { none, dofs, all };
  enum class Order { first, second };

  // The components of the energy's dofs (or of all its symbols), in order of declaration, are the variables.
  JetAlgebra(const Energy& energy, B& base, Order order = Order::second, Variables variables = Variables::dofs)
      : b_(base), zero_(base.number("0")), one_(base.number("1")), order_(order), of_(variables) {
    for (const Symbol& symbol : energy.symbols)
      if (varies(symbol)) n_ += symbol.shape.size();
  }

  int variables() const { return n_; }

  Scalar number(const std::string& decimal) { return {b_.number(decimal), {}, {}}; }

  Scalar pi() requires requires(B& b) { b.pi(); }
  { return {b_.pi(), {}, {}}; }

  Scalar input(const Symbol& symbol, int component) {
    Scalar r{b_.input(symbol, component), {}, {}};
    if (!varies(symbol)) return r;
    r.gradient.assign(static_cast<size_t>(n_), zero_);
    r.gradient[static_cast<size_t>(next_++)] = one_;
    return r;
  }

  void named(const std::string&, int, int, const Scalar&) {}

  Scalar negate(const Scalar& a) {
    Scalar r = a;
    r.value = b_.negate(a.value);
    for (S& g : r.gradient) g = b_.negate(g);
    for (S& h : r.hessian) h = b_.negate(h);
    return r;
  }

  Scalar add(const Scalar& x, const Scalar& y) {
    return {b_.add(x.value, y.value), sum(x.gradient, y.gradient), sum(x.hessian, y.hessian)};
  }

  Scalar subtract(const Scalar& x, const Scalar& y) { return add(x, negate(y)); }

  Scalar multiply(const Scalar& x, const Scalar& y) {
    return chain(x, y, b_.multiply(x.value, y.value), {y.value, x.value, zero_, one_, zero_});
  }

  Scalar divide(const Scalar& x, const Scalar& y) {
    const S q = b_.divide(x.value, y.value);
    const S r = b_.divide(one_, y.value);
    if (y.gradient.empty()) return chain(x, q, r, zero_);
    const S minus_r2 = b_.negate(b_.multiply(r, r));
    const S fy = b_.multiply(x.value, minus_r2);
    const S fyy = b_.multiply(b_.multiply(integer(-2), fy), r);
    return chain(x, y, q, {r, fy, zero_, minus_r2, fyy});
  }

  Scalar power(const Scalar& x, long num, long den) {
    const S value = power_of(x.value, num, den);
    if (x.gradient.empty()) return {value, {}, {}};
    const S p = b_.divide(integer(num), integer(den));
    const S q = b_.divide(integer(num - den), integer(den));
    const S first = b_.multiply(p, power_of(x.value, num - den, den));
    if (num == den) return chain(x, value, first, zero_);
    const S second = b_.multiply(b_.multiply(p, q), power_of(x.value, num - 2 * den, den));
    return chain(x, value, first, second);
  }

  Scalar power(const Scalar& x, const Scalar& y) {
    const S value = b_.power(x.value, y.value);
    if (x.gradient.empty() && y.gradient.empty()) return {value, {}, {}};
    Scalar exponent = multiply(y, call(Function::log, {x}));
    exponent.value = b_.multiply(y.value, b_.call(Function::log, {x.value}));
    return chain(exponent, value, value, value);
  }

  Scalar call(Function f, const std::vector<Scalar>& arguments) {
    const Scalar& x = arguments[0];
    if (f == Function::min) return b_.less(arguments[1].value, x.value) ? arguments[1] : x;
    if (f == Function::max) return b_.less(x.value, arguments[1].value) ? arguments[1] : x;
    if (f == Function::abs) return b_.less(x.value, zero_) ? negate(x) : x;
    if (f == Function::atan2) return atan2(x, arguments[1]);
    const S value = b_.call(f, {x.value});
    if (x.gradient.empty()) return {value, {}, {}};
    const auto [first, second] = derivatives(f, x.value, value);
    return chain(x, value, first, second);
  }

  // Singular values of F; symbolic/reference.h tells how many digits their derivatives take. With W = U' dF V,
  //   d s_i = W_ii,
  //   d^2 s_i = sum over j != i of 1/2 (W_ij + W_ji)^2/(s_i - s_j) + 1/2 (W_ij - W_ji)^2/(s_i + s_j),
  // and where F has less than three columns W_ni^2/s_i for each normal n: second-order perturbation of F'F.
  std::vector<Scalar> stretches(const Tensor<Scalar>& F) requires requires(B& b, std::vector<S> f) {
    b.decompose_apart(f);
  }
  {
    std::vector<S> values;
    for (const Scalar& x : F.at) values.push_back(x.value);
    const auto svd = b_.decompose_apart(values);
    const size_t n = svd.s.size();
    std::array<std::array<std::vector<S>, 3>, 3> w;
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < n; ++j)
        for (size_t k = 0; k < F.at.size(); ++k)
          add_scaled(w[i][j], b_.multiply(svd.u[i][k % 3], svd.v[j][k / 3]), F.at[k].gradient, static_cast<size_t>(n_));
    const S half = b_.number("0.5");
    std::vector<Scalar> out;
    for (size_t i = 0; i < n; ++i) {
      Scalar s{svd.s[i], w[i][i], {}};
      for (size_t j = 0; j < 3 && order_ == Order::second && !s.gradient.empty(); ++j) {
        if (j == i) continue;
        if (j >= n) {
          add_outer(s.hessian, reciprocal(svd.s[i]), w[j][i], w[j][i]);
          continue;
        }
        const std::vector<S> both = sum(w[i][j], w[j][i]);
        std::vector<S> difference = w[j][i];
        for (S& x : difference) x = b_.negate(x);
        difference = sum(w[i][j], difference);
        add_outer(s.hessian, b_.divide(half, b_.subtract(svd.s[i], svd.s[j])), both, both);
        add_outer(s.hessian, b_.divide(half, b_.add(svd.s[i], svd.s[j])), difference, difference);
      }
      out.push_back(std::move(s));
    }
    return out;
  }

 private:
  struct Partials {
    S x, y, xx, xy, yy;
  };

  S integer(long i) { return i < 0 ? b_.negate(b_.number(std::to_string(-i))) : b_.number(std::to_string(i)); }
  S square(const S& a) { return b_.multiply(a, a); }
  S reciprocal(const S& a) { return b_.divide(one_, a); }

  S power_of(const S& a, long num, long den) {
    if (num == 0) return one_;
    return num == den ? a : b_.power(a, num, den);
  }

  std::vector<S> sum(const std::vector<S>& x, const std::vector<S>& y) {
    if (x.empty()) return y;
    if (y.empty()) return x;
    std::vector<S> r;
    r.reserve(x.size());
    for (size_t i = 0; i < x.size(); ++i) {
      const bool no_x = b_.is_zero(x[i]), no_y = b_.is_zero(y[i]);
      r.push_back(no_x ? y[i] : no_y ? x[i] : b_.add(x[i], y[i]));
    }
    return r;
  }

  void accumulate(S& into, const S& x, const S& y) {
    if (b_.is_zero(x) || b_.is_zero(y)) return;
    const S product = b_.multiply(x, y);
    into = b_.is_zero(into) ? product : b_.add(into, product);
  }

  void add_scaled(std::vector<S>& into, const S& factor, const std::vector<S>& x, size_t size) {
    if (x.empty() || b_.is_zero(factor)) return;
    if (into.empty()) into.assign(size, zero_);
    for (size_t i = 0; i < size; ++i) accumulate(into[i], factor, x[i]);
  }

  // The lower triangle of factor * x y^T is added.
  void add_outer(std::vector<S>& into, const S& factor, const std::vector<S>& x, const std::vector<S>& y) {
    if (x.empty() || y.empty() || b_.is_zero(factor)) return;
    if (into.empty()) into.assign(packed(), zero_);
    for (size_t i = 0, k = 0; i < x.size(); ++i) {
      S scaled = zero_;
      accumulate(scaled, factor, x[i]);
      for (size_t j = 0; j <= i; ++j, ++k) accumulate(into[k], scaled, y[j]);
    }
  }

  bool varies(const Symbol& symbol) const {
    return of_ == Variables::all || (of_ == Variables::dofs && symbol.role == Role::dof);
  }

  size_t packed() const { return static_cast<size_t>(n_) * (static_cast<size_t>(n_) + 1) / 2; }

  Scalar chain(const Scalar& x, S value, const S& first, const S& second) {
    Scalar r{std::move(value), {}, {}};
    add_scaled(r.gradient, first, x.gradient, static_cast<size_t>(n_));
    if (order_ == Order::first) return r;
    add_scaled(r.hessian, first, x.hessian, packed());
    add_outer(r.hessian, second, x.gradient, x.gradient);
    return r;
  }

  Scalar chain(const Scalar& x, const Scalar& y, S value, const Partials& f) {
    Scalar r{std::move(value), {}, {}};
    add_scaled(r.gradient, f.x, x.gradient, static_cast<size_t>(n_));
    add_scaled(r.gradient, f.y, y.gradient, static_cast<size_t>(n_));
    if (order_ == Order::first) return r;
    add_scaled(r.hessian, f.x, x.hessian, packed());
    add_scaled(r.hessian, f.y, y.hessian, packed());
    add_outer(r.hessian, f.xx, x.gradient, x.gradient);
    add_outer(r.hessian, f.yy, y.gradient, y.gradient);
    add_outer(r.hessian, f.xy, x.gradient, y.gradient);
    add_outer(r.hessian, f.xy, y.gradient, x.gradient);
    return r;
  }

  // The angle of the vector (x, y).
  Scalar atan2(const Scalar& y, const Scalar& x) {
    const S value = b_.call(Function::atan2, {y.value, x.value});
    if (x.gradient.empty() && y.gradient.empty()) return {value, {}, {}};
    const S r = reciprocal(b_.add(square(x.value), square(y.value)));
    const S fy = b_.multiply(x.value, r);
    const S fx = b_.negate(b_.multiply(y.value, r));
    const S fxx = b_.negate(b_.multiply(integer(2), b_.multiply(fx, fy)));
    const S fxy = b_.subtract(square(fx), square(fy));
    return chain(x, y, value, {fx, fy, fxx, fxy, b_.negate(fxx)});
  }

  // First and second derivative of a function of one argument at x, where it is f.
  std::pair<S, S> derivatives(Function function, const S& x, const S& f) {
    switch (function) {
      case Function::sqrt: {
        const S first = reciprocal(b_.multiply(integer(2), f));
        return {first, b_.negate(b_.divide(first, b_.multiply(integer(2), x)))};
      }
      case Function::log:
      case Function::log1p: {
        const S first = reciprocal(function == Function::log ? x : b_.add(one_, x));
        return {first, b_.negate(square(first))};
      }
      case Function::exp:
        return {f, f};
      case Function::expm1: {
        const S first = b_.add(f, one_);
        return {first, first};
      }
      case Function::sin:
        return {b_.call(Function::cos, {x}), b_.negate(f)};
      case Function::cos:
        return {b_.negate(b_.call(Function::sin, {x})), b_.negate(f)};
      case Function::tan: {
        const S first = b_.add(one_, square(f));
        return {first, b_.multiply(integer(2), b_.multiply(f, first))};
      }
      case Function::atan: {
        const S first = reciprocal(b_.add(one_, square(x)));
        return {first, b_.multiply(b_.multiply(integer(-2), x), square(first))};
      }
      default: {  // asin, acos
        const S root = b_.call(Function::sqrt, {b_.multiply(b_.subtract(one_, x), b_.add(one_, x))});
        const S first = reciprocal(root);
        const S second = b_.multiply(x, b_.multiply(first, square(first)));
        if (function == Function::asin) return {first, second};
        return {b_.negate(first), b_.negate(second)};
      }
    }
  }

  B& b_;
  S zero_, one_;
  Order order_;
  Variables of_;
  int n_ = 0;
  int next_ = 0;
};

}  // namespace ergon
