#include "symbolic/blame.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "symbolic/elaborate.h"
#include "symbolic/jet.h"
#include "symbolic/stretches.h"

namespace ergon {
namespace {

constexpr int digits = 50;

using Kind = Expression::Kind;
using ClnJet = Jet<ClnNumber>;

// Keeps the result of every part.
class TracedJets : public JetAlgebra<ClnAlgebra> {
 public:
  using JetAlgebra<ClnAlgebra>::JetAlgebra;
  void formed(const Expression& e, const std::vector<ClnJet>& components) { parts.emplace_back(&e, components); }
  std::vector<std::pair<const Expression*, std::vector<ClnJet>>> parts;
};

class TracedValues : public ClnAlgebra {
 public:
  using ClnAlgebra::ClnAlgebra;
  void formed(const Expression& e, const std::vector<ClnNumber>& components) {
    if (components.size() == 1) scalars.insert_or_assign(&e, components[0]);
  }
  std::map<const Expression*, ClnNumber> scalars;
};

bool defined(const ClnJet& jet) {
  auto holds = [](const ClnNumber& x) { return x.defined; };
  return jet.value.defined && std::all_of(jet.gradient.begin(), jet.gradient.end(), holds) &&
         std::all_of(jet.hessian.begin(), jet.hessian.end(), holds);
}

bool same(const ClnNumber& a, const ClnNumber& b) {
  if (!a.defined || !b.defined) return a.defined == b.defined;
  return cln::double_approx(cln::abs(a.value - b.value) / (1 + cln::abs(a.value))) < 1e-38;
}

// What a name of a let stands for, or the expression itself.
const Expression& meaning(const Energy& energy, const std::string& case_name, const Expression& e) {
  if (e.kind != Kind::name) return e;
  for (const Let& let : energy.lets)
    if (let.name == e.text && (let.case_name.empty() || let.case_name == case_name))
      return meaning(energy, case_name, *let.expression);
  return e;
}

void add_terms(const Expression& e, double sign, std::vector<std::pair<const Expression*, double>>& terms) {
  if (e.kind == Kind::add || e.kind == Kind::subtract) {
    add_terms(*e.arguments[0], sign, terms);
    add_terms(*e.arguments[1], e.kind == Kind::add ? sign : -sign, terms);
  } else {
    terms.emplace_back(&e, sign);
  }
}

}  // namespace

const Expression* first_undefined(const Energy& energy, const std::string& case_name, const ExactInputs& inputs) {
  ClnAlgebra numbers(inputs, digits_for_derivatives(energy, digits));
  TracedJets jets(energy, numbers);
  elaborate(energy, case_name, jets);
  for (const auto& [expression, components] : jets.parts)
    if (!std::all_of(components.begin(), components.end(), defined)) return expression;
  return nullptr;
}

const Expression& first_change(const Energy& energy, const std::string& case_name, const ExactInputs& a,
                               const ExactInputs& b) {
  TracedValues first(a, digits), second(b, digits);
  elaborate(energy, case_name, first);
  elaborate(energy, case_name, second);
  const Expression* at = energy.value.get();
  for (;;) {
    const Expression& e = meaning(energy, case_name, *at);
    const Expression* inner = nullptr;
    for (const ExpressionPtr& argument : e.arguments) {
      const Expression& part = meaning(energy, case_name, *argument);
      const auto x = first.scalars.find(&part), y = second.scalars.find(&part);
      if (inner == nullptr && x != first.scalars.end() && y != second.scalars.end() && !same(x->second, y->second))
        inner = &part;
    }
    if (inner == nullptr) return e;
    at = inner;
  }
}

std::vector<ValueTerm> terms_at(const Energy& energy, const std::string& case_name, const ExactInputs& inputs,
                                size_t component) {
  ClnAlgebra numbers(inputs, digits_for_derivatives(energy, digits));
  TracedJets jets(energy, numbers);
  elaborate(energy, case_name, jets);
  std::vector<std::pair<const Expression*, double>> signed_terms;
  add_terms(*energy.value, 1, signed_terms);
  std::vector<ValueTerm> terms;
  for (const auto& [term, sign] : signed_terms) {
    for (const auto& [expression, components] : jets.parts) {
      if (expression != term) continue;
      const ClnJet& jet = components[0];
      terms.push_back(
          {term, sign * to_double(jet.value), jet.gradient.empty() ? 0 : sign * to_double(jet.gradient[component])});
    }
  }
  return terms;
}

}  // namespace ergon
