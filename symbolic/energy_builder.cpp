#include "symbolic/energy_builder.h"

#include <fmt/format.h>

#include "symbolic/energy_parser.h"
#include "symbolic/tokens.h"

namespace ergon {

EnergyBuilder::EnergyBuilder(const std::string& kind, const std::string& name, const std::string& geometry, Where where)
    : file_(where.file) {
  add(kind + " " + name + (geometry.empty() ? "" : " " + geometry), where);
}

Expr EnergyBuilder::dof(const std::string& name, const std::string& unit, Where where) {
  return declare("dof", name + " " + unit, where);
}

Expr EnergyBuilder::param(const std::string& name, const std::string& unit, const std::string& range,
                          const std::string& help, Where where) {
  return declare("param", fmt::format("{} {} {} {}", name, unit, range, help), where);
}

Expr EnergyBuilder::rest(const std::string& name, const std::string& unit, const std::string& range,
                         const std::string& help, Where where) {
  return declare("rest", fmt::format("{} {} {} {}", name, unit, range, help), where);
}

Expr EnergyBuilder::lag(const std::string& name, const std::string& unit, const std::string& range,
                        const std::string& help, Where where) {
  return declare("lag", fmt::format("{} {} {} {}", name, unit, range, help), where);
}

Expr EnergyBuilder::let(const std::string& name, const Operand& expression) {
  add("let " + name + " = ", expression.where, &expression);
  return Expr::named(name);
}

Expr EnergyBuilder::case_let(const std::string& case_name, const std::string& name, const Operand& expression) {
  add(fmt::format("case {} {} = ", case_name, name), expression.where, &expression);
  return Expr::named(name);
}

Expr EnergyBuilder::constraint(const std::string& name, const Operand& expression) {
  add("constraint " + name + " = ", expression.where, &expression);
  return Expr::named(name);
}

void EnergyBuilder::active(const Inequality& condition, Where where) {
  const Operand text(condition.text, where);
  add("active ", where, &text);
}

void EnergyBuilder::require(const Inequality& condition, Where where) {
  const Operand text(condition.text, where);
  add("require ", where, &text);
}

void EnergyBuilder::update(const Operand& lag, const Operand& expression) {
  add("update " + lag.expr.text() + " = ", lag.where, &expression);
}

void EnergyBuilder::natural(const Operand& expression) { add("natural ", expression.where, &expression); }
void EnergyBuilder::value(const Operand& expression) { add("value ", expression.where, &expression); }

void EnergyBuilder::summary(const std::string& text, Where where) {
  check(text, where);
  statements_.summary += (statements_.summary.empty() ? "" : " ") + text;
}

void EnergyBuilder::cite(const std::string& text, Where where) { add("cite " + text, where); }
void EnergyBuilder::part(const std::string& text, Where where) { add("part " + text, where); }
void EnergyBuilder::load(const Operand& param) { add("load " + param.expr.text(), param.where); }
void EnergyBuilder::fixed_frame(Where where) { add("frame fixed", where); }

Energy EnergyBuilder::build() const { return energy_of(statements_, text(), file_); }

std::string EnergyBuilder::text() const {
  std::string out = statements_.summary.empty() ? "" : "# " + statements_.summary + "\n";
  for (const Statement& statement : statements_.all) out += statement.text + "\n";
  return out;
}

void EnergyBuilder::add(const std::string& words, const Where& where, const Operand* expression) {
  Statement statement{words, {{0, place_of(where)}}};
  if (expression != nullptr) {
    for (const auto& [offset, place] : expression->expr.written())
      statement.lines.emplace_back(words.size() + offset, place);
    statement.text += expression->expr.text();
  }
  check(statement.text, where);
  statement.text.erase(statement.text.find_last_not_of(' ') + 1);
  statements_.all.push_back(std::move(statement));
}

Expr EnergyBuilder::declare(const std::string& keyword, const std::string& words, const Where& where) {
  add(keyword + " " + words, where);
  return Expr::named(words.substr(0, end_of_name(words, 0)));
}

void EnergyBuilder::check(const std::string& text, const Where& where) const {
  if (text.find_first_of("#\n") != std::string::npos)
    throw SourceError(place_of(where), "a '#' begins a comment and a line break ends a statement; leave them out of '" +
                                           text.substr(0, text.find('\n')) + "'");
}

}  // namespace ergon
