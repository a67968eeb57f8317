#include "symbolic/print.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "symbolic/declaration.h"

namespace ergon {
namespace {

using Kind = Expression::Kind;

enum Level { sum = 1, product, unary, power, postfix, atom };

Level level_of(const Expression& e) {
  switch (e.kind) {
    case Kind::add:
    case Kind::subtract:
      return sum;
    case Kind::multiply:
    case Kind::divide:
      return product;
    case Kind::negate:
      return unary;
    case Kind::power:
      return power;
    case Kind::transpose:
    case Kind::index:
      return postfix;
    default:
      return atom;
  }
}

std::string within(const Expression& e, int least) {
  const std::string text = to_text(e);
  return level_of(e) < least ? "(" + text + ")" : text;
}

std::string list(const std::vector<ExpressionPtr>& items, size_t first = 0) {
  std::vector<std::string> texts;
  for (size_t i = first; i < items.size(); ++i) texts.push_back(to_text(*items[i]));
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string literal_text(const Expression& e) {
  std::string text = "[";
  // A vector is written as one row.
  const size_t per_row = static_cast<size_t>(e.shape.cols == 1 ? e.shape.rows : e.shape.cols);
  for (size_t i = 0; i < e.arguments.size(); ++i) {
    if (i > 0) text += i % per_row == 0 ? "; " : ", ";
    text += to_text(*e.arguments[i]);
  }
  return text + "]";
}

std::string padded(const std::string& text, size_t width) {
  return text + std::string(width > text.size() ? width - text.size() : 0, ' ');
}

}  // namespace

std::string to_text(const Expression& e) {
  const auto& a = e.arguments;
  switch (e.kind) {
    case Kind::number:
    case Kind::name:
      return e.text;
    case Kind::negate:
      return "-" + within(*a[0], unary);
    case Kind::add:
      return within(*a[0], sum) + " + " + within(*a[1], product);
    case Kind::subtract:
      return within(*a[0], sum) + " - " + within(*a[1], product);
    case Kind::multiply:
      return within(*a[0], product) + "*" + within(*a[1], unary);
    case Kind::divide:
      return within(*a[0], product) + "/" + within(*a[1], unary);
    case Kind::power:
      return within(*a[0], postfix) + "^" + within(*a[1], unary);
    case Kind::transpose:
      return within(*a[0], postfix) + "'";
    case Kind::index:
      return within(*a[0], postfix) + "[" + list(a, 1) + "]";
    case Kind::literal:
      return literal_text(e);
    default:
      return e.text + "(" + list(a) + ")";
  }
}

std::string formula_text(const Energy& energy) {
  std::string text;
  for (const Let& let : energy.lets) {
    const char* keyword = let.name == energy.constraint ? "constraint" : "let";
    text += let.case_name.empty() ? fmt::format("{} {} = ", keyword, let.name)
                                  : fmt::format("case {} {} = ", let.case_name, let.name);
    text += to_text(*let.expression) + "\n";
  }
  for (const Condition& c : energy.active) text += fmt::format("active {} < {}\n", to_text(*c.left), to_text(*c.right));
  for (const Condition& c : energy.require)
    text += fmt::format("require {} < {}\n", to_text(*c.left), to_text(*c.right));
  if (energy.natural) text += "natural " + to_text(*energy.natural) + "\n";
  for (const Let& update : energy.updates)
    text += fmt::format("update {} = {}\n", update.name, to_text(*update.expression));
  return energy.value ? text + "value " + to_text(*energy.value) + "\n" : text;
}

std::string symbol_table(const Energy& energy) {
  using Row = std::array<std::string, 6>;
  std::vector<Row> rows = {{"name", "role", "shape", "unit", "range", "meaning"}};
  for (const Symbol& s : energy.symbols) {
    const bool any = s.range == Range{};
    rows.push_back({s.name, std::string(to_string(s.role)), to_string(s.shape), to_string(s.unit),
                    any ? "any" : to_string(s.range), s.help});
  }
  std::array<size_t, 6> widths{};
  for (const Row& row : rows)
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::string text;
  for (const Row& row : rows) {
    std::string line;
    for (size_t i = 0; i < row.size(); ++i) line += padded(row[i], widths[i] + 2);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}  // namespace ergon
