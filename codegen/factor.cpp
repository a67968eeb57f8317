#include "codegen/factor.h"

#include <algorithm>

namespace ergon {
namespace {

struct Monomial {
  double coefficient;
  std::vector<Factor> factors;
};

bool less(const Factor& a, const Factor& b) {
  return a.base != b.base ? a.base < b.base : a.num * b.den < b.num * a.den;
}

// The factor found in most monomials, if in at least two; of several the greatest.
bool most_common(const std::vector<Monomial>& monomials, Factor& best) {
  std::vector<Factor> all;
  for (const Monomial& m : monomials) all.insert(all.end(), m.factors.begin(), m.factors.end());
  std::sort(all.begin(), all.end(), less);
  std::ptrdiff_t most = 1;
  for (auto first = all.begin(); first != all.end();) {
    const auto last = std::find_if_not(first, all.end(), [&](const Factor& f) { return f == *first; });
    if (last - first > 1 && last - first >= most) most = last - first, best = *first;
    first = last;
  }
  return most > 1;
}

NodeId build(Graph& graph, double constant, std::vector<Monomial> monomials) {
  std::vector<Term> terms;
  Factor common{-1};
  while (monomials.size() > 1 && most_common(monomials, common)) {
    std::vector<Monomial> inner, outer;
    for (Monomial& m : monomials) {
      auto it = std::find(m.factors.begin(), m.factors.end(), common);
      if (it == m.factors.end()) {
        outer.push_back(std::move(m));
      } else {
        m.factors.erase(it);
        inner.push_back(std::move(m));
      }
    }
    NodeId sum = build(graph, 0, std::move(inner));
    terms.push_back({1, graph.product(1, {common, {sum}})});
    monomials = std::move(outer);
  }
  for (Monomial& m : monomials) terms.push_back({1, graph.product(m.coefficient, std::move(m.factors))});
  return graph.sum(constant, std::move(terms));
}

}  // namespace

NodeId factored_sum(Graph& graph, double constant, std::vector<Term> terms) {
  // Like terms first, so that what cancels is gone before anything is factored.
  NodeId plain = graph.sum(constant, std::move(terms));
  Term outer = graph.unscaled(plain);
  const Node sum = graph[outer.node];
  if (sum.kind != Node::Kind::sum) return plain;
  std::vector<Monomial> monomials;
  for (const Term& t : sum.terms) {
    const Node& n = graph[t.node];
    if (n.kind == Node::Kind::product)
      monomials.push_back({t.coefficient, n.factors});
    else
      monomials.push_back({t.coefficient, {{t.node}}});
  }
  return graph.scale(outer.coefficient, build(graph, sum.constant, std::move(monomials)));
}

}  // namespace ergon
