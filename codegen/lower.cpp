#include "codegen/lower.h"

#include <stdexcept>

#include "codegen/graph_algebra.h"
#include "codegen/rewrite.h"
#include "symbolic/elaborate.h"
#include "symbolic/stretches.h"

namespace ergon {

std::vector<NodeId> Module::roots() const {
  std::vector<NodeId> out;
  for (NodeId one : {value, near, far.value, changed})
    if (one >= 0) out.push_back(one);
  for (const auto* list :
       {&active, &require, &update, &gradient, &hessian, &principal, &projected, &far.gradient, &far.hessian})
    out.insert(out.end(), list->begin(), list->end());
  return out;
}

Module empty_module(const Energy& energy, const std::string& case_name) {
  Module module;
  module.energy = &energy;
  module.case_name = case_name;
  bool density = energy.kind == Energy::Kind::density;
  int components = 0;
  for (const Symbol& s : energy.symbols) {
    int& total = s.role == Role::param ? module.params : s.role == Role::dof ? components : module.raw;
    if (s.role == Role::dof && s.shape.rows != 3)
      throw SourceError(s.place,
                        "dof '" + s.name + "' is a " + to_string(s.shape) + "; only vectors of 3 can be moved so far");
    module.offsets.push_back(total);
    total += s.shape.size();
  }
  module.points = density ? 0 : components / 3;
  module.q_vectors = components / 3;
  module.stretches = density && uses_stretches(energy);
  return module;
}

Module lower(const Energy& energy, const std::string& case_name) {
  Module module = empty_module(energy, case_name);

  GraphAlgebra algebra(module);
  Elaborated<NodeId> parts = elaborate(energy, case_name, algebra);
  module.value = parts.value;
  module.active = parts.active;
  module.require = parts.require;
  module.update = parts.update;
  flatten(module);
  return module;
}

void flatten(Module& module) {
  std::vector<int> uses(static_cast<size_t>(module.graph.size()), 0);
  std::vector<NodeId> roots = module.roots();
  for (NodeId r : roots) uses[static_cast<size_t>(r)] += 2;  // a root stays a node of its own
  for (NodeId id : reachable(module.graph, roots))
    for (NodeId o : module.graph.operands(id)) uses[static_cast<size_t>(o)]++;

  rewrite(module, [&](const Graph& old, NodeId id, const std::vector<NodeId>& renumbered, Graph& graph) {
    const Node& n = old[id];
    if (n.kind != Node::Kind::sum) return copy_node(old, id, renumbered, graph);
    double constant = n.constant;
    std::vector<Term> terms;
    for (const Term& t : n.terms) {
      NodeId now = renumbered[static_cast<size_t>(t.node)];
      Term core = graph.unscaled(now);
      const Node& inner = graph[core.node];
      if (inner.kind == Node::Kind::sum && uses[static_cast<size_t>(t.node)] == 1 && old.name(t.node).empty()) {
        double scale = t.coefficient * core.coefficient;
        constant += scale * inner.constant;
        for (const Term& i : inner.terms) terms.push_back({scale * i.coefficient, i.node});
      } else {
        terms.push_back({t.coefficient, now});
      }
    }
    return graph.sum(constant, std::move(terms));
  });
}

}  // namespace ergon
