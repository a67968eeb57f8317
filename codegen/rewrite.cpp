#include "codegen/rewrite.h"

namespace ergon {

NodeId copy_node(const Graph& from, NodeId id, const std::vector<NodeId>& renumbered, Graph& to) {
  const Node& n = from[id];
  auto now = [&](NodeId old) { return renumbered[static_cast<size_t>(old)]; };
  switch (n.kind) {
    case Node::Kind::constant:
      return to.constant(n.constant);
    case Node::Kind::input:
      return to.input(n.source, n.index);
    case Node::Kind::sum: {
      std::vector<Term> terms = n.terms;
      for (Term& t : terms) t.node = now(t.node);
      return to.sum(n.constant, std::move(terms));
    }
    case Node::Kind::product: {
      std::vector<Factor> factors = n.factors;
      for (Factor& f : factors) f.base = now(f.base);
      return to.product(1, std::move(factors));
    }
    case Node::Kind::call: {
      std::vector<NodeId> arguments = n.arguments;
      for (NodeId& a : arguments) a = now(a);
      return to.call(n.call, std::move(arguments));
    }
  }
  return -1;
}

void rewrite(Module& module, const RewriteRule& rule) {
  Graph old = std::move(module.graph);
  module.graph = Graph();
  std::vector<NodeId> renumbered(static_cast<size_t>(old.size()), -1);
  for (NodeId id : reachable(old, module.roots())) {
    NodeId made = rule(old, id, renumbered, module.graph);
    renumbered[static_cast<size_t>(id)] = made;
    if (!old.name(id).empty()) module.graph.set_name(made, old.name(id));
  }
  auto renumber = [&](NodeId& id) {
    if (id >= 0) id = renumbered[static_cast<size_t>(id)];
  };
  for (NodeId* one : {&module.value, &module.near, &module.far.value, &module.changed}) renumber(*one);
  for (auto* list : {&module.active, &module.require, &module.update, &module.gradient, &module.hessian,
                     &module.principal, &module.projected, &module.far.gradient, &module.far.hessian})
    for (NodeId& id : *list) renumber(id);
}

}  // namespace ergon
