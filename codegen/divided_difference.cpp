#include "codegen/divided_difference.h"

#include <cstdlib>
#include <utility>

#include "codegen/rewrite.h"

namespace ergon {
namespace {

constexpr int kLargestPower = 24;  // beyond, a whole power is formed as any other

// f where t is not 0, else `limit`; f is given a t that is never 0.
template <class F>
NodeId with_limit(Graph& g, NodeId t, NodeId limit, F&& f) {
  const NodeId squared = g.power(t, 2);
  const NodeId safe = g.call(Call::select, {squared, t, g.constant(1)});
  return g.call(Call::select, {squared, f(safe), limit});
}

NodeId& entry(std::vector<NodeId>& of, NodeId node) {
  if (of.size() <= static_cast<size_t>(node)) of.resize(static_cast<size_t>(node) + 1, -1);
  return of[static_cast<size_t>(node)];
}

}  // namespace

NodeId DividedDifference::exchanged(NodeId node) {
  if (const NodeId known = entry(exchanged_, node); known >= 0) return known;
  for (NodeId id : reachable(g_, std::vector<NodeId>{node})) {
    if (entry(exchanged_, id) >= 0) continue;
    NodeId made = id == a_ ? b_ : id == b_ ? a_ : -1;
    if (made < 0) made = copy_node(g_, id, exchanged_, g_);
    entry(exchanged_, id) = made;
  }
  return entry(exchanged_, node);
}

NodeId DividedDifference::mean(NodeId node) {
  const NodeId other = exchanged(node);
  return other == node ? node : g_.sum(0, {{0.5, node}, {0.5, other}});
}

NodeId DividedDifference::of(NodeId node) {
  if (const NodeId known = entry(difference_, node); known >= 0) return known;
  const Node n = g_[node];
  NodeId made = g_.constant(0);
  if (node == a_ || node == b_) {
    made = g_.constant(node == a_ ? 1 : -1);
  } else if (exchanged(node) != node) {
    switch (n.kind) {
      case Node::Kind::sum: {
        std::vector<Term> terms;
        for (const Term& t : n.terms) terms.push_back({t.coefficient, of(t.node)});
        made = g_.sum(0, std::move(terms));
        break;
      }
      case Node::Kind::product:
        made = of_product(n);
        break;
      case Node::Kind::call:
        made = of_call(node);
        break;
      default:
        break;
    }
  }
  return entry(difference_, node) = made;
}

NodeId DividedDifference::of_product(const Node& n) {
  const Factor first = n.factors[0];
  const NodeId slope = of_power(first.base, first.num, first.den);
  if (n.factors.size() == 1) return slope;
  const NodeId left = g_.power(first.base, first.num, first.den);
  const NodeId rest = g_.product(1, {n.factors.begin() + 1, n.factors.end()});
  const NodeId by_left = g_.multiply(slope, mean(rest)), by_rest = g_.multiply(mean(left), of(rest));
  return g_.add(by_left, by_rest);
}

NodeId DividedDifference::of_power(NodeId base, int num, int den) {
  const NodeId inner = of(base);
  if (g_.is_constant(inner, 0)) return inner;
  const NodeId x = base, y = exchanged(base);
  if (den == 1 && std::abs(num) <= kLargestPower) return g_.multiply(whole_power(x, y, num), inner);
  if (den == 2 && std::abs(num) <= kLargestPower) {
    const NodeId root_x = g_.power(x, 1, 2), root_y = g_.power(y, 1, 2);
    return g_.product(1, {{whole_power(root_x, root_y, num)}, {g_.add(root_x, root_y), -1}, {inner}});
  }
  return g_.multiply(power_slope(x, y, g_.constant(static_cast<double>(num) / den)), inner);
}

// (x^n - y^n)/(x - y) = sum of x^k y^(n-1-k); of a negative power -n, minus the sum of x^(k-n) y^(-1-k).
NodeId DividedDifference::whole_power(NodeId x, NodeId y, int exponent) {
  const int n = std::abs(exponent);
  std::vector<Term> terms;
  for (int k = 0; k < n; ++k) {
    const int by_x = exponent > 0 ? k : k - n, by_y = exponent > 0 ? n - 1 - k : -1 - k;
    const NodeId left = by_x == 0 ? g_.constant(1) : g_.power(x, by_x);
    const NodeId right = by_y == 0 ? g_.constant(1) : g_.power(y, by_y);
    terms.push_back({exponent > 0 ? 1.0 : -1.0, g_.multiply(left, right)});
  }
  return g_.sum(0, std::move(terms));
}

// log(x/y)/(x - y). The two are ordered, so that it is one node whichever comes first.
NodeId DividedDifference::log_slope(NodeId x, NodeId y) {
  if (x > y) std::swap(x, y);
  const NodeId t = g_.divide(g_.subtract(x, y), y);
  const NodeId slope =
      with_limit(g_, t, g_.constant(1), [&](NodeId safe) { return g_.divide(g_.call(Call::log1p, {safe}), safe); });
  return g_.divide(slope, y);
}

NodeId DividedDifference::exp_slope(NodeId x, NodeId y) {
  if (x > y) std::swap(x, y);
  const NodeId slope = with_limit(g_, g_.subtract(x, y), g_.constant(1),
                                  [&](NodeId safe) { return g_.divide(g_.call(Call::expm1, {safe}), safe); });
  return g_.multiply(g_.call(Call::exp, {y}), slope);
}

// With t = (x - y)/y it is y^(k-1) ((1 + t)^k - 1)/t.
NodeId DividedDifference::power_slope(NodeId x, NodeId y, NodeId exponent) {
  if (x > y) std::swap(x, y);
  const NodeId slope = with_limit(g_, g_.divide(g_.subtract(x, y), y), exponent, [&](NodeId safe) {
    const NodeId power = g_.multiply(exponent, g_.call(Call::log1p, {safe}));
    return g_.divide(g_.call(Call::expm1, {power}), safe);
  });
  return g_.multiply(g_.call(Call::pow, {y, g_.sum(-1, {{1, exponent}})}), slope);
}

// Where both states choose alike, the difference of what they choose; elsewhere they are apart, and the values of a
// continuous function small beside the difference of the inputs.
NodeId DividedDifference::of_choice(NodeId node, NodeId condition, NodeId above, NodeId below) {
  const NodeId other = exchanged(condition);
  const NodeId gap = g_.subtract(a_, b_);
  const NodeId safe = g_.call(Call::select, {g_.power(gap, 2), gap, g_.constant(1)});
  const NodeId mixed = g_.divide(g_.subtract(node, exchanged(node)), safe);
  const NodeId both = g_.call(Call::select, {other, of(above), mixed});
  const NodeId none = g_.call(Call::select, {other, mixed, of(below)});
  return g_.call(Call::select, {condition, both, none});
}

NodeId DividedDifference::of_call(NodeId node) {
  const Node n = g_[node];
  const NodeId x = n.arguments[0];
  const auto chain = [&](NodeId slope) { return g_.multiply(slope, of(x)); };
  switch (n.call) {
    case Call::keep:
      return of(x);
    case Call::log:
      return chain(log_slope(x, exchanged(x)));
    case Call::log1p: {
      const NodeId shifted = g_.sum(1, {{1, x}});
      return chain(log_slope(shifted, exchanged(shifted)));
    }
    case Call::exp:
    case Call::expm1:
      return chain(exp_slope(x, exchanged(x)));
    case Call::pow: {
      const NodeId k = n.arguments[1];
      if (exchanged(k) == k) return chain(power_slope(x, exchanged(x), k));
      return of(g_.call(Call::exp, {g_.multiply(k, g_.call(Call::log, {x}))}));
    }
    case Call::abs:
      return of_choice(node, x, x, g_.scale(-1, x));
    case Call::max:
    case Call::min: {
      const NodeId y = n.arguments[1];
      return of_choice(node, n.call == Call::max ? g_.subtract(x, y) : g_.subtract(y, x), x, y);
    }
    case Call::select:
      return of_choice(node, x, n.arguments[1], n.arguments[2]);
    default:
      break;
  }
  throw UnknownDifference{name_of(n.call)};
}

}  // namespace ergon
