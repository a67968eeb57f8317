#include "codegen/factor.h"

#include <algorithm>
#include <map>

namespace ergon {
namespace {

struct Monomial {
  double coefficient;
  std::vector<Factor> factors;
};

bool less(const Factor& a, const Factor& b) {
  return a.base != b.base ? a.base < b.base : a.num * b.den < b.num * a.den;
}

// The factor found in most monomials, if in at least two.
bool most_common(const std::vector<Monomial>& monomials, Factor& best) {
  std::map<Factor, int, decltype(&less)> counts(&less);
  for (const Monomial& m : monomials)
    for (const Factor& f : m.factors) counts[f]++;
  int most = 1;
  for (const auto& [factor, count] : counts)
    if (count > 1 && count >= most) most = count, best = factor;
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
