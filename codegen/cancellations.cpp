#include "codegen/cancellations.h"

#include <optional>

#include "codegen/rewrite.h"

namespace ergon {
namespace {

// x of a sum 1 + x.
std::optional<NodeId> less_one(Graph& g, NodeId id) {
  const Node n = g[id];
  if (n.kind != Node::Kind::sum || n.constant != 1) return std::nullopt;
  return g.sum(0, n.terms);
}

// f(x) - f(0) for a node f(x), where that has a form of its own and f(0) = 1.
std::optional<NodeId> change(Graph& g, NodeId id) {
  const Node n = g[id];
  if (n.kind == Node::Kind::call && n.call == Call::exp) return g.call(Call::expm1, n.arguments);
  if (n.kind == Node::Kind::call && n.call == Call::cos)
    return g.product(-2, {{g.call(Call::sin, {g.scale(0.5, n.arguments[0])}), 2}});
  if (n.kind != Node::Kind::product || n.factors.size() != 1) return std::nullopt;
  const Factor& f = n.factors[0];
  if (f.num != 1 || f.den != 2) return std::nullopt;
  const auto x = less_one(g, f.base);
  if (!x) return std::nullopt;
  return g.divide(*x, g.sum(1, {{1, id}}));
}

}  // namespace

void remove_cancellations(Module& module) {
  rewrite(module, [](const Graph& old, NodeId id, const std::vector<NodeId>& renumbered, Graph& g) {
    const NodeId made = copy_node(old, id, renumbered, g);
    const Node n = g[made];
    if (n.kind == Node::Kind::call && n.call == Call::log)
      if (const auto x = less_one(g, n.arguments[0])) return g.call(Call::log1p, {*x});
    if (n.kind != Node::Kind::sum || n.constant == 0) return made;
    for (size_t i = 0; i < n.terms.size(); ++i) {
      if (n.terms[i].coefficient != -n.constant) continue;
      const auto changed = change(g, n.terms[i].node);
      if (!changed) continue;
      std::vector<Term> terms = n.terms;
      terms[i].node = *changed;
      return g.sum(0, std::move(terms));
    }
    return made;
  });
}

}  // namespace ergon
