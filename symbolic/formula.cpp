#include "symbolic/formula.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "symbolic/double_algebra.h"
#include "symbolic/elaborate.h"
#include "symbolic/expression_parser.h"

namespace ergon {
namespace {

// The names in an expression; those that are not known are errors.
void collect_names(const Expression& e, const Quantities& known, std::set<std::string>& names) {
  if (e.kind == Expression::Kind::name && e.text != "pi") {
    if (!known.contains(e.text)) {
      std::vector<std::string> candidates;
      for (const auto& [name, quantity] : known) candidates.push_back(name);
      throw SourceError(e.place,
                        fmt::format("unknown name '{}'; a formula knows X (rest position, m), t (time, s) and the "
                                    "constants given beside it{}",
                                    e.text, did_you_mean(e.text, candidates)));
    }
    names.insert(e.text);
  }
  for (const ExpressionPtr& argument : e.arguments) collect_names(*argument, known, names);
}

}  // namespace

Formula::Formula(const std::string& text, const Place& place, const std::map<std::string, Constant>& constants) {
  Quantities known = {{"X", {{3, 1}, parse_unit("m").unit}}, {"t", {{}, parse_unit("s").unit}}};
  for (const auto& [name, constant] : constants) {
    if (known.contains(name) || name == "pi")
      throw SourceError(constant.place, fmt::format("'{}' is {}; choose another name for this constant", name,
                                                    name == "X"   ? "the rest position"
                                                    : name == "t" ? "the time"
                                                                  : "a number that formulas know"));
    known[name] = constant.quantity;
    names_[name] = {constant.quantity.shape, constant.values};
  }
  ExpressionParser parser(tokenise({text, {{0, place}}}, 0));
  expression_ = parser.expression();
  parser.finish();
  std::set<std::string> used;
  collect_names(*expression_, known, used);
  quantity_ = type_of(*expression_, known);
  for (const auto& [name, constant] : constants)
    if (!used.contains(name))
      throw SourceError(constant.place, fmt::format("the constant '{}' is not used in the formula", name));
  of_position_ = used.contains("X");
  of_time_ = used.contains("t");
}

std::vector<double> Formula::at(const std::array<double, 3>& X, double t) const {
  static const ExactInputs none;
  DoubleAlgebra numbers(none);
  std::map<std::string, Tensor<double>> names = names_;
  names["X"] = {{3, 1}, {X.begin(), X.end()}};
  names["t"] = {{}, {t}};
  return evaluate(*expression_, names, numbers).at;
}

}  // namespace ergon
