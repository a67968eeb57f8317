#include "codegen/prelude.h"

#include <algorithm>
#include <regex>
#include <stdexcept>
#include <utility>
#include <vector>

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

// Bit l is set where lane l is above 0.
std::string lanes_above(VectorType v) {
  if (v.lanes == 1) return "enum { all_lanes = 1 };\nstatic inline int lanes_above(V a) { return a > 0.0; }\n";
  const char kind = v.single ? 's' : 'd';
  const std::string builtin =
      v.bytes() == 64 ? fmt::format("({})__builtin_ia32_cmpp{}512_mask(a, V{{}}, 14, -1, 4)",
                                    v.single ? "unsigned short" : "unsigned char", kind)
                      : fmt::format("__builtin_ia32_movmskp{}{}((V)(a > 0.0))", kind, v.bytes() == 32 ? "256" : "");
  return fmt::format(
      "enum {{ all_lanes = {} }};\nstatic inline int lanes_above(V a) {{\n"
      "#if defined(__x86_64__) && !defined(__clang__)\n  return {};\n#else\n  int bits = 0;\n"
      "  for (int i = 0; i < {}; ++i) bits |= (a[i] > 0.0) << i;\n  return bits;\n#endif\n}}\n",
      (1 << v.lanes) - 1, builtin, v.lanes);
}

// log(1 + x) - x, exp(x) - 1 - x, sin(x) - x and atan(x) - x: series where x is small; where it is not, the function
// less x, in which few bits cancel. Lanes share a branch, as arguments are small as a rule. With z = x/(2 + x), log(1 +
// x) = 2 atanh(z) = 2 z + 2/3 z^3 + 2/5 z^5 + ..., and 2 z - x = -x z. With z = x/(1 + sqrt(1 + x^2)), atan(x) = 2
// atan(z), and 2 z - x = -x z^2.
std::string remainder_function(const std::string& type, const std::string& prefix, const std::string& name) {
  const char* all_small = prefix == "s_" ? "small > 0.0" : "lanes_above(small) == all_lanes";
  std::string series;
  if (name == "log1pmx") {
    // Terms up to z^25: the first one left out is below 2^-53 of the sum for |z| < 1/5.
    for (int k = 11; k >= 0; --k) {
      const std::string term = fmt::format("1.0 / {}.0", 2 * k + 3);
      series = k == 11 ? term : fmt::format("{} + z2*({})", term, series);
    }
    return fmt::format(
        "static inline {0} {1}log1pmx({0} x) {{\n  const {0} z = x/(2.0 + x), z2 = z*z;\n"
        "  {0} r = 2.0*z*z2*({2}) - x*z;\n  const {0} small = 0.04 - z2;\n"
        "  if (!({3})) r = small > 0.0 ? r : {1}log(1.0 + x) - x;\n  return r;\n}}\n",
        type, prefix, series, all_small);
  }
  if (name == "sinmx") {
    // Terms up to x^19: the first one left out is below 2^-53 of the sum for |x| < 1.
    for (int k = 9; k >= 2; --k)
      series = fmt::format("1.0 - x2*(1.0 / {}.0){}", 2 * k * (2 * k + 1), series.empty() ? "" : "*(" + series + ")");
    return fmt::format(
        "static inline {0} {1}sinmx({0} x) {{\n  const {0} x2 = x*x;\n  {0} r = x*x2*(-1.0 / 6.0)*({2});\n"
        "  const {0} small = 1.0 - x2;\n  if (!({3})) r = small > 0.0 ? r : {1}sin(x) - x;\n  return r;\n}}\n",
        type, prefix, series, all_small);
  }
  if (name == "atanmx") {
    // Terms up to z^29: the first one left out is below 2^-53 of the sum for |x| < 1/2.
    for (int k = 13; k >= 0; --k) {
      const std::string term = fmt::format("1.0 / {}.0", 2 * k + 3);
      series = k == 13 ? term : fmt::format("{} - z2*({})", term, series);
    }
    return fmt::format(
        "static inline {0} {1}atanmx({0} x) {{\n  const {0} z = x/(1.0 + {1}sqrt(1.0 + x*x)), z2 = z*z;\n"
        "  {0} r = -2.0*z*z2*({2}) - x*z2;\n  const {0} small = 0.25 - x*x;\n"
        "  if (!({3})) r = small > 0.0 ? r : {1}atan(x) - x;\n  return r;\n}}\n",
        type, prefix, series, all_small);
  }
  // Terms up to x^16: the first one left out is below 2^-53 of the sum for |x| < 1/2.
  for (int k = 16; k >= 3; --k)
    series = fmt::format("1.0 + x*(1.0 / {}.0){}", k, series.empty() ? "" : "*(" + series + ")");
  return fmt::format(
      "static inline {0} {1}expm1mx({0} x) {{\n  {0} r = 0.5*x*x*({2});\n  const {0} small = 0.25 - x*x;\n"
      "  if (!({3})) r = small > 0.0 ? r : {1}expm1(x) - x;\n  return r;\n}}\n",
      type, prefix, series, all_small);
}

std::string scalar_function(const std::string& type, const std::string& prefix, const std::string& name) {
  bool two = name == "pow" || name == "atan2";
  return fmt::format("static inline {0} {1}{2}({0} a{3}) {{ return __builtin_{2}{5}(a{4}); }}\n", type, prefix, name,
                     two ? ", " + type + " b" : "", two ? ", b" : "", type == "float" ? "f" : "");
}

std::string vector_sqrt(VectorType v) {
  const char kind = v.single ? 's' : 'd';
  const std::string builtin = v.bytes() == 64
                                  ? fmt::format("__builtin_ia32_sqrtp{}512_mask(a, a, -1, 4)", kind)
                                  : fmt::format("__builtin_ia32_sqrtp{}{}(a)", kind, v.bytes() == 32 ? "256" : "");
  return fmt::format(
      "static inline V v_sqrt(V a) {{\n#if defined(__x86_64__) && !defined(__clang__)\n  return {};\n#else\n"
      "  for (int i = 0; i < {}; ++i) a[i] = __builtin_sqrt{}(a[i]);\n  return a;\n#endif\n}}\n",
      builtin, v.lanes, v.single ? "f" : "");
}

std::string vector_function(VectorType v, const std::string& name) {
  const bool two = name == "pow" || name == "atan2";
  const std::string function = name + (v.single ? "f" : "");
  return fmt::format(
      "#if defined(__x86_64__)\nextern \"C\" V _ZGV{0}N{1}{2}_{8}(V{4}) __attribute__((const));\n"
      "static inline V v_{3}(V a{5}) {{ return _ZGV{0}N{1}{2}_{8}(a{6}); }}\n#else\n"
      "static inline V v_{3}(V a{5}) {{\n  for (int i = 0; i < {1}; ++i) a[i] = __builtin_{8}(a[i]{7});\n  return "
      "a;\n}}\n#endif\n",
      v.bytes() == 64   ? "e"
      : v.bytes() == 32 ? "d"
                        : "b",
      v.lanes, two ? "vv" : "v", name, two ? ", V" : "", two ? ", V b" : "", two ? ", b" : "", two ? ", b[i]" : "",
      function);
}

// The same text with its numbers as floats.
std::string with_floats(const std::string& text) {
  static const std::regex number(R"(\b[0-9]+\.[0-9]+\b)");
  return std::regex_replace(text, number, "$&f");
}

}  // namespace

std::string prelude(VectorType v, std::set<std::string> used) {
  if (!v.usable())
    throw std::invalid_argument("prelude: lanes must be 1, 2, 4 or 8 of doubles, 1, 4, 8 or 16 of floats");
  std::string out =
      v.lanes == 1 ? fmt::format("typedef {} V;\n", v.real())
                   : fmt::format("typedef {} V __attribute__((vector_size({}), may_alias));\n", v.real(), v.bytes());
  for (const char* prefix : {"s_", "v_"}) {
    const std::string p = prefix;
    const std::pair<const char*, std::vector<const char*>> callers[] = {
        {"log1pmx", {"log"}}, {"expm1mx", {"expm1"}}, {"sinmx", {"sin"}}, {"atanmx", {"atan", "sqrt"}}};
    for (const auto& [caller, called] : callers) {
      if (used.count(p + caller) == 0) continue;
      for (const char* name : called) used.insert(p + name);
      if (p == "v_") used.insert("lanes_above");
    }
  }
  // Those that others call come first.
  std::vector<std::string> order(used.begin(), used.end());
  std::stable_partition(order.begin(), order.end(), [](const std::string& name) { return !name.ends_with("mx"); });
  for (const std::string& function : order) {
    if (function == "lanes_above") {
      out += v.single ? with_floats(lanes_above(v)) : lanes_above(v);
      continue;
    }
    std::string prefix = function.substr(0, 2), name = function.substr(2);
    bool one = prefix == "s_" || v.lanes == 1;
    std::string type = prefix == "s_" ? "double" : v.lanes == 1 ? v.real() : "V";
    std::string text = by_comparison(type, prefix, name);
    if (text.empty() && name.ends_with("mx")) text = remainder_function(type, prefix, name);
    if (text.empty())
      text = one ? scalar_function(type, prefix, name) : name == "sqrt" ? vector_sqrt(v) : vector_function(v, name);
    out += v.single && prefix == "v_" ? with_floats(text) : text;
  }
  return out + "\n";
}

}  // namespace ergon
