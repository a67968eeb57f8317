#include "codegen/lower.h"

#include <cmath>
#include <stdexcept>

#include "codegen/rewrite.h"
#include "symbolic/elaborate.h"

namespace ergon {
namespace {

// The algebra in which an energy's text is a graph (see symbolic/elaborate.h).
class GraphAlgebra {
 public:
  using Scalar = NodeId;
  explicit GraphAlgebra(Module& module) : module_(module), graph_(module.graph) {}

  NodeId number(const std::string& decimal) { return graph_.constant(std::stod(decimal)); }
  NodeId add(NodeId a, NodeId b) { return graph_.add(a, b); }
  NodeId subtract(NodeId a, NodeId b) { return graph_.subtract(a, b); }
  NodeId multiply(NodeId a, NodeId b) { return graph_.multiply(a, b); }
  NodeId divide(NodeId a, NodeId b) { return graph_.divide(a, b); }
  NodeId negate(NodeId a) { return graph_.scale(-1, a); }
  NodeId power(NodeId a, long num, long den) { return graph_.power(a, static_cast<int>(num), static_cast<int>(den)); }
  NodeId power(NodeId a, NodeId b) { return graph_.call(Call::pow, {a, b}); }

  NodeId call(Function f, const std::vector<NodeId>& a) {
    switch (f) {
      case Function::sqrt:
        return graph_.power(a[0], 1, 2);
      case Function::log:
        return graph_.call(Call::log, a);
      case Function::exp:
        return graph_.call(Call::exp, a);
      case Function::log1p:
        return graph_.call(Call::log1p, a);
      case Function::expm1:
        return graph_.call(Call::expm1, a);
      case Function::sin:
        return graph_.call(Call::sin, a);
      case Function::cos:
        return graph_.call(Call::cos, a);
      case Function::tan:
        return graph_.call(Call::tan, a);
      case Function::asin:
        return graph_.call(Call::asin, a);
      case Function::acos:
        return graph_.call(Call::acos, a);
      case Function::atan:
        return graph_.call(Call::atan, a);
      case Function::atan2:
        return graph_.call(Call::atan2, a);
      case Function::abs:
        return graph_.call(Call::abs, a);
      case Function::min:
        return graph_.call(Call::min, a);
      case Function::max:
        return graph_.call(Call::max, a);
    }
    throw std::logic_error("lower: unknown function");
  }

  NodeId input(const Symbol& symbol, int component) {
    int index = module_.offsets[static_cast<size_t>(&symbol - module_.energy->symbols.data())] + component;
    Source source = symbol.role == Role::param ? Source::param
                    : symbol.role != Role::dof ? Source::raw
                    : module_.points == 0      ? Source::q
                                               : Source::point;
    NodeId id = graph_.input(source, index);
    graph_.set_name(id, component_name(symbol.name, symbol.shape, component));
    return id;
  }

  // Lets of parameters and rest or lag data alone become values of their own.
  NodeId named(const std::string& let, int component, int size, NodeId value) {
    if (graph_[value].kind != Node::Kind::input && !graph_.is_constant(value) && !moves(value))
      value = graph_.call(Call::keep, {value});
    graph_.set_name(value, size == 1 ? let : let + "_" + std::to_string(component));
    return value;
  }

 private:
  static std::string component_name(const std::string& name, Shape shape, int component) {
    if (shape.scalar()) return name;
    if (shape.cols == 1) return name + "_" + std::to_string(component);
    return name + std::to_string(component % shape.rows) + std::to_string(component / shape.rows);
  }

  // Whether the node depends on a degree of freedom.
  bool moves(NodeId id) {
    while (moves_.size() < static_cast<size_t>(graph_.size())) {
      NodeId next = static_cast<NodeId>(moves_.size());
      const Node& n = graph_[next];
      bool m = n.kind == Node::Kind::input && (n.source == Source::q || n.source == Source::point);
      for (NodeId o : graph_.operands(next)) m = m || moves_[static_cast<size_t>(o)];
      moves_.push_back(m);
    }
    return moves_[static_cast<size_t>(id)];
  }

  Module& module_;
  Graph& graph_;
  std::vector<char> moves_;
};

}  // namespace

std::vector<NodeId> Module::roots() const {
  std::vector<NodeId> out;
  if (value >= 0) out.push_back(value);
  for (const auto* list : {&active, &require, &gradient, &hessian, &principal})
    out.insert(out.end(), list->begin(), list->end());
  return out;
}

Module lower(const Energy& energy, const std::string& case_name) {
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

  GraphAlgebra algebra(module);
  Elaborated<NodeId> parts = elaborate(energy, case_name, algebra);
  module.value = parts.value;
  module.active = parts.active;
  module.require = parts.require;
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
