#include "codegen/interpret.h"

#include <cmath>

namespace ergon {

std::vector<double> interpret(const Graph& graph, const std::vector<NodeId>& wanted, const GraphInputs& inputs) {
  std::vector<double> value(static_cast<size_t>(graph.size()), 0);
  auto of = [&](NodeId id) { return value[static_cast<size_t>(id)]; };
  for (NodeId id : reachable(graph, wanted)) {
    const Node& n = graph[id];
    double v = 0;
    switch (n.kind) {
      case Node::Kind::constant:
        v = n.constant;
        break;
      case Node::Kind::input: {
        const std::vector<double>& from = n.source == Source::param     ? inputs.params
                                          : n.source == Source::raw     ? inputs.raw
                                          : n.source == Source::point   ? inputs.points
                                          : n.source == Source::q       ? inputs.q
                                          : n.source == Source::stretch ? inputs.stretch
                                                                        : inputs.negative;
        v = from.at(static_cast<size_t>(n.index));
        break;
      }
      case Node::Kind::sum:
        v = n.constant;
        for (const Term& t : n.terms) v += t.coefficient * of(t.node);
        break;
      case Node::Kind::product:
        v = 1;
        for (const Factor& f : n.factors)
          v *= f.den == 2 ? std::pow(std::sqrt(of(f.base)), f.num)
                          : std::pow(of(f.base), static_cast<double>(f.num) / f.den);
        break;
      case Node::Kind::call: {
        std::vector<double> arguments;
        for (NodeId a : n.arguments) arguments.push_back(of(a));
        v = evaluate(n.call, arguments);
        break;
      }
    }
    value[static_cast<size_t>(id)] = v;
  }
  std::vector<double> out;
  for (NodeId id : wanted) out.push_back(of(id));
  return out;
}

}  // namespace ergon
