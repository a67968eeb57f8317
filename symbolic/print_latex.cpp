#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "symbolic/print.h"

namespace ergon {
namespace {

using Kind = Expression::Kind;

const std::vector<std::string> greek = {"alpha", "beta",   "gamma", "delta", "epsilon", "eta", "theta",
                                        "kappa", "lambda", "mu",    "nu",    "xi",      "rho", "pi",
                                        "sigma", "tau",    "phi",   "psi",   "omega"};

std::string escaped(const std::string& name) {
  std::string text;
  for (const char c : name) text += c == '_' ? std::string("\\_") : std::string(1, c);
  return text;
}

// x0 -> x_{0}, dhat -> \hat{d}, mu -> \mu, la -> \lambda; what has rows is bold.
std::string name_latex(const std::string& name, bool bold) {
  const size_t digits = name.find_last_not_of("0123456789") + 1;
  if (digits < name.size()) return name_latex(name.substr(0, digits), bold) + "_{" + name.substr(digits) + "}";
  if (name == "la") return "\\lambda";
  if (std::find(greek.begin(), greek.end(), name) != greek.end()) return "\\" + name;
  if (name.size() > 3 && name.ends_with("hat"))
    return "\\hat{" + name_latex(name.substr(0, name.size() - 3), bold) + "}";
  if (name.size() == 1) return bold ? "\\mathbf{" + name + "}" : name;
  return (bold ? "\\mathbf{" : "\\mathrm{") + escaped(name) + "}";
}

std::string bracketed(const std::string& text) { return "\\left(" + text + "\\right)"; }

bool is_sum(const Expression& e) { return e.kind == Kind::add || e.kind == Kind::subtract; }

// An operand of a product.
std::string factor(const Expression& e) {
  const std::string text = to_latex(e);
  return is_sum(e) || e.kind == Kind::negate ? bracketed(text) : text;
}

bool starts_with_number(const Expression& e) {
  return e.kind == Kind::number ||
         ((e.kind == Kind::multiply || e.kind == Kind::power) && starts_with_number(*e.arguments[0]));
}

// The base of a power, a transpose or an index.
std::string base(const Expression& e) {
  const std::string text = to_latex(e);
  const bool plain = e.kind == Kind::name || e.kind == Kind::number || e.kind == Kind::literal;
  const bool fenced = e.kind == Kind::call && (e.text == "norm" || e.text == "abs");
  return plain || fenced ? text : bracketed(text);
}

std::string matrix(const std::vector<std::string>& by_rows, size_t columns) {
  std::string text = "\\begin{pmatrix}";
  for (size_t i = 0; i < by_rows.size(); ++i) {
    if (i > 0) text += i % columns == 0 ? " \\\\ " : " & ";
    text += by_rows[i];
  }
  return text + "\\end{pmatrix}";
}

std::string call_latex(const Expression& e) {
  const std::string& f = e.text;
  std::vector<std::string> a;
  for (const ExpressionPtr& argument : e.arguments) a.push_back(to_latex(*argument));
  if (f == "sqrt") return "\\sqrt{" + a[0] + "}";
  if (f == "abs") return "\\left|" + a[0] + "\\right|";
  if (f == "norm") return "\\left\\|" + a[0] + "\\right\\|";
  if (f == "norm2") return "\\left\\|" + a[0] + "\\right\\|^2";
  if (f == "dot") return bracketed(factor(*e.arguments[0]) + " \\cdot " + factor(*e.arguments[1]));
  if (f == "cross") return bracketed(factor(*e.arguments[0]) + " \\times " + factor(*e.arguments[1]));
  if (f == "outer") return bracketed(factor(*e.arguments[0]) + " \\otimes " + factor(*e.arguments[1]));
  if (f == "inverse") return base(*e.arguments[0]) + "^{-1}";
  if (f == "transpose") return base(*e.arguments[0]) + "^{\\mathsf{T}}";
  if (f == "pow") return base(*e.arguments[0]) + "^{" + a[1] + "}";
  if (f == "identity") return "\\mathbf{I}";
  if (f == "columns") return matrix(a, a.size());
  static const std::map<std::string, std::string> named = {{"det", "\\det"},     {"log", "\\log"},     {"exp", "\\exp"},
                                                           {"sin", "\\sin"},     {"cos", "\\cos"},     {"tan", "\\tan"},
                                                           {"asin", "\\arcsin"}, {"acos", "\\arccos"}, {"min", "\\min"},
                                                           {"max", "\\max"},     {"atan", "\\arctan"}};
  const auto found = named.find(f);
  const std::string name = found == named.end() ? "\\operatorname{" + f + "}" : found->second;
  return name + bracketed(fmt::format("{}", fmt::join(a, ", ")));
}

}  // namespace

std::string to_latex(const Expression& e) {
  const auto& a = e.arguments;
  switch (e.kind) {
    case Kind::number: {
      const size_t exponent = e.text.find_first_of("eE");
      if (exponent == std::string::npos) return e.text;
      return fmt::format("{} \\cdot 10^{{{}}}", e.text.substr(0, exponent), std::stoi(e.text.substr(exponent + 1)));
    }
    case Kind::name:
      return name_latex(e.text, !e.shape.scalar());
    case Kind::negate:
      return "-" + factor(*a[0]);
    case Kind::add:
      return to_latex(*a[0]) + " + " + (a[1]->kind == Kind::negate ? bracketed(to_latex(*a[1])) : to_latex(*a[1]));
    case Kind::subtract:
      return to_latex(*a[0]) + " - " + (is_sum(*a[1]) ? bracketed(to_latex(*a[1])) : factor(*a[1]));
    case Kind::multiply:
      return (is_sum(*a[0]) ? bracketed(to_latex(*a[0])) : to_latex(*a[0])) +
             (starts_with_number(*a[1]) ? " \\cdot " : " \\, ") + factor(*a[1]);
    case Kind::divide:
      return "\\frac{" + to_latex(*a[0]) + "}{" + to_latex(*a[1]) + "}";
    case Kind::power:
      return base(*a[0]) + "^{" + to_latex(*a[1]) + "}";
    case Kind::transpose:
      return base(*a[0]) + "^{\\mathsf{T}}";
    case Kind::index: {
      std::string indices = a[1]->text;
      if (a.size() == 3) indices += "," + a[2]->text;
      return base(*a[0]) + "_{" + indices + "}";
    }
    case Kind::literal: {
      std::vector<std::string> items;
      for (const ExpressionPtr& item : a) items.push_back(to_latex(*item));
      return matrix(items, static_cast<size_t>(e.shape.cols));
    }
    default:
      return call_latex(e);
  }
}

std::string formula_latex(const Energy& energy) {
  std::string text = "\\begin{align*}\n";
  for (const Let& let : energy.lets) {
    text += name_latex(let.name, !let.expression->shape.scalar()) + " &= " + to_latex(*let.expression);
    if (!let.case_name.empty()) text += " && \\text{(" + escaped(let.case_name) + ")}";
    text += " \\\\\n";
  }
  for (const Condition& c : energy.active)
    text += to_latex(*c.left) + " &< " + to_latex(*c.right) + " && \\text{(active)} \\\\\n";
  for (const Condition& c : energy.require)
    text += to_latex(*c.left) + " &< " + to_latex(*c.right) + " && \\text{(required)} \\\\\n";
  if (energy.natural)
    text += "\\mathbf{F}_\\text{natural} &= " + to_latex(*energy.natural) + " && \\text{(no stress)} \\\\\n";
  for (const Let& update : energy.updates)
    text += name_latex(update.name, !update.expression->shape.scalar()) + " &\\leftarrow " +
            to_latex(*update.expression) + " \\\\\n";
  if (energy.value)
    text +=
        (energy.kind == Energy::Kind::density ? "\\Psi" : "E") + std::string(" &= ") + to_latex(*energy.value) + "\n";
  else
    text.erase(text.rfind(" \\\\"), 3);
  return text + "\\end{align*}\n";
}

}  // namespace ergon
