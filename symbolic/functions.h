#pragma once
// The functions that an energy may call.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ergon {

// Scalar functions that every algebra knows.
enum class Function { sqrt, log, exp, log1p, expm1, sin, cos, tan, asin, acos, atan, atan2, abs, min, max };

std::optional<Function> function_named(std::string_view name);
std::string_view name_of(Function function);
int argument_count(Function function);

// All functions of the language, of scalars and of tensors.
const std::vector<std::string>& function_names();

}  // namespace ergon
