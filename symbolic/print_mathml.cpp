#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "symbolic/print.h"

namespace ergon {
namespace {

using Kind = Expression::Kind;

std::string row(const std::string& text) { return "<mrow>" + text + "</mrow>"; }
std::string sign(const std::string& text) { return "<mo>" + text + "</mo>"; }
std::string bracketed(const std::string& text) { return row(sign("(") + text + sign(")")); }
std::string bars(const std::string& bar, const std::string& text) { return row(sign(bar) + text + sign(bar)); }
std::string raised(const std::string& base, const std::string& exponent) {
  return "<msup>" + base + exponent + "</msup>";
}

// Letters of Greek names as they are written; "la" is short for lambda.
std::string letter(const std::string& name) {
  static const std::map<std::string, std::string> greek = {
      {"alpha", "α"}, {"beta", "β"}, {"gamma", "γ"}, {"delta", "δ"}, {"epsilon", "ε"}, {"eta", "η"},   {"theta", "θ"},
      {"kappa", "κ"}, {"la", "λ"},   {"mu", "μ"},    {"nu", "ν"},    {"xi", "ξ"},      {"rho", "ρ"},   {"pi", "π"},
      {"sigma", "σ"}, {"tau", "τ"},  {"phi", "φ"},   {"psi", "ψ"},   {"omega", "ω"},   {"lambda", "λ"}};
  const auto found = greek.find(name);
  return found == greek.end() ? name : found->second;
}

// What has rows is bold; digits at the end are an index.
std::string name_mathml(const std::string& name, bool bold) {
  const size_t digits = name.find_last_not_of("0123456789") + 1;
  const std::string text = letter(name.substr(0, digits));
  const std::string base = bold ? "<mi style=\"font-weight:bold\">" + text + "</mi>" : "<mi>" + text + "</mi>";
  return digits < name.size() ? "<msub>" + base + "<mn>" + name.substr(digits) + "</mn></msub>" : base;
}

bool is_a_sum(const Expression& e) { return e.kind == Kind::add || e.kind == Kind::subtract; }

std::string factor_of(const Expression& e) {
  return is_a_sum(e) || e.kind == Kind::negate ? bracketed(to_mathml(e)) : to_mathml(e);
}

std::string base_of(const Expression& e) {
  const bool plain = e.kind == Kind::name || e.kind == Kind::number || e.kind == Kind::literal;
  const bool fenced = e.kind == Kind::call && (e.text == "norm" || e.text == "abs");
  return plain || fenced ? to_mathml(e) : bracketed(to_mathml(e));
}

std::string table(const std::vector<std::string>& by_rows, size_t columns) {
  std::string text;
  for (size_t i = 0; i < by_rows.size(); ++i) {
    if (i % columns == 0) text += i == 0 ? "<mtr>" : "</mtr><mtr>";
    text += "<mtd>" + by_rows[i] + "</mtd>";
  }
  return row(sign("(") + "<mtable>" + text + "</mtr></mtable>" + sign(")"));
}

std::string call_mathml(const Expression& e) {
  const std::string& f = e.text;
  std::vector<std::string> a;
  for (const ExpressionPtr& argument : e.arguments) a.push_back(to_mathml(*argument));
  const auto between = [&](const char* mark) {
    return bracketed(factor_of(*e.arguments[0]) + sign(mark) + factor_of(*e.arguments[1]));
  };
  if (f == "sqrt") return "<msqrt>" + a[0] + "</msqrt>";
  if (f == "abs") return bars("|", a[0]);
  if (f == "norm") return bars("‖", a[0]);
  if (f == "norm2") return raised(bars("‖", a[0]), "<mn>2</mn>");
  if (f == "dot") return between("·");
  if (f == "cross") return between("×");
  if (f == "outer") return between("⊗");
  if (f == "inverse") return raised(base_of(*e.arguments[0]), row(sign("−") + "<mn>1</mn>"));
  if (f == "transpose") return raised(base_of(*e.arguments[0]), "<mi>T</mi>");
  if (f == "pow") return raised(base_of(*e.arguments[0]), row(a[1]));
  if (f == "identity") return name_mathml("I", true);
  if (f == "columns") return table(a, a.size());
  return row("<mi>" + f + "</mi>" + bracketed(fmt::format("{}", fmt::join(a, sign(",")))));
}

std::string number_mathml(const std::string& text) {
  const size_t exponent = text.find_first_of("eE");
  if (exponent == std::string::npos) return "<mn>" + text + "</mn>";
  const int power = std::stoi(text.substr(exponent + 1));
  return row("<mn>" + text.substr(0, exponent) + "</mn>" + sign("·") +
             raised("<mn>10</mn>", row((power < 0 ? sign("−") : "") + fmt::format("<mn>{}</mn>", std::abs(power)))));
}

std::string line(const std::string& left, const std::string& relation, const std::string& right,
                 const std::string& remark) {
  return "<mtr><mtd style=\"text-align:right\">" + left + "</mtd><mtd>" + sign(relation) +
         "</mtd><mtd style=\"text-align:left\">" + right + "</mtd><mtd>" +
         (remark.empty() ? "" : "<mtext>" + remark + "</mtext>") + "</mtd></mtr>\n";
}

}  // namespace

std::string to_mathml(const Expression& e) {
  const auto& a = e.arguments;
  switch (e.kind) {
    case Kind::number:
      return number_mathml(e.text);
    case Kind::name:
      return name_mathml(e.text, !e.shape.scalar());
    case Kind::negate:
      return row(sign("−") + factor_of(*a[0]));
    case Kind::add:
      return row(to_mathml(*a[0]) + sign("+") + (a[1]->kind == Kind::negate ? factor_of(*a[1]) : to_mathml(*a[1])));
    case Kind::subtract:
      return row(to_mathml(*a[0]) + sign("−") + factor_of(*a[1]));
    case Kind::multiply:
      return row((is_a_sum(*a[0]) ? bracketed(to_mathml(*a[0])) : to_mathml(*a[0])) +
                 sign(a[1]->kind == Kind::number ? "·" : "&#8290;") + factor_of(*a[1]));
    case Kind::divide:
      return "<mfrac>" + row(to_mathml(*a[0])) + row(to_mathml(*a[1])) + "</mfrac>";
    case Kind::power:
      return raised(base_of(*a[0]), row(to_mathml(*a[1])));
    case Kind::transpose:
      return raised(base_of(*a[0]), "<mi>T</mi>");
    case Kind::index: {
      std::string indices = to_mathml(*a[1]);
      if (a.size() == 3) indices += sign(",") + to_mathml(*a[2]);
      return "<msub>" + base_of(*a[0]) + row(indices) + "</msub>";
    }
    case Kind::literal: {
      std::vector<std::string> items;
      for (const ExpressionPtr& item : a) items.push_back(to_mathml(*item));
      return table(items, static_cast<size_t>(e.shape.cols));
    }
    default:
      return call_mathml(e);
  }
}

std::string formula_mathml(const Energy& energy) {
  std::string rows;
  for (const Let& let : energy.lets)
    rows +=
        line(name_mathml(let.name, !let.expression->shape.scalar()), "=", to_mathml(*let.expression), let.case_name);
  for (const Condition& c : energy.active) rows += line(to_mathml(*c.left), "&lt;", to_mathml(*c.right), "active");
  for (const Condition& c : energy.require) rows += line(to_mathml(*c.left), "&lt;", to_mathml(*c.right), "required");
  if (energy.natural)
    rows += line("<msub>" + name_mathml("F", true) + "<mtext>natural</mtext></msub>", "=", to_mathml(*energy.natural),
                 "no stress");
  for (const Let& update : energy.updates)
    rows += line(name_mathml(update.name, !update.expression->shape.scalar()), "←", to_mathml(*update.expression),
                 "after each step");
  if (energy.value)
    rows += line(energy.kind == Energy::Kind::density ? "<mi>Ψ</mi>" : "<mi>E</mi>", "=", to_mathml(*energy.value), "");
  return "<math xmlns=\"http://www.w3.org/1998/Math/MathML\" display=\"block\"><mtable>\n" + rows +
         "</mtable></math>\n";
}

}  // namespace ergon
