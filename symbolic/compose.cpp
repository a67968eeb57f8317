#include "symbolic/compose.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "symbolic/analyse.h"

namespace ergon {
namespace {

using Kind = Expression::Kind;

ExpressionPtr node(Kind kind, const std::string& text, std::vector<ExpressionPtr> arguments, const Place& place) {
  return std::make_shared<Expression>(Expression{kind, text, std::move(arguments), place, {}, {}});
}

ExpressionPtr name(const std::string& text, const Place& place) { return node(Kind::name, text, {}, place); }
ExpressionPtr number(const std::string& text, const Place& place) { return node(Kind::number, text, {}, place); }

ExpressionPtr renamed(const ExpressionPtr& e, const std::string& from, const std::string& to) {
  std::vector<ExpressionPtr> arguments;
  for (const ExpressionPtr& argument : e->arguments) arguments.push_back(renamed(argument, from, to));
  return node(e->kind, e->kind == Kind::name && e->text == from ? to : e->text, std::move(arguments), e->place);
}

bool uses(const Expression& e, const std::string& what) {
  if (e.kind == Kind::name && e.text == what) return true;
  return std::any_of(e.arguments.begin(), e.arguments.end(),
                     [&](const auto& argument) { return uses(*argument, what); });
}

bool uses(const Energy& energy, const std::string& what) {
  auto in = [&](const ExpressionPtr& e) { return e && uses(*e, what); };
  auto in_condition = [&](const Condition& c) { return in(c.left) || in(c.right); };
  return in(energy.value) ||
         std::any_of(energy.lets.begin(), energy.lets.end(), [&](const Let& let) { return in(let.expression); }) ||
         std::any_of(energy.active.begin(), energy.active.end(), in_condition) ||
         std::any_of(energy.require.begin(), energy.require.end(), in_condition);
}

bool gives(const Energy& energy, const std::string& what) {
  return std::any_of(energy.lets.begin(), energy.lets.end(), [&](const Let& let) { return let.name == what; });
}

std::string joined(const std::string& a, const char* between, const std::string& b) {
  return a.empty() || b.empty() ? a + b : a + between + b;
}

// Everything that a distance brings, under other names for its gap.
Energy stencil_of(const Energy& distance, const std::string& prefix) {
  Energy out = distance;
  out.kind = Energy::Kind::stencil;
  if (prefix.empty()) return out;
  auto new_names = [&](const ExpressionPtr& e) { return renamed(renamed(e, "gap", prefix), "gap2", prefix + "2"); };
  for (Let& let : out.lets) {
    if (let.name == "gap") let.name = prefix;
    if (let.name == "gap2") let.name = prefix + "2";
    let.expression = new_names(let.expression);
  }
  for (Condition& c : out.require) c.left = new_names(c.left), c.right = new_names(c.right);
  return out;
}

// A law needs one form of the gap, a distance may give two.
void drop_unused_forms(Energy& energy) {
  for (const char* form : {"gap", "gap2", "distance", "distance2"})
    if (!uses(energy, form)) std::erase_if(energy.lets, [&](const Let& let) { return let.name == form; });
}

}  // namespace

Energy compose(const Energy& barrier, const Energy& distance, Offset offset) {
  if (barrier.kind != Energy::Kind::barrier || distance.kind != Energy::Kind::distance)
    throw std::invalid_argument("compose: expected a barrier and a distance");
  const bool thick = offset == Offset::per_stencil;
  // An offset is taken off the distance itself.
  const std::string given = thick ? "distance" : "gap";
  Energy out = stencil_of(distance, thick ? given : "");
  const std::string suffix = ":" + distance.name + (thick ? ":offset" : "");
  const Place& at = barrier.symbols[0].place;  // of what no text says: the header of the law
  auto let = [&](const std::string& what, ExpressionPtr e) { out.lets.push_back({what, "", std::move(e), at}); };

  const bool needs_gap = thick || uses(barrier, "gap");
  if (needs_gap && !gives(distance, "gap")) let(given, node(Kind::call, "sqrt", {name(given + "2", at)}, at));
  if (thick) {
    out.symbols.push_back(
        {"offset", Role::rest, {}, parse_unit("m").unit, {0, Range{}.upper, false, true}, "distance at contact", at});
    let("gap", node(Kind::subtract, "-", {name(given, at), name("offset", at)}, at));
  }
  if (uses(barrier, "gap2") && (thick || !gives(distance, "gap2")))
    let("gap2", node(Kind::power, "^", {name("gap", at), number("2", at)}, at));
  const bool by_square = !thick && (!needs_gap || !gives(distance, "gap")) && gives(distance, "gap2");
  out.require.insert(out.require.begin(), {number("0", at), name(by_square ? "gap2" : "gap", at), at});

  out.name = barrier.name + suffix;
  out.file = barrier.file + suffix;
  out.summary = joined(barrier.summary, " ", distance.summary);
  out.cite = joined(barrier.cite, "; ", distance.cite);
  out.text = barrier.text + "\n" + distance.text;
  out.part_of = joined(barrier.part_of, "; ", distance.part_of);
  out.fixed_frame = barrier.fixed_frame || distance.fixed_frame;
  for (const Symbol& symbol : barrier.symbols)
    if (symbol.role != Role::dof) out.symbols.push_back(symbol);
  out.lets.insert(out.lets.end(), barrier.lets.begin(), barrier.lets.end());
  out.active = barrier.active;
  out.require.insert(out.require.end(), barrier.require.begin(), barrier.require.end());
  out.value = barrier.value;
  if (gives(distance, "weight"))
    out.value = node(Kind::multiply, "*", {name("weight", at), out.value}, out.value->place);
  drop_unused_forms(out);
  analyse(out);
  return out;
}

ComposedName split_name(std::string_view written) {
  ComposedName out;
  constexpr std::string_view suffix = ".energy:";
  const size_t file = written.find(suffix);
  const size_t colon = file == std::string_view::npos ? written.find(':') : file + suffix.size() - 1;
  out.law = written.substr(0, colon);
  if (colon == std::string_view::npos) return out;
  out.distance = written.substr(colon + 1);
  const size_t second = out.distance.find(':');
  if (second != std::string::npos) {
    if (out.distance.substr(second) != ":offset")
      throw std::invalid_argument("expected LAW:DISTANCE or LAW:DISTANCE:offset, found '" + std::string(written) + "'");
    out.offset = Offset::per_stencil;
    out.distance.resize(second);
  }
  if (out.law.empty() || out.distance.empty())
    throw std::invalid_argument("expected LAW:DISTANCE or LAW:DISTANCE:offset, found '" + std::string(written) + "'");
  return out;
}

std::vector<Energy> energies_below(const std::string& folder) {
  std::vector<Energy> out, barriers, distances;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".energy") continue;
    Energy energy = read_energy(entry.path().string());
    (energy.complete()                      ? out
     : energy.kind == Energy::Kind::barrier ? barriers
                                            : distances)
        .push_back(std::move(energy));
  }
  for (const Energy& barrier : barriers)
    for (const Energy& distance : distances)
      for (const Offset offset : {Offset::none, Offset::per_stencil}) out.push_back(compose(barrier, distance, offset));
  std::sort(out.begin(), out.end(), [](const Energy& a, const Energy& b) { return a.name < b.name; });
  return out;
}

}  // namespace ergon
