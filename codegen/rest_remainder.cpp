// Changes and remainders as nodes: only those that the wanted remainder needs, each in the cheapest form.

#include <stdexcept>

#include "codegen/factor.h"
#include "codegen/rest_algebra.h"

namespace ergon {

NodeId RestAlgebra::remainder(Scalar s) {
  need_remainder(s);
  while (!changes_.empty()) {
    const Scalar next = changes_.back();
    changes_.pop_back();
    spread_change(next);
  }
  return r_of(s);
}

// Marks all remainders that r_of(s) reads; changes it reads are left to be spread later, when it is known which of them
// follow from a remainder.
void RestAlgebra::need_remainder(Scalar s) {
  Part& p = at(s);
  if (p.needs_remainder) return;
  p.needs_remainder = true;
  switch (p.op) {
    case Op::fixed:
    case Op::input:
    case Op::opaque:
      return;
    case Op::scale:
      return need_remainder(p.a);
    case Op::sum:
      need_remainder(p.a);
      return need_remainder(p.b);
    case Op::larger:
      if (at(p.a).c == at(p.b).c) break;
      need_remainder(p.a);
      return need_remainder(p.b);
    default:
      break;
  }
  if (p.op == Op::larger) {
    const Scalar first = p.a, second = p.b;
    need_change(first);
    return need_change(second);
  }
  const bool binary = p.op == Op::product || p.op == Op::square;
  const Scalar a = p.a, b = p.b;
  need_change(a);
  if (binary) need_change(b);
  if (!binary || !g_.is_constant(at(b).c, 0)) need_remainder(a);
  if (binary && !g_.is_constant(at(a).c, 0)) need_remainder(b);
}

void RestAlgebra::need_change(Scalar s) {
  if (at(s).needs_change) return;
  at(s).needs_change = true;
  changes_.push_back(s);
}

// A sum whose operands have linear parts that cancel in some component is not the sum of their changes.
bool RestAlgebra::cancels(const Part& p) const {
  if (p.l.empty()) return true;
  const std::vector<NodeId>&x = at(p.a).l, &y = at(p.b).l;
  for (size_t i = 0; i < p.l.size(); ++i) {
    const bool has = (!x.empty() && !g_.is_constant(x[i], 0)) || (!y.empty() && !g_.is_constant(y[i], 0));
    if (has && g_.is_constant(p.l[i], 0)) return true;
  }
  return false;
}

void RestAlgebra::spread_change(Scalar s) {
  const Part& p = at(s);
  if (p.needs_remainder || p.op == Op::fixed || p.op == Op::input) return;
  if (p.l.empty() || (p.op == Op::sum && cancels(p))) return need_remainder(s);
  const Scalar a = p.a, b = p.b;
  const bool binary = p.op == Op::sum || p.op == Op::product || p.op == Op::square || p.op == Op::larger;
  need_change(a);
  if (binary) need_change(b);
}

NodeId RestAlgebra::linear(Scalar s) {
  std::vector<Term> terms;
  const std::vector<NodeId>& l = at(s).l;
  for (size_t i = 0; i < l.size(); ++i) {
    const NodeId q = g_.input(Source::q, static_cast<int>(i));
    if (g_.is_constant(l[i]))
      terms.push_back({g_[l[i]].constant, q});
    else
      terms.push_back({1, g_.multiply(l[i], q)});
  }
  return factored_sum(g_, 0, std::move(terms));
}

NodeId RestAlgebra::changed(Scalar s) { return g_.add(at(s).c, d_of(s)); }

NodeId RestAlgebra::r_of(Scalar s) {
  Part& p = at(s);
  if (p.r >= 0) return p.r;
  NodeId r = g_.constant(0);
  switch (p.op) {
    case Op::fixed:
    case Op::input:
      break;
    case Op::scale:
      r = g_.multiply(at(p.b).c, r_of(p.a));
      break;
    case Op::sum:
      r = g_.sum(0, {{1, r_of(p.a)}, {p.sign, r_of(p.b)}});
      break;
    case Op::square:
    case Op::product: {
      std::vector<Term> terms = {{1, g_.multiply(d_of(p.a), d_of(p.b))}};
      if (!g_.is_constant(at(p.b).c, 0)) terms.push_back({1, g_.multiply(at(p.b).c, r_of(p.a))});
      if (!g_.is_constant(at(p.a).c, 0)) terms.push_back({1, g_.multiply(at(p.a).c, r_of(p.b))});
      r = g_.sum(0, std::move(terms));
      break;
    }
    case Op::larger: {
      const Part &a = at(p.a), &b = at(p.b);
      if (a.c == b.c) {
        r = g_.call(Call::max, {d_of(p.a), d_of(p.b)});
      } else {  // less the change of a to first order
        const NodeId less = g_.subtract(linear(p.b), linear(p.a));
        const NodeId other = g_.sum(g_[b.c].constant - g_[a.c].constant, {{1, r_of(p.b)}, {1, less}});
        r = g_.call(Call::max, {r_of(p.a), other});
      }
      break;
    }
    case Op::opaque:
      throw std::logic_error("rest expansion of an operation that has none");
    default:
      r = g_.add(remainder_of_function(p), g_.multiply(slope(p), r_of(p.a)));
  }
  if (!p.name.empty()) g_.set_name(r, p.name + "_remainder");
  return p.r = r;
}

NodeId RestAlgebra::d_of(Scalar s) {
  Part& p = at(s);
  if (p.d >= 0) return p.d;
  NodeId d = g_.constant(0);
  if (p.needs_remainder || p.l.empty() || (p.op == Op::sum && cancels(p))) {
    d = g_.add(linear(s), r_of(s));
  } else {
    switch (p.op) {
      case Op::fixed:
        break;
      case Op::scale:
        d = g_.multiply(at(p.b).c, d_of(p.a));
        break;
      case Op::sum:
        d = g_.sum(0, {{1, d_of(p.a)}, {p.sign, d_of(p.b)}});
        break;
      case Op::square:
        d = g_.multiply(d_of(p.a), g_.sum(0, {{1, d_of(p.a)}, {2, at(p.a).c}}));
        break;
      case Op::larger: {
        const double apart = g_[at(p.b).c].constant - g_[p.c].constant;
        d = g_.call(Call::max, {d_of(p.a), g_.sum(apart, {{1, d_of(p.b)}})});
        break;
      }
      case Op::product:
        if (g_.is_constant(at(p.b).c, 0))  // (ca + da) db
          d = g_.multiply(changed(p.a), d_of(p.b));
        else  // ca db + da (cb + db)
          d = g_.add(g_.multiply(at(p.a).c, d_of(p.b)), g_.multiply(d_of(p.a), changed(p.b)));
        break;
      default:
        d = change_of_function(p);
    }
  }
  if (!p.name.empty()) g_.set_name(d, g_.is_constant(p.c, 0) ? p.name : p.name + "_change");
  return p.d = d;
}

// f'(c)
NodeId RestAlgebra::slope(const Part& p) {
  const NodeId c = at(p.a).c;
  switch (p.op) {
    case Op::log:
      return g_.power(c, -1);
    case Op::exp:
      return g_.call(Call::exp, {c});
    case Op::sin:
      return g_.call(Call::cos, {c});
    case Op::cos:
      return g_.scale(-1, g_.call(Call::sin, {c}));
    case Op::tan:
      return g_.sum(1, {{1, g_.power(g_.call(Call::tan, {c}), 2)}});
    case Op::atan:
      return g_.constant(1);
    default:
      return g_.product(static_cast<double>(p.num) / p.den, {{c, p.num - p.den, p.den}});
  }
}

// f(c + d) - f(c)
NodeId RestAlgebra::change_of_function(const Part& p) {
  const NodeId c = at(p.a).c, d = d_of(p.a);
  switch (p.op) {
    case Op::reciprocal:
      return g_.product(-1, {{d}, {c, -1}, {changed(p.a), -1}});
    case Op::root:
      return g_.divide(d, g_.add(g_.power(c, 1, 2), g_.power(changed(p.a), 1, 2)));
    case Op::log:
      return g_.call(Call::log1p, {ratio(p)});
    case Op::exp:
      return g_.multiply(g_.call(Call::exp, {c}), g_.call(Call::expm1, {d}));
    case Op::sin:
    case Op::cos: {  // 2 cos(c + d/2) sin(d/2) and -2 sin(c + d/2) sin(d/2)
      const NodeId half = g_.scale(0.5, d), middle = g_.add(c, half);
      const NodeId turned = g_.call(p.op == Op::sin ? Call::cos : Call::sin, {middle});
      return g_.product(p.op == Op::sin ? 2 : -2, {{turned}, {g_.call(Call::sin, {half})}});
    }
    case Op::tan: {  // (1 + t^2) tan(d)/(1 - t tan(d)), t = tan(c)
      const NodeId t = g_.call(Call::tan, {c}), change = g_.call(Call::tan, {d});
      return g_.divide(g_.multiply(slope(p), change), g_.sum(1, {{-1, g_.multiply(t, change)}}));
    }
    case Op::atan:
      return g_.call(Call::atan, {d});
    default: {
      const NodeId logarithm = g_.call(Call::log1p, {ratio(p)});
      const NodeId change = g_.call(Call::expm1, {g_.scale(static_cast<double>(p.num) / p.den, logarithm)});
      return g_.multiply(g_.power(c, p.num, p.den), change);
    }
  }
}

// f(c + d) - f(c) - f'(c) d
NodeId RestAlgebra::remainder_of_function(const Part& p) {
  const NodeId c = at(p.a).c, d = d_of(p.a);
  switch (p.op) {
    case Op::reciprocal:
      return g_.product(1, {{d, 2}, {c, -2}, {changed(p.a), -1}});
    case Op::root: {
      const NodeId both = g_.add(g_.power(c, 1, 2), g_.power(changed(p.a), 1, 2));
      return g_.product(-0.5, {{d, 2}, {c, -1, 2}, {both, -2}});
    }
    case Op::log:
      return g_.call(Call::log1pmx, {ratio(p)});
    case Op::exp:
      return g_.multiply(g_.call(Call::exp, {c}), g_.call(Call::expm1mx, {d}));
    case Op::sin:
    case Op::cos: {  // f'(c) (sin(d) - d) - 2 f(c) sin(d/2)^2
      const NodeId at_rest = g_.call(p.op == Op::sin ? Call::sin : Call::cos, {c});
      const NodeId even = g_.product(-2, {{at_rest}, {g_.call(Call::sin, {g_.scale(0.5, d)}), 2}});
      return g_.add(g_.multiply(slope(p), g_.call(Call::sinmx, {d})), even);
    }
    case Op::tan: {  // (1 + t^2) ((tan(d) - d) + t d tan(d))/(1 - t tan(d)), t = tan(c)
      const NodeId t = g_.call(Call::tan, {c}), change = g_.call(Call::tan, {d});
      const NodeId half = g_.call(Call::sin, {g_.scale(0.5, d)});
      const NodeId less = g_.add(g_.call(Call::sinmx, {d}), g_.product(2, {{d}, {half, 2}}));
      const NodeId curved = g_.divide(less, g_.call(Call::cos, {d}));
      const NodeId sum = g_.add(curved, g_.product(1, {{t}, {d}, {change}}));
      return g_.divide(g_.multiply(slope(p), sum), g_.sum(1, {{-1, g_.multiply(t, change)}}));
    }
    case Op::atan:
      return g_.call(Call::atanmx, {d});
    default: {
      // With x = d/c, k the exponent and y = k log(1 + x): (1 + x)^k - 1 - k x = (e^y - 1 - y) + k (log(1 + x) - x).
      const double k = static_cast<double>(p.num) / p.den;
      const NodeId x = ratio(p), curved = g_.call(Call::log1pmx, {x});
      const NodeId y = g_.scale(k, g_.add(x, curved));
      const NodeId change = g_.sum(0, {{1, g_.call(Call::expm1mx, {y})}, {k, curved}});
      return g_.multiply(g_.power(c, p.num, p.den), change);
    }
  }
}

}  // namespace ergon
