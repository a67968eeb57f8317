#include "scenes/energy_keys.h"

#include <algorithm>

#include "scenes/field_keys.h"
#include "scenes/shape_keys.h"

namespace ergon {
namespace {

// An energy in the scene itself. Every line of it is a line of the file, so that messages point there.
Key<EnergyUse> energy_text_key() {
  Key<EnergyUse> key;
  key.text = {
      "text", "string",
      "1",    "",
      "none", "in place of 'law', the energy itself, as an .energy file holds it, between lines of three quotes"};
  key.read = [](const toml::node& node, const std::string& file, EnergyUse& use) {
    use.text = read_text(node, {"text", "1", {}}, file);
    const auto lines = static_cast<unsigned>(std::count(use.text.begin(), use.text.end(), '\n'));
    const toml::source_region& region = node.source();
    const unsigned height = region.end.line - region.begin.line;
    if (height != lines && height != lines + 1)
      throw SourceError(
          place_of(region, file),
          "'text' must stand between two lines of three quotes, ''' or \"\"\", without line breaks that are "
          "written as \\n or taken away by a \\ at the end of a line");
    use.text_line = static_cast<int>(region.begin.line + (height - lines));
  };
  return key;
}

// In the unit of what the law draws to 0.
Key<EnergyUse> constraint_key() {
  Key<EnergyUse> key;
  key.text = {
      "constraint_tolerance",
      "number or string",
      "of c",
      "(0, inf)",
      "none",
      "of a law with a `constraint c = ...`: every step ends with the length of c in all its stencils, or points of "
      "quadrature, at most this, whatever the law's stiffness, or it fails; the law is augmented by multipliers, "
      "and hardened where they converge slowly"};
  key.read = [](const toml::node& node, const std::string& file, EnergyUse& use) {
    use.constraint_tolerance = read_param(toml::key("constraint_tolerance", node.source()), node, file);
  };
  return key;
}

}  // namespace

Section<EnergyUse> energy_section() {
  using T = EnergyUse;
  Section<T> out{
      "[[object.energy]]",
      "One law that the object obeys. Every other key is a param of that energy (`ergon show LAW` lists "
      "them with unit and range): a number, a string with a unit, an array for a vector or a matrix, or a "
      "table where it varies. The param `weight` of any energy is what its value is multiplied by, 1 if left "
      "out.",
      {},
      {},
      {},
      {text_of(field_section())}};
  out.keys = {
      text_key("law", &T::law, Need::optional,
               "name of an energy in the catalogue, or path of an .energy file relative to the scene",
               "required, or 'text'"),
      energy_text_key(),
      number_key(
          "stiffness_damping", &T::stiffness_damping, "s", key_ranges::not_negative, Need::optional,
          "time by which the stiffness of this law at the start of each step is multiplied to resist velocities: "
          "Rayleigh damping by stiffness, of any law that has one. A vibration of angular frequency w has then "
          "the damping ratio mass_damping/(2*w) + stiffness_damping*w/2; steps without inertia have none"),
      constraint_key(),
  };
  out.check = [](const std::string&, const T& use) {
    if (use.wrote("law") && use.wrote("text"))
      throw SourceError(use.at("text"), "'law' and 'text' are two ways to say which energy; leave one of them out");
    if (!use.wrote("law") && !use.wrote("text"))
      throw SourceError(use.place,
                        "[[object.energy]] lacks the key 'law': name of an energy in the catalogue, or path of an "
                        ".energy file relative to the scene; or the key 'text' with the energy itself");
  };
  out.other = [](const toml::key& key, const toml::node& node, const std::string& file, T& use) {
    use.params[std::string(key.str())] = read_param(key, node, file);
  };
  return out;
}

}  // namespace ergon
