#include "symbolic/sliced.h"

#include <algorithm>
#include <set>

namespace ergon {
namespace {

void add_names(const Expression& e, std::set<std::string>& names) {
  if (e.kind == Expression::Kind::name) names.insert(e.text);
  for (const ExpressionPtr& argument : e.arguments) add_names(*argument, names);
}

ExpressionPtr find_in(const ExpressionPtr& e, const Expression* part) {
  if (e.get() == part) return e;
  for (const ExpressionPtr& argument : e->arguments)
    if (ExpressionPtr found = find_in(argument, part)) return found;
  return nullptr;
}

}  // namespace

Energy sliced(const Energy& energy, const ExpressionPtr& part) {
  Energy out;
  out.kind = energy.kind;
  out.name = energy.name;
  out.geometry = energy.geometry;
  out.cases = energy.cases;
  out.value = part;
  std::set<std::string> names;
  add_names(*part, names);
  for (size_t i = energy.lets.size(); i-- > 0;) {
    const Let& let = energy.lets[i];
    if (!names.contains(let.name)) continue;
    add_names(*let.expression, names);
    out.lets.push_back(let);
  }
  for (const Symbol& symbol : energy.symbols)
    if (names.contains(symbol.name)) out.symbols.push_back(symbol);
  std::reverse(out.lets.begin(), out.lets.end());
  return out;
}

ExpressionPtr find_expression(const Energy& energy, const Expression* part) {
  std::vector<ExpressionPtr> roots{energy.value};
  for (const auto* lets : {&energy.lets, &energy.updates})
    for (const Let& let : *lets) roots.push_back(let.expression);
  for (const auto* conditions : {&energy.active, &energy.require})
    for (const Condition& condition : *conditions) roots.insert(roots.end(), {condition.left, condition.right});
  for (const ExpressionPtr& root : roots)
    if (ExpressionPtr found = find_in(root, part)) return found;
  return nullptr;
}

}  // namespace ergon
