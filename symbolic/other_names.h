#pragma once
// What authors call things in other languages and in papers, and how it is written here.

#include <string>
#include <string_view>

namespace ergon {

// "; the natural logarithm is log(x)" for a function of another language, or "".
std::string function_elsewhere(std::string_view name);

// "; give it by `let J = det(F)`" for a quantity that is usually called so, or "". `F_is_known`: in a density.
std::string quantity_elsewhere(std::string_view name, bool F_is_known);

// "; products are written with '*'" for a sign that stands where none may, or "".
std::string sign_elsewhere(std::string_view sign);

}  // namespace ergon
