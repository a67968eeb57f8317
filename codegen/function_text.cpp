#include "codegen/function_text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <fmt/format.h>

namespace ergon {
namespace {

constexpr size_t kInlineLength = 60;  // characters; a longer expression becomes a statement

enum Precedence { kSum = 1, kProduct = 2, kUnary = 3, kAtom = 4 };

struct Text {
  std::string text;
  int precedence = kAtom;
};

class Writer {
 public:
  Writer(const Program& p, const Slots& slots, bool scalar, bool read_uniforms, bool read_elements,
         const std::string& real)
      : p_(p),
        slots_(slots),
        real_(real),
        scalar_(scalar),
        single_(real == "float"),
        read_uniforms_(read_uniforms),
        read_elements_(read_elements) {}

  FunctionText write(const std::vector<Output>& outputs, const std::string& raw_inputs) {
    raw_inputs_ = raw_inputs;
    std::vector<int> roots;
    for (const Output& o : outputs) roots.push_back(o.value);
    static const std::vector<int> none;
    std::vector<const std::vector<int>*> given;
    if (read_uniforms_) given.push_back(&slots_.uniform);
    if (read_elements_) given.push_back(&slots_.element);
    for (int i : needed(p_, roots, given)) {
      if (from_slot(i)) continue;
      for (int o : {p_[i].a, p_[i].b, p_[i].c})
        if (o >= 0) uses_[o]++;
      if (is_operation(p_[i])) result_.instructions.push_back(i);
    }
    for (int r : roots) uses_[r]++;
    for (int i : inputs_in_order(needed(p_, roots, given))) form(i);
    for (const Output& o : outputs) {
      for (int i : needed(p_, {o.value}, given)) form(i);
      Text t = texts_.at(o.value);
      bool widen = !scalar_ && p_[o.value].lifetime <= Lifetime::uniform;
      result_.body += fmt::format("  {} = {};\n", o.target, widen ? widened(t) : t.text);
    }
    return std::move(result_);
  }

 private:
  std::vector<int> inputs_in_order(const std::vector<int>& code) const {
    std::vector<int> inputs;
    for (int i : code)
      if (p_[i].op == Opcode::input && !from_slot(i)) inputs.push_back(i);
    std::sort(inputs.begin(), inputs.end(), [&](int a, int b) {
      return std::pair(p_[a].source, p_[a].index) < std::pair(p_[b].source, p_[b].index);
    });
    return inputs;
  }

  bool from_slot(int i) const {
    return (read_uniforms_ && slots_.uniform[static_cast<size_t>(i)] >= 0) ||
           (read_elements_ && slots_.element[static_cast<size_t>(i)] >= 0);
  }

  static std::string widened(const Text& t) {
    return t.precedence >= kProduct ? t.text + " - V{}" : "(" + t.text + ") - V{}";
  }

  std::string vector_argument(int i) {
    const Text& t = texts_.at(i);
    return !scalar_ && p_[i].lifetime <= Lifetime::uniform ? widened(t) : t.text;
  }

  std::string wrapped(int i, int least) {
    const Text& t = texts_.at(i);
    return t.precedence >= least ? t.text : "(" + t.text + ")";
  }

  Text expression(int i) {
    const Instruction& n = p_[i];
    size_t k = static_cast<size_t>(i);
    if (read_uniforms_ && slots_.uniform[k] >= 0) return {fmt::format("u[{}]", slots_.uniform[k])};
    if (read_elements_ && slots_.element[k] >= 0) return {fmt::format("e[{}]", slots_.element[k])};
    switch (n.op) {
      case Opcode::constant:
        return {literal(n.constant, single_), n.constant < 0 ? kUnary : kAtom};
      case Opcode::input: {
        if (n.source == Source::negative) return {"negative"};
        const char* array = n.source == Source::q         ? "q"
                            : n.source == Source::stretch ? "s"
                            : n.source == Source::param   ? "params"
                                                          : raw_inputs_.c_str();
        return {fmt::format("{}[{}]", array, n.index)};
      }
      case Opcode::add:
        return {wrapped(n.a, kSum) + " + " + wrapped(n.b, kSum), kSum};
      case Opcode::subtract:
        return {wrapped(n.a, kSum) + " - " + wrapped(n.b, kProduct), kSum};
      case Opcode::multiply:
        return {wrapped(n.a, kProduct) + "*" + wrapped(n.b, kProduct), kProduct};
      case Opcode::divide:
        return {wrapped(n.a, kProduct) + "/" + wrapped(n.b, kAtom), kProduct};
      case Opcode::negate:
        return {"-" + wrapped(n.a, kAtom), kUnary};
      case Opcode::sqrt:
        return {function_prefix(n) + "sqrt(" + texts_.at(n.a).text + ")"};
      case Opcode::call: {
        std::string text = function_prefix(n) + name_of(n.call) + "(";
        text += vector_argument(n.a);
        for (int o : {n.b, n.c})
          if (o >= 0) text += ", " + vector_argument(o);
        return {text + ")"};
      }
    }
    return {};
  }

  // Functions of one number are those of doubles.
  std::string function_prefix(const Instruction& n) const {
    if (!scalar_ && n.lifetime > Lifetime::uniform) return "v_";
    return single_ ? "(float)s_" : "s_";
  }

  void form(int i) {
    if (texts_.count(i)) return;
    Text t = expression(i);
    const Instruction& n = p_[i];
    bool plain = n.op == Opcode::constant;
    bool inlined = plain || (uses_[i] == 1 && n.name.empty() && t.text.size() < kInlineLength && !from_slot(i));
    if (inlined) {
      texts_[i] = t;
      return;
    }
    std::string name = unique(n.name.empty() ? fmt::format("t{}", i) : n.name);
    const std::string type = scalar_ || n.lifetime <= Lifetime::uniform ? real_ : "V";
    result_.body += fmt::format("  const {} {} = {};\n", type, name, t.text);
    texts_[i] = {name};
  }

  std::string unique(const std::string& name) {
    static const std::set<std::string> taken = {
        "u",      "renewed", "e",     "q",        "s",       "blocks",  "projected", "changed", "negative", "V",
        "params", "raw",     "value", "gradient", "hessian", "require", "active",    "double",  "int",      "float",
        "char",   "const",   "if",    "else",     "for",     "while",   "do",        "new",     "delete",   "this",
        "and",    "or",      "not",   "xor",      "auto",    "long",    "short",     "class",   "struct",   "union",
        "void",   "return",  "case",  "switch",   "default", "break",   "static",    "extern",  "template", "typename"};
    std::string candidate = taken.count(name) ? name + "_" : name;
    while (!names_.insert(candidate).second) candidate += "_";
    return candidate;
  }

  const Program& p_;
  const Slots& slots_;
  std::string real_;
  bool scalar_, single_, read_uniforms_, read_elements_;
  std::string raw_inputs_;
  std::map<int, int> uses_;
  std::map<int, Text> texts_;
  std::set<std::string> names_;
  FunctionText result_;
};

}  // namespace

FunctionText function_text(const Program& program, const Slots& slots, const std::vector<Output>& outputs, bool scalar,
                           bool read_uniforms, bool read_elements, const std::string& raw_inputs,
                           const std::string& real) {
  return Writer(program, slots, scalar, read_uniforms, read_elements, real).write(outputs, raw_inputs);
}

std::string literal(double value, bool single) {
  const std::string suffix = single ? "f" : "";
  if (std::isinf(value)) return value > 0 ? "__builtin_inf" + suffix + "()" : "(-__builtin_inf" + suffix + "())";
  if (std::isnan(value)) return "__builtin_nan" + suffix + "(\"\")";
  // What keeps a divisor from being zero is the smallest there is.
  if (single && value > 0 && value < kGuard) value = std::numeric_limits<float>::min();
  std::string text = single ? fmt::format("{}", static_cast<float>(value)) : fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text + suffix;
}

}  // namespace ergon
