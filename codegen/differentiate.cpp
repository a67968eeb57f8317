#include "codegen/differentiate.h"

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

std::vector<NodeId> reverse(Graph& g, NodeId value, int q_size) {
  std::vector<NodeId> order = reachable(g, std::vector<NodeId>{value});
  std::vector<std::vector<Term>> contributions(static_cast<size_t>(g.size()));
  std::vector<NodeId> gradient(static_cast<size_t>(q_size), g.constant(0));
  std::vector<char> depends(static_cast<size_t>(g.size()), 0);
  for (NodeId id : order) {
    const Node& n = g[id];
    bool d = n.kind == Node::Kind::input && n.source == Source::q;
    for (NodeId o : g.operands(id)) d = d || depends[static_cast<size_t>(o)];
    depends[static_cast<size_t>(id)] = d;
  }
  contributions[static_cast<size_t>(value)].push_back({1, g.constant(1)});
  for (auto it = order.rbegin(); it != order.rend(); ++it) {
    NodeId id = *it;
    if (!depends[static_cast<size_t>(id)]) continue;
    NodeId adjoint = factored_sum(g, 0, std::move(contributions[static_cast<size_t>(id)]));
    if (g.is_constant(adjoint, 0)) continue;
    const Node n = g[id];
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

void derive(Graph& g, NodeId value, int n, std::vector<NodeId>& gradient, std::vector<NodeId>& hessian) {
  gradient = reverse(g, value, n);
  std::vector<NodeId> order = reachable(g, gradient);
  std::vector<std::uint64_t> depends(static_cast<size_t>(g.size()), 0);
  for (NodeId id : order) {
    const Node& node = g[id];
    std::uint64_t& d = depends[static_cast<size_t>(id)];
    if (node.kind == Node::Kind::input && node.source == Source::q) d = std::uint64_t{1} << node.index;
    for (NodeId o : g.operands(id)) d |= depends[static_cast<size_t>(o)];
  }
  hessian.assign(static_cast<size_t>(n * (n + 1) / 2), -1);
  for (int j = 0; j < n; ++j) {
    Tangents tangents(g, order, depends, j);
    for (int i = j; i < n; ++i)
      hessian[static_cast<size_t>(i * (i + 1) / 2 + j)] = tangents.of(gradient[static_cast<size_t>(i)]);
  }
}

}  // namespace

void differentiate(Module& module) {
  if (module.q_size() > 64) throw std::logic_error("differentiate: more than 64 components of q");
  derive(module.graph, module.value, module.q_size(), module.gradient, module.hessian);
  if (module.near < 0) return;
  derive(module.graph, module.far.value, module.q_size(), module.far.gradient, module.far.hessian);
}

}  // namespace ergon
