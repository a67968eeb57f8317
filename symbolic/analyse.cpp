#include "symbolic/analyse.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "symbolic/declaration.h"
#include "symbolic/functions.h"
#include "symbolic/other_names.h"
#include "symbolic/sliced.h"
#include "symbolic/stretches.h"
#include "symbolic/typing.h"

namespace ergon {
namespace {

using Kind = Expression::Kind;

class Analysis {
 public:
  explicit Analysis(const Energy& energy) : energy_(energy) {}

  void run() {
    points();
    declarations();
    cases();
    const std::vector<std::string> names = energy_.cases.empty() ? std::vector<std::string>{""} : energy_.cases;
    for (const std::string& name : names) expressions(name);
    unused();
  }

 private:
  void points() const {
    if (energy_.geometry.empty() || energy_.kind == Energy::Kind::density) return;
    const size_t expected = static_cast<size_t>(points_of_stencil(energy_.geometry));
    const auto dofs = energy_.with_role(Role::dof);
    for (const Symbol* dof : dofs)
      if (dof->shape != Shape{3, 1})
        throw SourceError(dof->place, fmt::format("the dof '{}' of a stencil expects shape [3], found {}", dof->name,
                                                  to_string(dof->shape)));
    if (dofs.size() == expected) return;
    const Place place = dofs.empty()             ? Place{energy_.file, 0, 0}
                        : dofs.size() > expected ? dofs[expected]->place
                                                 : dofs.back()->place;
    throw SourceError(
        place, fmt::format("the stencil '{}' has {} point{}: expected {} dof{}, found {}", energy_.geometry, expected,
                           expected == 1 ? "" : "s", expected, expected == 1 ? "" : "s", dofs.size()));
  }

  void declare(const std::string& name, const Place& place) {
    const auto& functions = function_names();
    if (std::find(functions.begin(), functions.end(), name) != functions.end())
      throw SourceError(place, fmt::format("'{}' is the name of a function; choose another", name));
    if (name == "pi") throw SourceError(place, "'pi' is the number 3.14159...; choose another name");
    const auto [known, fresh] = declared_.emplace(name, place);
    if (fresh) return;
    if (energy_.kind == Energy::Kind::density && name == "F")
      throw SourceError(place, "'F' is declared by the header of a density; choose another name");
    if (energy_.kind == Energy::Kind::barrier && (name == "gap" || name == "gap2"))
      throw SourceError(place, fmt::format("'{}' is declared by the header of a barrier; choose another name", name));
    const Place& first = known->second;
    const std::string where =
        first.file == place.file ? fmt::format("in line {}", first.line) : "at " + to_string(first);
    throw SourceError(place, fmt::format("'{}' is declared twice; the first time {}", name, where));
  }

  void declarations() {
    for (const Symbol& symbol : energy_.symbols) declare(symbol.name, symbol.place);
    std::map<std::string, const Let*> of_cases;
    for (const Let& let : energy_.lets) {
      if (!let.case_name.empty() && !of_cases.emplace(let.name, &let).second) continue;
      declare(let.name, let.place);
    }
  }

  // Every case gives the same names, each once.
  void cases() const {
    std::map<std::string, std::map<std::string, const Let*>> given;
    std::map<std::string, const Let*> first;  // of each case
    for (const Let& let : energy_.lets) {
      if (let.case_name.empty()) continue;
      first.emplace(let.case_name, &let);
      const auto [known, fresh] = given[let.case_name].emplace(let.name, &let);
      if (!fresh)
        throw SourceError(let.place, fmt::format("'{}' is given twice in the case '{}'; the first time in line {}",
                                                 let.name, let.case_name, known->second->place.line));
    }
    for (const Let& let : energy_.lets) {
      if (let.case_name.empty()) continue;
      for (const std::string& other : energy_.cases)
        if (!given[other].contains(let.name))
          throw SourceError(first.at(other)->place,
                            fmt::format("the case '{}' does not give '{}', which the case '{}' gives in line {}", other,
                                        let.name, let.case_name, let.place.line));
    }
  }

  void expressions(const std::string& case_name) {
    Quantities known;
    for (const Symbol& symbol : energy_.symbols) known[symbol.name] = {symbol.shape, symbol.unit};
    for (const Let& let : energy_.lets) {
      if (!let.case_name.empty() && let.case_name != case_name) continue;
      const Quantity q = typed(*let.expression, known);
      known[let.name] = q;
      if (!let.case_name.empty()) same_in_all_cases(let, q);
    }
    for (const Condition& condition : energy_.active) check(condition, known);
    for (const Condition& condition : energy_.require) check(condition, known);
    for (const Let& update : energy_.updates) renewed(update, typed(*update.expression, known));
    if (energy_.natural) natural(typed(*energy_.natural, known));
    if (energy_.kind == Energy::Kind::distance) return gap_of_a_distance(known);
    const Quantity value = typed(*energy_.value, known);
    const Place place = start_of(*energy_.value);
    if (!value.shape.scalar())
      throw SourceError(place, fmt::format("the value of an energy is a scalar, found {}", to_string(value.shape)));
    if (!value.any_unit && value.unit != value_unit(energy_))
      throw SourceError(
          place, fmt::format("the value of {} expects {}, found {}", what(), value_text(), to_string(value.unit)));
  }

  // `update` gives a lag another value of its kind.
  void renewed(const Let& update, const Quantity& found) const {
    const Symbol* lag = energy_.find(update.name);
    if (lag == nullptr || lag->role != Role::lag) {
      std::vector<std::string> lags;
      for (const Symbol* known : energy_.with_role(Role::lag)) lags.push_back(known->name);
      throw SourceError(update.place,
                        fmt::format("`update` renews a lag, and '{}' is none{}; it is declared by `lag {} "
                                    "UNIT`",
                                    update.name, did_you_mean(update.name, lags), update.name));
    }
    const auto same = [&](const Let& other) { return other.name == update.name; };
    const auto first = std::find_if(energy_.updates.begin(), energy_.updates.end(), same);
    if (&*first != &update)
      throw SourceError(update.place, fmt::format("'{}' is renewed twice; the first time in line {}", update.name,
                                                  first->place.line));
    if (!lag->range.contains(0))
      throw SourceError(lag->place,
                        fmt::format("the lag '{}' is renewed by `update` and starts at 0, which its range {} "
                                    "does not hold",
                                    lag->name, to_string(lag->range)));
    if (lag->shape != found.shape)
      throw SourceError(start_of(*update.expression), fmt::format("'{}' is a {}, found {}", lag->name,
                                                                  to_string(lag->shape), to_string(found.shape)));
    const std::string conflict = unit_conflict({lag->shape, lag->unit}, found);
    if (!conflict.empty())
      throw SourceError(start_of(*update.expression), fmt::format("'{}' has another unit: {}", lag->name, conflict));
    if (uses_stretches(energy_))
      throw SourceError(update.place,
                        "a density that calls `stretches` renews no lags: it sees its F by these alone; write it in F");
  }

  // `natural` is a pure number or a square matrix over the columns of F, and knows nothing of F.
  void natural(const Quantity& found) const {
    const Place place = start_of(*energy_.natural);
    const int n = energy_.find("F")->shape.cols;
    if (!found.shape.scalar() && found.shape != Shape{n, n})
      throw SourceError(place, fmt::format("`natural` is the shape without stress over the one at rest: expected a "
                                           "number or {}, found {}",
                                           to_string(Shape{n, n}), to_string(found.shape)));
    if (!found.any_unit && found.unit != Unit{})
      throw SourceError(place,
                        fmt::format("`natural` is the shape without stress over the one at rest: expected a pure "
                                    "number, found {}",
                                    to_string(found.unit)));
    for (const Symbol& symbol : sliced(energy_, energy_.natural).symbols)
      if (symbol.role == Role::dof)
        throw SourceError(place,
                          "`natural` is the shape without stress, of params, rest data and lags alone; this one "
                          "changes with F");
  }

  // A distance gives `gap2`, `gap` or both, and may give a `weight` of the energy.
  void gap_of_a_distance(const Quantities& known) {
    const Let* gap = nullptr;
    for (const Let& let : energy_.lets) {
      const bool is_gap = let.name == "gap" || let.name == "gap2";
      if (!is_gap && let.name != "weight") continue;
      used_.insert(let.name);
      if (is_gap) gap = &let;
      const Quantity& q = known.at(let.name);
      const Unit expected = pow(parse_unit("m").unit, {let.name == "gap" ? 1 : let.name == "gap2" ? 2 : 0, 1});
      if (!q.shape.scalar() || (!q.any_unit && q.unit != expected))
        throw SourceError(let.place, fmt::format("'{}' of a distance expects a scalar in {}, found a {} in {}",
                                                 let.name, to_string(expected), to_string(q.shape), to_string(q.unit)));
    }
    if (gap == nullptr)
      throw SourceError({energy_.file, 0, 0},
                        fmt::format("'{}' gives no gap; expected `let gap2 = EXPRESSION` (m^2) or "
                                    "`let gap = EXPRESSION` (m)",
                                    energy_.name));
  }

  Quantity typed(const Expression& e, const Quantities& known) {
    names(e, known);
    return type_of(e, known);
  }

  void names(const Expression& e, const Quantities& known) {
    if (e.kind == Kind::name && e.text != "pi") {
      used_.insert(e.text);
      if (!known.contains(e.text)) unknown(e, known);
    }
    if (e.kind == Kind::call && declared_.contains(e.text))
      throw SourceError(e.place, fmt::format("'{}' is not a function; products are written with '*'", e.text));
    if (e.kind == Kind::call && e.text == "stretches" && energy_.kind != Energy::Kind::density)
      throw SourceError(e.place, "'stretches' belongs to a density: they are the singular values of its F");
    for (const ExpressionPtr& argument : e.arguments) names(*argument, known);
  }

  [[noreturn]] void unknown(const Expression& e, const Quantities& known) const {
    const auto later = declared_.find(e.text);
    if (later != declared_.end())
      throw SourceError(e.place, fmt::format("'{}' is used before it is given in line {}", e.text, later->second.line));
    const auto& functions = function_names();
    if (std::find(functions.begin(), functions.end(), e.text) != functions.end())
      throw SourceError(e.place, fmt::format("'{}' is a function; expected '(' and its arguments", e.text));
    std::string message = fmt::format("unknown name '{}'", e.text);
    if (e.text == "F") throw SourceError(e.place, message + "; F is known in a density, a stencil energy has points");
    if (e.text == "T") throw SourceError(e.place, message + "; a transpose is written A'");
    const std::string elsewhere = quantity_elsewhere(e.text, known.contains("F"));
    if (!elsewhere.empty()) throw SourceError(e.place, message + elsewhere);
    std::vector<std::string> candidates;
    for (const auto& [name, quantity] : known) candidates.push_back(name);
    const std::string nearest = did_you_mean(e.text, candidates);
    const bool few = nearest.empty() && !candidates.empty() && candidates.size() <= 12;
    throw SourceError(e.place,
                      message + nearest +
                          (few ? fmt::format("; known here are {}; a quantity is declared by `param NAME UNIT`, a part "
                                             "is named by `let`",
                                             fmt::join(candidates, ", "))
                               : ""));
  }

  void same_in_all_cases(const Let& let, const Quantity& q) {
    const auto [first, fresh] = case_lets_.emplace(let.name, std::pair(q, let.case_name));
    if (fresh) return;
    const auto& [other, other_case] = first->second;
    if (other.shape != q.shape)
      throw SourceError(let.place, fmt::format("'{}' has another shape than in the case '{}': expected {}, found {}",
                                               let.name, other_case, to_string(other.shape), to_string(q.shape)));
    const std::string conflict = unit_conflict(other, q);
    if (!conflict.empty())
      throw SourceError(let.place,
                        fmt::format("'{}' has another unit than in the case '{}': {}", let.name, other_case, conflict));
  }

  void check(const Condition& condition, const Quantities& known) {
    const Quantity left = typed(*condition.left, known);
    const Quantity right = typed(*condition.right, known);
    for (const auto& [side, expression] : {std::pair(&left, &condition.left), std::pair(&right, &condition.right)})
      if (!side->shape.scalar())
        throw SourceError(start_of(**expression),
                          fmt::format("a condition compares scalars, found {}", to_string(side->shape)));
    const std::string conflict = unit_conflict(left, right);
    if (!conflict.empty())
      throw SourceError(condition.place, "a condition needs the same unit on both sides: " + conflict);
  }

  std::string what() const {
    if (energy_.kind == Energy::Kind::barrier) return "a barrier";
    return (energy_.geometry.starts_with("e") ? "an " : "a ") + energy_.geometry +
           (energy_.kind == Energy::Kind::density ? " density" : " energy");
  }

  const char* value_text() const {
    if (energy_.geometry == "solid") return "an energy per volume (J/m^3)";
    if (energy_.geometry == "membrane") return "an energy per area (J/m^2)";
    if (energy_.geometry == "line") return "an energy per length (J/m)";
    return "an energy (J)";
  }

  void unused() {
    if (energy_.kind == Energy::Kind::barrier) {
      if (!used_.contains("gap") && !used_.contains("gap2"))
        throw SourceError(energy_.symbols[0].place, "a barrier is a function of 'gap' or 'gap2'; neither is used");
      used_.insert({"gap", "gap2"});
    }
    for (const Symbol& symbol : energy_.symbols)
      if (!used_.contains(symbol.name))
        throw SourceError(symbol.place, fmt::format("the {} '{}' is not used", to_string(symbol.role), symbol.name));
    for (const Let& let : energy_.lets)
      if (!used_.contains(let.name))
        throw SourceError(let.place, fmt::format("the {} '{}' is not used",
                                                 let.name == energy_.constraint ? "constraint"
                                                 : let.case_name.empty()        ? "let"
                                                                                : "let of a case",
                                                 let.name));
  }

  const Energy& energy_;
  std::map<std::string, Place> declared_;
  std::set<std::string> used_;
  std::map<std::string, std::pair<Quantity, std::string>> case_lets_;
};

}  // namespace

Unit value_unit(const Energy& energy) {
  static const Unit joule = parse_unit("J").unit, metre = parse_unit("m").unit;
  if (energy.kind != Energy::Kind::density) return joule;
  const int dimension = energy.geometry == "solid" ? 3 : energy.geometry == "membrane" ? 2 : 1;
  return joule / pow(metre, {dimension, 1});
}

void analyse(const Energy& energy) { Analysis(energy).run(); }

}  // namespace ergon
