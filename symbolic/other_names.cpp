#include "symbolic/other_names.h"

#include <fmt/format.h>

#include <utility>

namespace ergon {
namespace {

using Entry = std::pair<std::string_view, std::string_view>;

constexpr Entry functions[] = {
    {"ln", "the natural logarithm is log(x)"},
    {"log10", "the natural logarithm is log(x)"},
    {"trace", "the trace is tr(A)"},
    {"inv", "the inverse is inverse(A)"},
    {"determinant", "the determinant is det(A)"},
    {"eye", "the unit matrix is identity(3)"},
    {"identity3", "the unit matrix is identity(3)"},
    {"sqr", "a square is x^2"},
    {"square", "a square is x^2"},
    {"length", "the length of a vector is norm(a)"},
    {"sqnorm", "the square of a length is norm2(a)"},
    {"normSquared", "the square of a length is norm2(a)"},
    {"squaredNorm", "the square of a length is norm2(a)"},
    {"normalize", "a unit vector is a/norm(a)"},
    {"normalized", "a unit vector is a/norm(a)"},
    {"ddot", "the product of two matrices of one shape is dot(A, B)"},
    {"inner", "the product of two vectors, or of two matrices of one shape, is dot(a, b)"},
    {"angle", "the angle between two triangles is dihedral(x0, x1, x2, x3)"},
    {"if", "an energy has no branches: write max or min, or a `case`"},
    {"where", "an energy has no branches: write max or min, or a `case`"},
    {"step", "an energy has no branches: write max or min, or a `case`"},
    {"heaviside", "an energy has no branches: write max or min, or a `case`"},
};

constexpr Entry quantities_of_F[] = {
    {"J", "let J = det(F)"},     {"detF", "let detF = det(F)"}, {"C", "let C = F'*F"},
    {"B", "let B = F*F'"},       {"FtF", "let FtF = F'*F"},     {"I1", "let I1 = norm2(F)"},
    {"Ic", "let Ic = norm2(F)"}, {"IC", "let IC = norm2(F)"},   {"I2", "let I2 = (norm2(F)^2 - norm2(F'*F))/2"},
    {"I3", "let I3 = det(F)^2"},
};

constexpr Entry signs[] = {
    {"(", "products are written with '*'"},
    {",", "decimals are written with a point"},
    {";", "a statement ends with its line"},
    {"|", "a length is norm(a), an absolute value abs(x)"},
    {"?", "an energy has no branches: write max or min, or a `case`"},
    {"\xC2\xB7", "products are written with '*'"},
    {"\xC3\x97", "products are written with '*', the cross product is cross(a, b)"},
    {"\xC2\xB2", "powers are written with '^'"},
    {"\xC2\xB3", "powers are written with '^'"},
    {"\xE2\x88\x92", "this is a dash; minus is '-'"},
    {"\xE2\x80\x93", "this is a dash; minus is '-'"},
};

template <size_t N>
std::string_view find(const Entry (&entries)[N], std::string_view name) {
  for (const auto& [theirs, ours] : entries)
    if (theirs == name) return ours;
  return {};
}

std::string as_remedy(std::string_view text) { return text.empty() ? "" : fmt::format("; {}", text); }

}  // namespace

std::string function_elsewhere(std::string_view name) { return as_remedy(find(functions, name)); }

std::string quantity_elsewhere(std::string_view name, bool F_is_known) {
  const std::string_view written = F_is_known ? find(quantities_of_F, name) : std::string_view();
  if (!written.empty()) return fmt::format("; give it by `{}`", written);
  if (name == "I" || name == "Id" || name == "eye") return "; the unit matrix is identity(3)";
  if (F_is_known && name.size() == 3 && name[0] == 'F' && name[1] >= '1' && name[1] <= '3' && name[2] >= '1' &&
      name[2] <= '3')
    return fmt::format("; components are counted from 0: F[{}, {}]", name[1] - '1', name[2] - '1');
  return "";
}

std::string sign_elsewhere(std::string_view sign) {
  const std::string_view remedy = find(signs, sign);
  if (remedy.empty() && !sign.empty() && static_cast<unsigned char>(sign[0]) >= 128)
    return "; names are written in the letters a to z, digits and '_'";
  return as_remedy(remedy);
}

}  // namespace ergon
