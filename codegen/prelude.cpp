#include "codegen/prelude.h"

#include <stdexcept>

#include <fmt/format.h>

namespace ergon {
namespace {

// Defined by comparisons, the same text for vectors and doubles.
std::string by_comparison(const std::string& type, const std::string& prefix, const std::string& name) {
  if (name == "abs")
    return fmt::format("static inline {0} {1}abs({0} a) {{ return a < 0.0 ? -a : a; }}\n", type, prefix);
  if (name == "min")
    return fmt::format("static inline {0} {1}min({0} a, {0} b) {{ return a < b ? a : b; }}\n", type, prefix);
  if (name == "max")
    return fmt::format("static inline {0} {1}max({0} a, {0} b) {{ return a > b ? a : b; }}\n", type, prefix);
  if (name == "select")
    return fmt::format("static inline {0} {1}select({0} c, {0} a, {0} b) {{ return c > 0.0 ? a : b; }}\n", type,
                       prefix);
  return "";
}

std::string scalar_function(const std::string& type, const std::string& prefix, const std::string& name) {
  bool two = name == "pow" || name == "atan2";
  return fmt::format("static inline {0} {1}{2}({0} a{3}) {{ return __builtin_{2}(a{4}); }}\n", type, prefix, name,
                     two ? ", " + type + " b" : "", two ? ", b" : "");
}

std::string vector_sqrt(int lanes) {
  std::string builtin = lanes == 8 ? "__builtin_ia32_sqrtpd512_mask(a, a, -1, 4)" : "__builtin_ia32_sqrtpd256(a)";
  return fmt::format(
      "static inline V v_sqrt(V a) {{\n#if defined(__x86_64__) && !defined(__clang__)\n  return {};\n#else\n"
      "  for (int i = 0; i < {}; ++i) a[i] = __builtin_sqrt(a[i]);\n  return a;\n#endif\n}}\n",
      builtin, lanes);
}

std::string vector_function(int lanes, const std::string& name) {
  bool two = name == "pow" || name == "atan2";
  return fmt::format(
      "#if defined(__x86_64__)\nextern \"C\" V _ZGV{0}N{1}{2}_{3}(V{4}) __attribute__((const));\n"
      "static inline V v_{3}(V a{5}) {{ return _ZGV{0}N{1}{2}_{3}(a{6}); }}\n#else\n"
      "static inline V v_{3}(V a{5}) {{\n  for (int i = 0; i < {1}; ++i) a[i] = __builtin_{3}(a[i]{7});\n  return "
      "a;\n}}\n#endif\n",
      lanes == 8 ? "e" : "d", lanes, two ? "vv" : "v", name, two ? ", V" : "", two ? ", V b" : "", two ? ", b" : "",
      two ? ", b[i]" : "");
}

}  // namespace

std::string prelude(int lanes, const std::set<std::string>& used) {
  if (lanes != 1 && lanes != 4 && lanes != 8) throw std::invalid_argument("prelude: lanes must be 1, 4 or 8");
  std::string out = lanes == 1
                        ? "typedef double V;\n"
                        : fmt::format("typedef double V __attribute__((vector_size({}), may_alias));\n", 8 * lanes);
  for (const std::string& function : used) {
    std::string prefix = function.substr(0, 2), name = function.substr(2);
    bool one = prefix == "s_" || lanes == 1;
    std::string type = prefix == "s_" ? "double" : "V";
    std::string text = by_comparison(type, prefix, name);
    if (text.empty())
      text = one              ? scalar_function(type, prefix, name)
             : name == "sqrt" ? vector_sqrt(lanes)
                              : vector_function(lanes, name);
    out += text;
  }
  return out + "\n";
}

}  // namespace ergon
