#include "symbolic/energy.h"

#include <algorithm>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>

namespace ergon {

std::string to_string(Shape shape) {
  if (shape.scalar()) return "scalar";
  if (shape.cols == 1) return fmt::format("vector of {}", shape.rows);
  return fmt::format("{}x{} matrix", shape.rows, shape.cols);
}

std::string to_string(const Range& range) {
  auto bound = [](double v) { return std::isinf(v) ? std::string(v < 0 ? "-inf" : "inf") : fmt::format("{}", v); };
  return fmt::format("{}{}, {}{}", range.lower_open ? '(' : '[', bound(range.lower), bound(range.upper),
                     range.upper_open ? ')' : ']');
}

bool Energy::renews(std::string_view symbol_name) const {
  return std::any_of(updates.begin(), updates.end(), [&](const Let& update) { return update.name == symbol_name; });
}

const Symbol* Energy::find(std::string_view symbol_name) const {
  for (const Symbol& symbol : symbols)
    if (symbol.name == symbol_name) return &symbol;
  return nullptr;
}

std::vector<const Symbol*> Energy::with_role(Role role) const {
  std::vector<const Symbol*> result;
  for (const Symbol& symbol : symbols)
    if (symbol.role == role) result.push_back(&symbol);
  return result;
}

const std::vector<std::string>& stencil_names() {
  static const std::vector<std::string> names = {
      "point",          "edge",       "corner",      "triangle",   "tetrahedron",    "hinge",    "patch",
      "shell_triangle", "rod_corner", "point_point", "point_edge", "point_triangle", "edge_edge"};
  return names;
}

int points_of_stencil(std::string_view stencil) {
  constexpr std::array points = {1, 2, 3, 3, 4, 4, 6, 6, 5, 2, 3, 4, 4};
  for (size_t i = 0; i < points.size(); ++i)
    if (stencil_names()[i] == stencil) return points[i];
  return 0;
}

int twists_of_stencil(std::string_view stencil) { return stencil == "rod_corner" ? 2 : 0; }

bool is_twist(const Energy& energy, const Symbol& dof) {
  const std::vector<const Symbol*> dofs = energy.with_role(Role::dof);
  const auto found = std::find_if(dofs.begin(), dofs.end(), [&](const Symbol* one) { return one->name == dof.name; });
  return dofs.end() - found <= twists_of_stencil(energy.geometry) && found != dofs.end();
}

std::optional<Shape> shape_of_F(std::string_view geometry) {
  if (geometry == "solid") return Shape{3, 3};
  if (geometry == "membrane") return Shape{3, 2};
  if (geometry == "line") return Shape{3, 1};
  return std::nullopt;
}

Energy read_energy(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw SourceError({file, 0, 0}, "cannot open the energy file");
  std::string text;
  for (char block[4096]; stream.read(block, sizeof block), stream.gcount() > 0;)
    text.append(block, static_cast<size_t>(stream.gcount()));
  if (stream.bad()) throw SourceError({file, 0, 0}, "cannot read the energy file");
  return parse_energy(text, file);
}

}  // namespace ergon
