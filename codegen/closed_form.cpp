#include "codegen/closed_form.h"

#include <algorithm>
#include <map>
#include <optional>

#include "codegen/differentiate.h"
#include "codegen/rewrite.h"

namespace ergon {
namespace {

// Makes `root` of one graph again in another, with the given nodes in place of theirs.
NodeId transplant(const Graph& from, NodeId root, Graph& to, const std::map<NodeId, NodeId>& given) {
  std::vector<NodeId> renumbered(static_cast<size_t>(from.size()), -1);
  for (NodeId id : reachable(from, std::vector<NodeId>{root})) {
    const auto it = given.find(id);
    renumbered[static_cast<size_t>(id)] = it != given.end() ? it->second : copy_node(from, id, renumbered, to);
  }
  return renumbered[static_cast<size_t>(root)];
}

// The degree in q of each node as a polynomial; kNoPolynomial when it is none.
constexpr int kNoPolynomial = 1000;
std::vector<int> find_degrees(const Graph& g) {
  std::vector<int> degrees;
  for (NodeId id = 0; id < g.size(); ++id) {
    const Node& n = g[id];
    int degree = n.kind == Node::Kind::input && n.source == Source::q;
    for (const Term& t : n.terms) degree = std::max(degree, degrees[static_cast<size_t>(t.node)]);
    for (const Factor& f : n.factors) {
      const int base = degrees[static_cast<size_t>(f.base)];
      if (base > 0) degree += f.den == 1 && f.num > 0 ? base * f.num : kNoPolynomial;
    }
    for (NodeId a : n.arguments)
      if (degrees[static_cast<size_t>(a)] > 0) degree = kNoPolynomial;
    degrees.push_back(std::min(degree, kNoPolynomial));
  }
  return degrees;
}

// Whether every way from `value` to an input q leads through `gate`.
bool passes_through(const Graph& g, NodeId value, NodeId gate, const std::vector<int>& degrees) {
  std::vector<char> seen(static_cast<size_t>(g.size()), 0);
  seen[static_cast<size_t>(value)] = 1;
  for (NodeId id = value; id >= 0; --id) {
    if (!seen[static_cast<size_t>(id)] || id == gate || degrees[static_cast<size_t>(id)] == 0) continue;
    if (g[id].kind == Node::Kind::input) return false;
    for (NodeId o : g.operands(id)) seen[static_cast<size_t>(o)] = 1;
  }
  return true;
}

struct Scalar {
  NodeId s;
  std::vector<NodeId> gradient;
  NodeId h;
};

// s with its derivatives when its Hessian is h I.
std::optional<Scalar> isotropic(Module& module, NodeId s) {
  Module part;
  part.energy = module.energy;
  part.q_vectors = module.q_vectors;
  part.value = transplant(module.graph, s, part.graph, {});
  differentiate(part);
  const std::vector<int> degrees = find_degrees(part.graph);
  const NodeId h = part.hessian[0];
  if (degrees[static_cast<size_t>(h)] != 0) return std::nullopt;
  for (int i = 0, k = 0; i < part.q_size(); ++i)
    for (int j = 0; j <= i; ++j, ++k) {
      const NodeId entry = part.hessian[static_cast<size_t>(k)];
      if (i == j ? entry != h : !part.graph.is_constant(entry, 0)) return std::nullopt;
    }
  Scalar out{s, {}, transplant(part.graph, h, module.graph, {})};
  for (NodeId d : part.gradient) out.gradient.push_back(transplant(part.graph, d, module.graph, {}));
  return out;
}

std::optional<Scalar> find_scalar(Module& module) {
  const std::vector<int> degrees = find_degrees(module.graph);
  const std::vector<NodeId> candidates = reachable(module.graph, std::vector<NodeId>{module.value});
  for (auto it = candidates.rbegin(); it != candidates.rend(); ++it) {
    const int degree = degrees[static_cast<size_t>(*it)];
    if (degree < 1 || degree > 2 || !passes_through(module.graph, module.value, *it, degrees)) continue;
    if (std::optional<Scalar> found = isotropic(module, *it)) return found;
  }
  return std::nullopt;
}

// f' and f'' where value = f(s).
std::pair<NodeId, NodeId> outer_derivatives(Module& module, NodeId s) {
  Module outer;
  outer.energy = module.energy;
  outer.q_vectors = 1;
  const NodeId t = outer.graph.input(Source::q, 0);
  outer.value = transplant(module.graph, module.value, outer.graph, {{s, t}});
  differentiate(outer);
  return {transplant(outer.graph, outer.gradient[0], module.graph, {{t, s}}),
          transplant(outer.graph, outer.hessian[0], module.graph, {{t, s}})};
}

}  // namespace

void find_closed_form(Module& module) {
  module.projected.clear();
  module.changed = -1;
  const std::optional<Scalar> scalar = find_scalar(module);
  if (!scalar) return;
  Graph& g = module.graph;
  const auto [first, second] = outer_derivatives(module, scalar->s);
  const std::vector<NodeId>& d = scalar->gradient;
  const NodeId negative = g.input(Source::negative, 0);
  const auto projected = [&](NodeId x) { return g.call(Call::max, {x, g.scale(-1, g.multiply(negative, x))}); };

  NodeId across = g.constant(0), along = projected(second), lowest = second;  // along: the factor of g g'
  if (!g.is_constant(scalar->h, 0)) {
    std::vector<Term> squares;
    for (NodeId c : d) squares.push_back({1, g.power(c, 2)});
    // Where g = 0 nothing is along it; the quotient must stay finite.
    const NodeId square = g.call(Call::max, {g.sum(0, squares), g.constant(1e-300)});
    const NodeId flat = g.multiply(first, scalar->h), steep = g.add(flat, g.multiply(second, square));
    across = projected(flat);
    along = g.divide(g.subtract(projected(steep), across), square);
    lowest = g.call(Call::min, {flat, steep});
  }
  for (size_t i = 0; i < d.size(); ++i)
    for (size_t j = 0; j <= i; ++j) {
      const NodeId entry = g.product(1, {{along}, {d[i]}, {d[j]}});
      module.projected.push_back(i == j ? g.add(across, entry) : entry);
    }
  module.changed = g.scale(-1, lowest);
}

}  // namespace ergon
