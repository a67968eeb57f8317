#include "codegen/frontier.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "codegen/rewrite.h"

namespace ergon {
namespace {

using LinearForm = std::map<int, double>;  // component of the points -> coefficient

struct Affine {
  bool affine = true;
  LinearForm form;  // empty: does not depend on the points
};

std::vector<Affine> find_affine(const Graph& g) {
  std::vector<Affine> out(static_cast<size_t>(g.size()));
  for (NodeId id = 0; id < g.size(); ++id) {
    const Node& n = g[id];
    Affine& a = out[static_cast<size_t>(id)];
    if (n.kind == Node::Kind::input && n.source == Source::point) a.form[n.index] = 1;
    for (const Term& t : n.terms) {
      const Affine& of = out[static_cast<size_t>(t.node)];
      a.affine = a.affine && of.affine;
      for (const auto& [i, c] : of.form)
        if ((a.form[i] += t.coefficient * c) == 0) a.form.erase(i);
    }
    if (n.kind == Node::Kind::product || n.kind == Node::Kind::call)
      for (NodeId o : g.operands(id)) {
        const Affine& of = out[static_cast<size_t>(o)];
        a.affine = a.affine && of.affine && of.form.empty();
      }
    if (!a.affine) a.form.clear();
  }
  return out;
}

// Affine nodes that something nonlinear uses, in order.
std::vector<NodeId> find_frontier(const Module& module, const std::vector<Affine>& affine) {
  const Graph& g = module.graph;
  std::vector<NodeId> roots = module.roots();
  std::vector<char> used(static_cast<size_t>(g.size()), 0);
  for (NodeId r : roots) used[static_cast<size_t>(r)] = 1;
  for (NodeId id : reachable(g, roots))
    if (!affine[static_cast<size_t>(id)].affine)
      for (NodeId o : g.operands(id)) used[static_cast<size_t>(o)] = 1;
  std::vector<NodeId> out;
  for (NodeId id = 0; id < g.size(); ++id) {
    const Affine& a = affine[static_cast<size_t>(id)];
    if (used[static_cast<size_t>(id)] && a.affine && !a.form.empty()) out.push_back(id);
  }
  return out;
}

using Weights = std::vector<double>;  // over the points

// Coefficients that make `target` from the basis; empty when it is not in its span.
std::vector<double> express(const std::vector<Weights>& basis, const Weights& target) {
  size_t columns = basis.size();
  std::vector<std::vector<double>> rows(target.size(), std::vector<double>(columns + 1));
  for (size_t p = 0; p < target.size(); ++p) {
    for (size_t k = 0; k < columns; ++k) rows[p][k] = basis[k][p];
    rows[p][columns] = target[p];
  }
  constexpr double tiny = 1e-12;  // weights are small rational numbers
  for (size_t k = 0; k < columns; ++k) {
    size_t pivot = k;
    for (size_t r = k; r < rows.size(); ++r)
      if (std::abs(rows[r][k]) > std::abs(rows[pivot][k])) pivot = r;
    std::swap(rows[k], rows[pivot]);
    for (size_t r = 0; r < rows.size(); ++r) {
      if (r == k || rows[r][k] == 0) continue;
      double f = rows[r][k] / rows[k][k];
      for (size_t c = k; c <= columns; ++c) rows[r][c] -= f * rows[k][c];
    }
  }
  for (size_t r = columns; r < rows.size(); ++r)
    if (std::abs(rows[r][columns]) > tiny) return {};
  std::vector<double> out(columns);
  for (size_t k = 0; k < columns; ++k) {
    double c = rows[k][columns] / rows[k][k];
    out[k] = std::abs(c - std::round(c)) < tiny ? std::round(c) : c;
  }
  return out;
}

bool same_component(const LinearForm& form) {
  return std::all_of(form.begin(), form.end(), [&](const auto& e) { return e.first % 3 == form.begin()->first % 3; });
}

Weights weights_of(const LinearForm& form, int points) {
  Weights w(static_cast<size_t>(points), 0);
  for (const auto& [i, c] : form) w[static_cast<size_t>(i / 3)] = c;
  return w;
}

std::vector<Weights> choose_basis(const std::vector<NodeId>& nodes, const std::vector<Affine>& affine, int points) {
  std::vector<Weights> basis;
  bool separable = true;
  for (NodeId id : nodes) {
    const LinearForm& form = affine[static_cast<size_t>(id)].form;
    separable = separable && same_component(form);
    if (!separable || basis.size() == static_cast<size_t>(points)) break;
    Weights w = weights_of(form, points);
    if (express(basis, w).empty()) basis.push_back(w);
  }
  if (separable && basis.size() < static_cast<size_t>(points)) return basis;
  basis.assign(static_cast<size_t>(points), Weights(static_cast<size_t>(points), 0));
  for (size_t p = 0; p < basis.size(); ++p) basis[p][p] = 1;
  return basis;
}

}  // namespace

void frontier(Module& module) {
  if (module.points == 0) return;
  std::vector<Affine> affine = find_affine(module.graph);
  std::vector<Weights> basis = choose_basis(find_frontier(module, affine), affine, module.points);
  module.q_vectors = static_cast<int>(basis.size());
  module.weights.clear();
  for (const Weights& w : basis) module.weights.insert(module.weights.end(), w.begin(), w.end());

  // An affine node becomes its combination of q plus what does not depend on the points.
  std::vector<NodeId> offset(affine.size(), -1);
  rewrite(module, [&](const Graph& old, NodeId id, const std::vector<NodeId>& renumbered, Graph& graph) {
    const Affine& a = affine[static_cast<size_t>(id)];
    if (!a.affine || a.form.empty()) {
      NodeId made = copy_node(old, id, renumbered, graph);
      offset[static_cast<size_t>(id)] = made;
      return made;
    }
    std::vector<Term> terms;
    for (const Term& t : old[id].terms) terms.push_back({t.coefficient, offset[static_cast<size_t>(t.node)]});
    NodeId rest = graph.sum(old[id].constant, std::move(terms));
    offset[static_cast<size_t>(id)] = rest;
    std::vector<Term> with_q = {{1, rest}};
    for (int c = 0; c < 3; ++c) {
      LinearForm part;
      for (const auto& [i, value] : a.form)
        if (i % 3 == c) part[i] = value;
      if (part.empty()) continue;
      std::vector<double> combination = express(basis, weights_of(part, module.points));
      for (size_t k = 0; k < combination.size(); ++k)
        if (combination[k] != 0) {
          NodeId q = graph.input(Source::q, static_cast<int>(3 * k) + c);
          graph.set_name(q, "q" + std::to_string(3 * k + static_cast<size_t>(c)));
          with_q.push_back({combination[k], q});
        }
    }
    return graph.sum(0, std::move(with_q));
  });
}

}  // namespace ergon
