#include "scenes/field_keys.h"

#include <algorithm>

namespace ergon {
namespace {

const std::vector<std::string> ways = {"formula", "regions", "cells", "vertices"};

// A formula stands at its first character, behind the quote.
Place inside(Place place) {
  ++place.column;
  return place;
}

Key<FieldValue> regions_key() {
  Key<FieldValue> key;
  key.text = {"regions",
              "table",
              "1",
              "",
              "none",
              "values by name of an [[object.region]], as { core = \"2 MPa\", otherwise = \"1 MPa\" }; `otherwise` "
              "serves all other cells; where regions overlap, the later one counts"};
  key.read = [](const toml::node& node, const std::string& file, FieldValue& out) {
    const toml::table* table = node.as_table();
    if (table == nullptr || table->empty())
      throw SourceError(
          place_of(node.source(), file),
          fmt::format("'regions' must be a table of values by name of a region, found {}", describe(node)));
    for (const auto& [name, value] : *table) {
      if (value.is_table())
        throw SourceError(place_of(value.source(), file), "a region has one value; leave out the table");
      out.regions[std::string(name.str())] = read_param(name, value, file);
    }
  };
  return key;
}

Formula::Constant constant_of(const std::string& name, const ParamValue& written) {
  Formula::Constant out;
  out.place = written.place;
  out.quantity.shape.rows = static_cast<int>(written.components.size());
  for (const WrittenNumber& number : written.components) {
    const Unit unit = number.unit.value_or(Unit{});
    if (out.values.empty()) out.quantity.unit = unit;
    if (unit != out.quantity.unit)
      throw SourceError(written.place, fmt::format("the components of '{}' have several units", name));
    out.values.push_back(number.value);
  }
  return out;
}

void check_field(FieldValue& field) {
  std::vector<std::string> written;
  for (const std::string& way : ways)
    if (field.wrote(way)) written.push_back(way);
  if (written.size() > 1)
    throw SourceError(field.at(written[1]), fmt::format("'{}' and '{}' are two ways in which a param varies; leave one "
                                                        "of them out",
                                                        written[0], written[1]));
  if (written.empty())
    throw SourceError(field.place, fmt::format("a param that varies is given by one of {}", fmt::join(ways, ", ")));
  const bool of_file = field.wrote("cells") || field.wrote("vertices");
  if (field.wrote("column") && !of_file)
    throw SourceError(field.at("column"), "'column' is that of a file; it has no use here");
  std::map<std::string, Formula::Constant> constants;
  for (const auto& [name, value] : field.constants) {
    if (value.field)
      throw SourceError(value.place, fmt::format("the constant '{}' of a formula is a number, found a table", name));
    constants[name] = constant_of(name, value);
  }
  if (field.wrote("formula"))
    field.formula = std::make_shared<const Formula>(field.text, inside(field.at("formula")), constants);
}

}  // namespace

Section<FieldValue> field_section() {
  using T = FieldValue;
  Section<T> out{"PARAM = { ... }",
                 "In place of one value of a param of an energy: how it varies over the object or in time. Every value "
                 "is checked against the param's unit and range.",
                 {},
                 {},
                 {}};
  out.keys = {
      text_key(
          "formula", &T::text, Need::optional,
          "an expression of the language of energies in the rest position X (m, after scale, rotate and translate), "
          "the time t (s, at the end of each step) and constants, which are the other keys: { formula = \"E0*(1 + "
          "X[2]/L)\", E0 = \"1 MPa\", L = \"10 cm\" }; a formula in t alone is evaluated once per step",
          "one of these four"),
      regions_key(),
      text_key("cells", &T::cells, Need::optional,
               "a .csv file, relative to the scene: a line of names of columns with units, as `E (kPa)`, and a line "
               "for every cell in the order of the mesh. Laws of stencils take the mean of the cells that they join",
               "one of these four"),
      text_key("vertices", &T::vertices, Need::optional,
               "the same with a line for every vertex; in between they are interpolated", "one of these four"),
      text_key("column", &T::column, Need::optional, "name of the column in that file; of a vector NAME_0, NAME_1, ...",
               "the name of the param"),
  };
  out.keys[1].text.fallback = "one of these four";
  out.other = [](const toml::key& key, const toml::node& node, const std::string& file, T& field) {
    field.constants[std::string(key.str())] = read_param(key, node, file);
  };
  out.check = [](const std::string&, T& field) { check_field(field); };
  return out;
}

std::shared_ptr<const FieldValue> read_field(const toml::table& table, const std::string& file) {
  std::vector<std::string> names = ways;
  names.emplace_back("column");
  for (const auto& [place, entry] : in_order_of_text(table)) {
    const std::string name(entry.first.str());
    if (!table.contains("formula") && std::find(names.begin(), names.end(), name) == names.end())
      throw SourceError(place_of(entry.first.source(), file),
                        fmt::format("unknown key '{}' of a param that varies{}", name, did_you_mean(name, names)));
  }
  auto out = std::make_shared<FieldValue>();
  read_section(table, field_section(), file, *out);
  return out;
}

}  // namespace ergon
