#include "scenes/values.h"

#include "scenes/field_keys.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace ergon {
namespace {

[[noreturn]] void fail(const toml::node& node, const std::string& file, const std::string& message) {
  throw SourceError(place_of(node.source(), file), message);
}

std::string with_unit(double value, const std::string& unit) {
  return unit == "1" ? fmt::format("{}", value) : fmt::format("{} {}", value, unit);
}

// "a number", "a number in m or a string such as \"0.5 m\""
std::string expected_number(const ValueRule& rule) {
  if (rule.unit == "1") return "a number";
  return fmt::format("a number in {} or a string with a unit such as \"1 {}\"", rule.unit, rule.unit);
}

std::string in_range(const ValueRule& rule) {
  return to_string(rule.range) + (rule.unit == "1" ? "" : " " + rule.unit);
}

const toml::array& array_of_3(const toml::node& node, const ValueRule& rule, const std::string& file,
                              const std::string& of) {
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() != 3)
    fail(node, file, fmt::format("'{}' must be an array of 3, each {}, found {}", rule.key, of, describe(node)));
  return *array;
}

void append_components(const toml::node& node, const std::string& key, const std::string& file,
                       std::vector<WrittenNumber>& out) {
  const toml::array* array = node.as_array();
  if (array == nullptr) {
    out.push_back(read_quantity(node, key, "a number or a string with a unit", file));
    return;
  }
  for (const toml::node& item : *array) append_components(item, key, file, out);
}

}  // namespace

Place place_of(const toml::source_region& region, const std::string& file) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

std::string describe(const toml::node& node) {
  if (auto v = node.as_boolean()) return v->get() ? "true" : "false";
  if (auto v = node.as_integer()) return std::to_string(v->get());
  if (auto v = node.as_floating_point()) return fmt::format("{}", v->get());
  if (auto v = node.as_string()) return "\"" + v->get() + "\"";
  if (auto v = node.as_array()) return fmt::format("an array of {}", v->size());
  if (node.is_table()) return "a table";
  return "a date or time";
}

WrittenNumber read_quantity(const toml::node& node, const std::string& key, const std::string& expected,
                            const std::string& file) {
  auto mismatch = [&] { fail(node, file, fmt::format("'{}' must be {}, found {}", key, expected, describe(node))); };
  if (auto v = node.as_integer()) return {static_cast<double>(v->get()), {}, describe(node)};
  if (auto v = node.as_floating_point()) return {v->get(), {}, describe(node)};
  auto text = node.as_string();
  if (text == nullptr) mismatch();
  const std::string& s = text->get();
  double number = 0;
  const char* begin = s.data() + (!s.empty() && s[0] == '+' ? 1 : 0);
  auto [end, error] = std::from_chars(begin, s.data() + s.size(), number);
  if (error != std::errc() || !std::isfinite(number)) mismatch();
  std::string unit_text(end, s.data() + s.size());
  size_t first = unit_text.find_first_not_of(' ');
  if (first == std::string::npos) return {number, {}, s};
  unit_text = unit_text.substr(first, unit_text.find_last_not_of(' ') - first + 1);
  try {
    ScaledUnit unit = parse_unit(unit_text);
    return {number * unit.scale, unit.unit, s};
  } catch (const std::invalid_argument& bad) {
    fail(node, file, fmt::format("'{}' is \"{}\": {}", key, s, bad.what()));
  }
}

ParamValue read_param(const toml::key& key, const toml::node& node, const std::string& file) {
  ParamValue out;
  out.key_place = place_of(key.source(), file);
  out.place = place_of(node.source(), file);
  if (const toml::table* table = node.as_table()) {
    out.field = read_field(*table, file);
    return out;
  }
  const std::string name(key.str());
  const toml::array* rows = node.as_array();
  const bool matrix = rows != nullptr && !rows->empty() && rows->is_array_of_tables() == false && (*rows)[0].is_array();
  if (!matrix) {
    append_components(node, name, file, out.components);
    return out;
  }
  // Written by rows, kept by columns.
  std::vector<std::vector<WrittenNumber>> read;
  for (const toml::node& row : *rows) {
    append_components(row, name, file, read.emplace_back());
    if (read.back().size() != read.front().size())
      fail(row, file,
           fmt::format("'{}': this row has {} entries, the first row has {}", name, read.back().size(),
                       read.front().size()));
  }
  for (size_t col = 0; col < read.front().size(); ++col)
    for (const auto& row : read) out.components.push_back(row[col]);
  return out;
}

double read_number(const toml::node& node, const ValueRule& rule, const std::string& file) {
  WrittenNumber q = read_quantity(node, rule.key, expected_number(rule), file);
  if (q.unit && *q.unit != parse_unit(rule.unit).unit)
    fail(node, file,
         fmt::format("'{}' {}, found \"{}\", which is in {}", rule.key,
                     rule.unit == "1" ? "has no unit" : "must be in " + rule.unit, q.text, to_string(*q.unit)));
  if (!rule.range.contains(q.value))
    fail(node, file,
         fmt::format("'{}' must be in {}, found {}", rule.key, in_range(rule), with_unit(q.value, rule.unit)));
  return q.value;
}

Vector3 read_vector3(const toml::node& node, const ValueRule& rule, const std::string& file) {
  const toml::array& array = array_of_3(node, rule, file, expected_number(rule));
  return {read_number(array[0], rule, file), read_number(array[1], rule, file), read_number(array[2], rule, file)};
}

std::vector<Vector3> read_points(const toml::node& node, const ValueRule& rule, const std::string& file) {
  const toml::array* array = node.as_array();
  if (array == nullptr || array->empty())
    fail(node, file,
         fmt::format("'{}' must be an array of points, each an array of 3, found {}", rule.key, describe(node)));
  std::vector<Vector3> points;
  for (const toml::node& item : *array) points.push_back(read_vector3(item, rule, file));
  return points;
}

int read_integer(const toml::node& node, const ValueRule& rule, const std::string& file) {
  auto v = node.as_integer();
  if (v == nullptr || !rule.range.contains(static_cast<double>(v->get())) || v->get() > std::numeric_limits<int>::max())
    fail(node, file,
         fmt::format("'{}' must be an integer in {}, found {}", rule.key, to_string(rule.range), describe(node)));
  return static_cast<int>(v->get());
}

std::array<int, 3> read_integer3(const toml::node& node, const ValueRule& rule, const std::string& file) {
  const toml::array& array = array_of_3(node, rule, file, "an integer in " + to_string(rule.range));
  return {read_integer(array[0], rule, file), read_integer(array[1], rule, file), read_integer(array[2], rule, file)};
}

bool read_boolean(const toml::node& node, const ValueRule& rule, const std::string& file) {
  auto v = node.as_boolean();
  if (v == nullptr) fail(node, file, fmt::format("'{}' must be true or false, found {}", rule.key, describe(node)));
  return v->get();
}

std::string read_text(const toml::node& node, const ValueRule& rule, const std::string& file) {
  auto v = node.as_string();
  if (v == nullptr || v->get().empty())
    fail(node, file, fmt::format("'{}' must be a string that is not empty, found {}", rule.key, describe(node)));
  return v->get();
}

std::string read_choice(const toml::node& node, const ValueRule& rule, const std::vector<std::string>& choices,
                        const std::string& file) {
  auto v = node.as_string();
  if (v != nullptr)
    for (const std::string& choice : choices)
      if (choice == v->get()) return choice;
  fail(node, file,
       fmt::format("'{}' must be one of {}, found {}{}", rule.key, fmt::join(choices, ", "), describe(node),
                   v != nullptr ? did_you_mean(v->get(), choices) : ""));
}

}  // namespace ergon
