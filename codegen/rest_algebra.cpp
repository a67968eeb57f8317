#include "codegen/rest_algebra.h"

#include <algorithm>

#include "codegen/rewrite.h"

namespace ergon {

RestAlgebra::RestAlgebra(Module& module) : module_(module), g_(module.graph), graph_(module) {}

// The graph knows equal expressions; their expansions are made once.
RestAlgebra::Scalar RestAlgebra::append(Part part) {
  if (const auto known = by_direct_.find(part.direct); known != by_direct_.end()) return known->second;
  by_direct_[part.direct] = static_cast<Scalar>(parts_.size());
  if (part.op != Op::fixed && part.op != Op::opaque) {
    part.c = settled(part.c);
    for (NodeId& l : part.l) l = settled(l);
    if (std::all_of(part.l.begin(), part.l.end(), [&](NodeId l) { return g_.is_constant(l, 0); })) part.l.clear();
  }
  parts_.push_back(std::move(part));
  return static_cast<Scalar>(parts_.size()) - 1;
}

RestAlgebra::Scalar RestAlgebra::fixed(NodeId node) {
  Part p;
  p.direct = p.c = node;
  return append(std::move(p));
}

RestAlgebra::Scalar RestAlgebra::opaque(NodeId direct) {
  Part p;
  p.op = Op::opaque;
  p.direct = direct;
  p.polynomial = false;
  return append(std::move(p));
}

RestAlgebra::Scalar RestAlgebra::input(const Symbol& symbol, int component) {
  const NodeId node = graph_.input(symbol, component);
  if (symbol.role != Role::dof || g_.is_constant(node)) return fixed(node);
  Part p;
  p.op = Op::input;
  p.direct = node;
  const bool diagonal = component % symbol.shape.rows == component / symbol.shape.rows;
  if (module_.stretches) component /= symbol.shape.rows;
  p.c = g_.constant(diagonal ? 1 : 0);
  p.l.assign(static_cast<size_t>(module_.q_size()), g_.constant(0));
  p.l[static_cast<size_t>(component)] = g_.constant(1);
  p.d = g_.input(Source::q, component);
  return append(std::move(p));
}

std::vector<RestAlgebra::Scalar> RestAlgebra::stretches(const Tensor<Scalar>& F) {
  std::vector<Scalar> s;
  for (int axis = 0; axis < F.shape.cols; ++axis) s.push_back(F(axis, axis));
  return s;
}

RestAlgebra::Scalar RestAlgebra::named(const std::string& let, int component, int size, Scalar a) {
  const NodeId direct = graph_.named(let, component, size, at(a).direct);
  if (is_fixed(a)) return fixed(direct);
  at(a).direct = direct;
  if (at(a).name.empty()) at(a).name = size == 1 ? let : let + "_" + std::to_string(component);
  return a;
}

RestAlgebra::Scalar RestAlgebra::scaled(NodeId factor, Scalar a, NodeId direct) {
  if (is_fixed(a)) return fixed(direct);
  if (!expands(a)) return opaque(direct);
  Part p;
  p.op = Op::scale;
  p.a = a;
  p.b = fixed(factor);
  p.direct = direct;
  p.polynomial = polynomial(a);
  p.c = g_.multiply(factor, at(a).c);
  p.l = combined(at(a).l, factor, {}, factor);
  return append(std::move(p));
}

RestAlgebra::Scalar RestAlgebra::negate(Scalar a) { return scaled(g_.constant(-1), a, graph_.negate(direct(a))); }

RestAlgebra::Scalar RestAlgebra::sum(Scalar a, Scalar b, double sign) {
  const NodeId node = sign > 0 ? graph_.add(direct(a), direct(b)) : graph_.subtract(direct(a), direct(b));
  if (is_fixed(a) && is_fixed(b)) return fixed(node);
  if (!expands(a) || !expands(b)) return opaque(node);
  Part p;
  p.op = Op::sum;
  p.a = a;
  p.b = b;
  p.sign = sign;
  p.direct = node;
  p.polynomial = polynomial(a) && polynomial(b);
  p.c = g_.sum(0, {{1, at(a).c}, {sign, at(b).c}});
  p.l = combined(at(a).l, g_.constant(1), at(b).l, g_.constant(sign));
  return append(std::move(p));
}

RestAlgebra::Scalar RestAlgebra::multiply(Scalar a, Scalar b) {
  const NodeId node = graph_.multiply(direct(a), direct(b));
  if (is_fixed(a)) return scaled(at(a).c, b, node);
  if (is_fixed(b)) return scaled(at(b).c, a, node);
  if (!expands(a) || !expands(b)) return opaque(node);
  Part p;
  p.op = a == b ? Op::square : Op::product;
  p.a = a;
  p.b = b;
  p.direct = node;
  p.polynomial = polynomial(a) && polynomial(b);
  p.c = g_.multiply(at(a).c, at(b).c);
  p.l = combined(at(a).l, at(b).c, at(b).l, at(a).c);
  return append(std::move(p));
}

RestAlgebra::Scalar RestAlgebra::divide(Scalar a, Scalar b) {
  const NodeId node = graph_.divide(direct(a), direct(b));
  if (is_fixed(b)) return scaled(g_.divide(g_.constant(1), at(b).c), a, node);
  const Scalar inverse = power(b, -1, 1);
  const Scalar quotient = multiply(a, inverse);
  at(quotient).direct = node;
  return quotient;
}

RestAlgebra::Scalar RestAlgebra::power(Scalar a, long num, long den) {
  const NodeId node = graph_.power(direct(a), num, den);
  if (is_fixed(a)) return fixed(node);
  if (!expands(a)) return opaque(node);
  if (den == 1 && num > 1 && num <= 16) {
    const Scalar half = num == 2 || num == 3 ? a : power(a, num / 2, 1);
    Scalar whole = multiply(half, half);
    if (num % 2 == 1) whole = multiply(whole, a);
    at(whole).direct = node;
    return whole;
  }
  const NodeId c = at(a).c;
  if (g_.is_constant(c, 0)) return opaque(node);
  const double p = static_cast<double>(num) / static_cast<double>(den);
  const NodeId at_rest = graph_.power(c, num, den);
  const NodeId slope = g_.product(p, {{c, static_cast<int>(num - den), static_cast<int>(den)}});
  const Op op = den == 1 && num == -1 ? Op::reciprocal : den == 2 && num == 1 ? Op::root : Op::power;
  const Scalar made = function(op, a, node, at_rest, slope);
  at(made).num = static_cast<int>(num);
  at(made).den = static_cast<int>(den);
  return made;
}

RestAlgebra::Scalar RestAlgebra::power(Scalar a, Scalar b) {
  const NodeId node = graph_.power(direct(a), direct(b));
  if (is_fixed(a) && is_fixed(b)) return fixed(node);
  const Scalar made = call(Function::exp, {multiply(b, call(Function::log, {a}))});
  if (!expands(made)) return opaque(node);
  at(made).direct = node;
  return made;
}

// Which of the two is larger at rest must be known. Where they are equal there, a sum of the kind c + 0 + r.
RestAlgebra::Scalar RestAlgebra::larger(Scalar a, Scalar b, NodeId direct) {
  if (!expands(a) || !expands(b) || !g_.is_constant(at(a).c) || !g_.is_constant(at(b).c)) return opaque(direct);
  if (g_[at(a).c].constant < g_[at(b).c].constant) std::swap(a, b);
  Part p;
  p.op = Op::larger;
  p.a = a;
  p.b = b;
  p.direct = direct;
  p.polynomial = polynomial(a) && polynomial(b);
  p.c = at(a).c;
  if (at(a).c != at(b).c) p.l = at(a).l;
  return append(std::move(p));
}

RestAlgebra::Scalar RestAlgebra::call(Function f, const std::vector<Scalar>& arguments) {
  std::vector<NodeId> nodes;
  for (const Scalar s : arguments) nodes.push_back(direct(s));
  const NodeId node = graph_.call(f, nodes);
  const Scalar a = arguments[0];
  if (std::all_of(arguments.begin(), arguments.end(), [&](Scalar s) { return is_fixed(s); })) return fixed(node);
  if (!expands(a)) return opaque(node);
  const NodeId c = at(a).c;
  switch (f) {
    case Function::sqrt:
      return power(a, 1, 2);
    case Function::log:
      if (g_.is_constant(c, 0)) return opaque(node);
      return function(Op::log, a, node, g_.call(Call::log, {c}), g_.power(c, -1));
    case Function::exp: {
      const NodeId at_rest = g_.call(Call::exp, {c});
      return function(Op::exp, a, node, at_rest, at_rest);
    }
    case Function::log1p: {
      const Scalar shifted = add(a, number("1"));
      const Scalar made = call(Function::log, {shifted});
      at(made).direct = node;
      return made;
    }
    case Function::expm1: {
      const Scalar whole = call(Function::exp, {a});
      const Scalar made = subtract(whole, number("1"));
      at(made).direct = node;
      return made;
    }
    case Function::sin:
      return function(Op::sin, a, node, g_.call(Call::sin, {c}), g_.call(Call::cos, {c}));
    case Function::cos:
      return function(Op::cos, a, node, g_.call(Call::cos, {c}), g_.scale(-1, g_.call(Call::sin, {c})));
    case Function::tan: {
      const NodeId t = g_.call(Call::tan, {c});
      return function(Op::tan, a, node, t, g_.sum(1, {{1, g_.power(t, 2)}}));
    }
    case Function::atan:
      return g_.is_constant(c, 0) ? function(Op::atan, a, node, c, g_.constant(1)) : opaque(node);
    case Function::abs:
      return larger(a, negate(a), node);
    case Function::max:
      return larger(a, arguments[1], node);
    case Function::min: {
      const Scalar made = negate(larger(negate(a), negate(arguments[1]), graph_.negate(node)));
      return expands(made) ? made : opaque(node);
    }
    default:
      return opaque(node);
  }
}

RestAlgebra::Scalar RestAlgebra::function(Op op, Scalar a, NodeId direct, NodeId c, NodeId slope) {
  Part p;
  p.op = op;
  p.a = a;
  p.direct = direct;
  p.polynomial = false;
  p.c = c;
  p.l = combined(at(a).l, slope, {}, slope);
  return append(std::move(p));
}

std::vector<NodeId> RestAlgebra::combined(const std::vector<NodeId>& x, NodeId cx, const std::vector<NodeId>& y,
                                          NodeId cy) {
  std::vector<NodeId> out;
  for (size_t i = 0; i < std::max(x.size(), y.size()); ++i) {
    const NodeId left = x.empty() ? g_.constant(0) : g_.multiply(cx, x[i]);
    const NodeId right = y.empty() ? g_.constant(0) : g_.multiply(cy, y[i]);
    out.push_back(g_.add(left, right));
  }
  return out;
}

NodeId RestAlgebra::bare(NodeId id) {
  if (bare_.size() <= static_cast<size_t>(id)) bare_.resize(static_cast<size_t>(id) + 1, -1);
  if (bare_[static_cast<size_t>(id)] >= 0) return bare_[static_cast<size_t>(id)];
  const Node n = g_[id];
  NodeId out = id;
  if (n.kind == Node::Kind::call && n.call == Call::keep) {
    out = bare(n.arguments[0]);
  } else {
    std::vector<NodeId> now(static_cast<size_t>(id) + 1, -1);
    for (NodeId o : g_.operands(id)) now[static_cast<size_t>(o)] = bare(o);
    out = copy_node(g_, id, now, g_);
  }
  return bare_[static_cast<size_t>(id)] = out;
}

NodeId RestAlgebra::settled(NodeId node) {
  if (g_.is_constant(node) || g_[node].kind == Node::Kind::input) return node;
  const NodeId plain = bare(node);
  return g_.is_constant(plain) ? plain : node;
}

}  // namespace ergon
