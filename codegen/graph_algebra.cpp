#include "codegen/graph_algebra.h"

#include <stdexcept>

namespace ergon {
namespace {

std::string component_name(const std::string& name, Shape shape, int component) {
  if (shape.scalar()) return name;
  if (shape.cols == 1) return name + "_" + std::to_string(component);
  return name + std::to_string(component % shape.rows) + std::to_string(component / shape.rows);
}

}  // namespace

NodeId GraphAlgebra::call(Function f, const std::vector<NodeId>& a) {
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

NodeId GraphAlgebra::input(const Symbol& symbol, int component) {
  int index = module_.offsets[static_cast<size_t>(&symbol - module_.energy->symbols.data())] + component;
  std::string name = component_name(symbol.name, symbol.shape, component);
  Source source = symbol.role == Role::param ? Source::param
                  : symbol.role != Role::dof ? Source::raw
                  : module_.points == 0      ? Source::q
                                             : Source::point;
  if (source == Source::q && module_.stretches) {
    const int axis = component / symbol.shape.rows;
    if (component % symbol.shape.rows != axis) return graph_.constant(0);
    NodeId q = graph_.input(Source::q, axis);
    const NodeId s = module_.displacement ? graph_.sum(1, {{1, q}}) : q;
    if (module_.displacement) graph_.set_name(q, "e" + std::to_string(axis));
    graph_.set_name(s, "s" + std::to_string(axis));
    return s;
  }
  NodeId id = graph_.input(source, index);
  if (source == Source::q && module_.displacement) {
    graph_.set_name(id, component_name("G", symbol.shape, component));
    bool diagonal = component % symbol.shape.rows == component / symbol.shape.rows;
    id = graph_.sum(diagonal ? 1 : 0, {{1, id}});
  }
  graph_.set_name(id, name);
  return id;
}

std::vector<NodeId> GraphAlgebra::stretches(const Tensor<NodeId>& F) {
  std::vector<NodeId> s;
  for (int axis = 0; axis < F.shape.cols; ++axis) s.push_back(F(axis, axis));
  return s;
}

NodeId GraphAlgebra::named(const std::string& let, int component, int size, NodeId value) {
  if (graph_[value].kind != Node::Kind::input && !graph_.is_constant(value) && !moves(value))
    value = graph_.call(Call::keep, {value});
  graph_.set_name(value, size == 1 ? let : let + "_" + std::to_string(component));
  return value;
}

bool GraphAlgebra::moves(NodeId id) {
  while (moves_.size() < static_cast<size_t>(graph_.size())) {
    NodeId next = static_cast<NodeId>(moves_.size());
    const Node& n = graph_[next];
    bool m = n.kind == Node::Kind::input && (n.source == Source::q || n.source == Source::point);
    for (NodeId o : graph_.operands(next)) m = m || moves_[static_cast<size_t>(o)];
    moves_.push_back(m);
  }
  return moves_[static_cast<size_t>(id)];
}

}  // namespace ergon
