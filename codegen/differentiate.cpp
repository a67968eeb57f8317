#include "codegen/differentiate.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "codegen/factor.h"

namespace ergon {
namespace {

// d(call)/d(argument k), as a node.
NodeId partial(Graph& g, NodeId id, size_t k) {
  const Node n = g[id];
  NodeId a = n.arguments[0];
  NodeId b = n.arguments.size() > 1 ? n.arguments[1] : -1;
  NodeId one = g.constant(1), zero = g.constant(0);
  switch (n.call) {
    case Call::log:
      return g.power(a, -1);
    case Call::exp:
      return id;
    case Call::log1p:
      return g.power(g.sum(1, {{1, a}}), -1);
    case Call::expm1:
      return g.sum(1, {{1, id}});
    case Call::log1pmx:
      return g.product(-1, {{a}, {g.sum(1, {{1, a}}), -1}});
    case Call::expm1mx:
      return g.call(Call::expm1, {a});
    case Call::sinmx:
      return g.product(-2, {{g.call(Call::sin, {g.scale(0.5, a)}), 2}});
    case Call::atanmx:
      return g.product(-1, {{a, 2}, {g.sum(1, {{1, g.power(a, 2)}}), -1}});
    case Call::sin:
      return g.call(Call::cos, {a});
    case Call::cos:
      return g.scale(-1, g.call(Call::sin, {a}));
    case Call::tan:
      return g.sum(1, {{1, g.power(id, 2)}});
    case Call::asin:
      return g.power(g.sum(1, {{-1, g.power(a, 2)}}), -1, 2);
    case Call::acos:
      return g.scale(-1, g.power(g.sum(1, {{-1, g.power(a, 2)}}), -1, 2));
    case Call::atan:
      return g.power(g.sum(1, {{1, g.power(a, 2)}}), -1);
    case Call::atan2: {
      NodeId r = g.power(g.add(g.power(a, 2), g.power(b, 2)), -1);
      return k == 0 ? g.multiply(b, r) : g.scale(-1, g.multiply(a, r));
    }
    case Call::pow:
      return k == 0 ? g.multiply(b, g.call(Call::pow, {a, g.sum(-1, {{1, b}})}))
                    : g.multiply(id, g.call(Call::log, {a}));
    case Call::abs:
      return g.call(Call::select, {a, one, g.constant(-1)});
    case Call::min:
      return g.call(Call::select, {g.subtract(b, a), k == 0 ? one : zero, k == 0 ? zero : one});
    case Call::max:
      return g.call(Call::select, {g.subtract(a, b), k == 0 ? one : zero, k == 0 ? zero : one});
    case Call::select:
      return k == 0 ? zero : g.call(Call::select, {a, k == 1 ? one : zero, k == 1 ? zero : one});
    case Call::keep:
      return one;
  }
  throw std::logic_error("differentiate: unknown call");
}

// d(product)/d(base k) * extra
NodeId partial_product(Graph& g, const std::vector<Factor>& factors, size_t k, NodeId extra) {
  std::vector<Factor> rest = factors;
  double coefficient = static_cast<double>(rest[k].num) / rest[k].den;
  rest[k].num -= rest[k].den;
  rest.push_back({extra});
  return g.product(coefficient, std::move(rest));
}

// The components of q that each node depends on, as bits.
std::vector<std::uint64_t> dependences(const Graph& g, const std::vector<NodeId>& order) {
  std::vector<std::uint64_t> depends(static_cast<size_t>(g.size()), 0);
  for (NodeId id : order) {
    const Node& node = g[id];
    std::uint64_t& d = depends[static_cast<size_t>(id)];
    if (node.kind == Node::Kind::input && node.source == Source::q) d = std::uint64_t{1} << node.index;
    for (NodeId o : g.operands(id)) d |= depends[static_cast<size_t>(o)];
  }
  return depends;
}

NodeId whole(Graph& g, NodeId adjoint, NodeId of, const std::vector<std::uint64_t>& depends) {
  int partials = 0;
  for (NodeId o : g.operands(of)) partials += depends[static_cast<size_t>(o)] != 0;
  const Term core = g.unscaled(adjoint);
  if (partials < 2 || g[core.node].kind != Node::Kind::product) return adjoint;
  return g.scale(core.coefficient, g.call(Call::keep, {core.node}));
}

// Adjoints that are products and are multiplied by several partial derivatives: split into their factors, so that sums
// of such terms factor anew; or kept whole, so that their derivatives are formed once: at nodes through which the whole
// value flows (a volume ratio, an angle), or at all. Which is cheapest depends on the energy.
enum class Adjoints { split, whole_where_all_flows, whole };

std::vector<NodeId> reverse(Graph& g, NodeId value, int q_size, Adjoints adjoints) {
  std::vector<NodeId> order = reachable(g, std::vector<NodeId>{value});
  std::vector<std::vector<Term>> contributions(static_cast<size_t>(g.size()));
  std::vector<NodeId> gradient(static_cast<size_t>(q_size), g.constant(0));
  std::vector<std::uint64_t> depends = dependences(g, order);
  contributions[static_cast<size_t>(value)].push_back({1, g.constant(1)});
  for (auto it = order.rbegin(); it != order.rend(); ++it) {
    NodeId id = *it;
    if (!depends[static_cast<size_t>(id)]) continue;
    NodeId adjoint = factored_sum(g, 0, std::move(contributions[static_cast<size_t>(id)]));
    if (g.is_constant(adjoint, 0)) continue;
    const Node n = g[id];
    if (adjoints == Adjoints::whole || (adjoints == Adjoints::whole_where_all_flows &&
                                        depends[static_cast<size_t>(id)] == depends[static_cast<size_t>(value)]))
      adjoint = whole(g, adjoint, id, depends);
    auto give = [&](NodeId to, double c, NodeId node) {
      if (depends[static_cast<size_t>(to)]) contributions[static_cast<size_t>(to)].push_back({c, node});
    };
    if (n.kind == Node::Kind::input) gradient[static_cast<size_t>(n.index)] = adjoint;
    for (const Term& t : n.terms) give(t.node, t.coefficient, adjoint);
    for (size_t k = 0; k < n.factors.size(); ++k)
      if (depends[static_cast<size_t>(n.factors[k].base)])
        give(n.factors[k].base, 1, partial_product(g, n.factors, k, adjoint));
    for (size_t k = 0; k < n.arguments.size(); ++k)
      if (depends[static_cast<size_t>(n.arguments[k])]) give(n.arguments[k], 1, g.multiply(adjoint, partial(g, id, k)));
  }
  return gradient;
}

// Tangents in the direction q_j of all nodes that the gradient needs.
class Tangents {
 public:
  Tangents(Graph& graph, const std::vector<NodeId>& order, const std::vector<std::uint64_t>& depends, int j)
      : g_(graph), tangent_(depends.size(), -1) {
    NodeId zero = g_.constant(0);
    for (NodeId id : order)
      tangent_[static_cast<size_t>(id)] = depends[static_cast<size_t>(id)] >> j & 1 ? form(id, j) : zero;
  }
  NodeId of(NodeId id) const { return tangent_[static_cast<size_t>(id)]; }

 private:
  NodeId form(NodeId id, int j) {
    const Node n = g_[id];
    if (n.kind == Node::Kind::input) return g_.constant(n.index == j ? 1 : 0);
    std::vector<Term> terms;
    for (const Term& t : n.terms) terms.push_back({t.coefficient, of(t.node)});
    for (size_t k = 0; k < n.factors.size(); ++k)
      if (!g_.is_constant(of(n.factors[k].base), 0))
        terms.push_back({1, partial_product(g_, n.factors, k, of(n.factors[k].base))});
    for (size_t k = 0; k < n.arguments.size(); ++k)
      if (!g_.is_constant(of(n.arguments[k]), 0))
        terms.push_back({1, g_.multiply(of(n.arguments[k]), partial(g_, id, k))});
    return factored_sum(g_, 0, std::move(terms));
  }

  Graph& g_;
  std::vector<NodeId> tangent_;
};

struct Derivatives {
  std::vector<NodeId> gradient, hessian;
};

Derivatives derive(Graph& g, NodeId value, int n, Adjoints adjoints) {
  Derivatives out;
  out.gradient = reverse(g, value, n, adjoints);
  const std::vector<NodeId> order = reachable(g, out.gradient);
  const std::vector<std::uint64_t> depends = dependences(g, order);
  out.hessian.assign(static_cast<size_t>(n * (n + 1) / 2), -1);
  for (int j = 0; j < n; ++j) {
    Tangents tangents(g, order, depends, j);
    for (int i = j; i < n; ++i)
      out.hessian[static_cast<size_t>(i * (i + 1) / 2 + j)] = tangents.of(out.gradient[static_cast<size_t>(i)]);
  }
  return out;
}

// Two-operand operations of the nodes that the derivatives need, before products share parts.
long cost(const Graph& g, const Derivatives& d) {
  std::vector<NodeId> roots = d.gradient;
  roots.insert(roots.end(), d.hessian.begin(), d.hessian.end());
  long operations = 0;
  for (NodeId id : reachable(g, roots)) {
    const Node& n = g[id];
    operations += static_cast<long>(n.terms.size() + n.factors.size());
    for (const Term& t : n.terms) operations += std::abs(t.coefficient) != 1;
    for (const Factor& f : n.factors) operations += std::abs(f.num) > 1;
    operations -= n.kind == Node::Kind::product || (n.kind == Node::Kind::sum && n.constant == 0);
  }
  return operations;
}

Derivatives cheapest(Graph& g, NodeId value, int n) {
  Graph best;
  Derivatives out;
  long least = -1;
  for (const Adjoints adjoints : {Adjoints::split, Adjoints::whole_where_all_flows, Adjoints::whole}) {
    Graph tried = g;
    Derivatives derivatives = derive(tried, value, n, adjoints);
    const long operations = cost(tried, derivatives);
    if (least >= 0 && 20 * operations > 19 * least) continue;  // within 5 percent the count does not decide
    least = operations;
    best = std::move(tried);
    out = std::move(derivatives);
  }
  g = std::move(best);
  return out;
}

}  // namespace

void differentiate(Module& module) {
  if (module.q_size() > 64) throw std::logic_error("differentiate: more than 64 components of q");
  auto differentiate_form = [&](NodeId value, std::vector<NodeId>& gradient, std::vector<NodeId>& hessian) {
    Derivatives d = cheapest(module.graph, value, module.q_size());
    gradient = std::move(d.gradient);
    hessian = std::move(d.hessian);
  };
  differentiate_form(module.value, module.gradient, module.hessian);
  if (module.near >= 0) differentiate_form(module.far.value, module.far.gradient, module.far.hessian);
}

}  // namespace ergon
