#include "symbolic/functions.h"

#include <array>

namespace ergon {
namespace {

struct Entry {
  Function function;
  std::string_view name;
  int arguments;
};

constexpr std::array<Entry, 15> scalar_functions = {{{Function::sqrt, "sqrt", 1},
                                                     {Function::log, "log", 1},
                                                     {Function::exp, "exp", 1},
                                                     {Function::log1p, "log1p", 1},
                                                     {Function::expm1, "expm1", 1},
                                                     {Function::sin, "sin", 1},
                                                     {Function::cos, "cos", 1},
                                                     {Function::tan, "tan", 1},
                                                     {Function::asin, "asin", 1},
                                                     {Function::acos, "acos", 1},
                                                     {Function::atan, "atan", 1},
                                                     {Function::atan2, "atan2", 2},
                                                     {Function::abs, "abs", 1},
                                                     {Function::min, "min", 2},
                                                     {Function::max, "max", 2}}};

const Entry& entry(Function function) { return scalar_functions[static_cast<size_t>(function)]; }

}  // namespace

std::optional<Function> function_named(std::string_view name) {
  for (const Entry& e : scalar_functions)
    if (e.name == name) return e.function;
  return std::nullopt;
}

std::string_view name_of(Function function) { return entry(function).name; }
int argument_count(Function function) { return entry(function).arguments; }

const std::vector<std::string>& function_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = {"tr",    "det",    "inverse",  "transpose", "cross",     "dot",
                                    "outer", "norm",   "norm2",    "columns",   "identity",  "sym",
                                    "dev",   "column", "dihedral", "pow",       "stretches", "spline"};
    for (const Entry& e : scalar_functions) all.emplace_back(e.name);
    return all;
  }();
  return names;
}

}  // namespace ergon
