#pragma once
// The table of keys: name, type, unit, range, default and help of every key of a scene are stated once, and reading,
// the check for unknown keys and the generated reference all come from that statement. Defaults are taken from the
// structs' own initial values.

#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "scenes/values.h"

namespace ergon {

struct KeyText {
  std::string name;
  std::string type;
  std::string unit;
  std::string range;
  std::string fallback;  // printed default; "required" when there is none
  std::string help;
};

// What the reference prints of one kind of table.
struct SectionText {
  std::string heading;  // "[[object.fixed]]"
  std::string help;
  std::vector<KeyText> keys;
  std::vector<SectionText> sections;
};

template <class T>
struct Key {
  KeyText text;
  bool required = false;
  std::function<void(const toml::node&, const std::string& file, T&)> read;
  std::function<SectionText()> section;  // set when the key is a table
};

template <class T>
struct Section {
  std::string heading;
  std::string help;
  std::vector<Key<T>> keys;
  // Takes keys that are not in the list; without it they are errors.
  std::function<void(const toml::key&, const toml::node&, const std::string& file, T&)> other;
  std::function<void(const std::string& file, T&)> check;  // what concerns several keys
  std::vector<SectionText> also = {};  // what the reference tells of values of keys that are not in the list
};

template <class T>
SectionText text_of(const Section<T>& section) {
  SectionText out{section.heading, section.help, {}, {}};
  for (const Key<T>& key : section.keys) {
    out.keys.push_back(key.text);
    if (key.section) out.sections.push_back(key.section());
  }
  out.sections.insert(out.sections.end(), section.also.begin(), section.also.end());
  return out;
}

// The entries of a table as they stand in the file, so that the first mistake is the one reported. Those that were
// added to what was read stand nowhere: all of them come first.
inline auto in_order_of_text(const toml::table& table) {
  std::multimap<std::pair<unsigned, unsigned>, std::pair<const toml::key&, const toml::node&>> out;
  for (const auto& [key, node] : table)
    out.emplace(std::pair(key.source().begin.line, key.source().begin.column),
                std::pair(std::cref(key), std::cref(node)));
  return out;
}

template <class T>
void read_section(const toml::table& table, const Section<T>& section, const std::string& file, T& out) {
  out.place = place_of(table.source(), file);
  std::vector<std::string> names;
  for (const Key<T>& key : section.keys) names.push_back(key.text.name);
  for (const auto& [place, entry] : in_order_of_text(table)) {
    const auto& [key, node] = entry;
    const std::string name(key.str());
    const Key<T>* known = nullptr;
    for (const Key<T>& k : section.keys)
      if (k.text.name == name) known = &k;
    if (known == nullptr && !section.other)
      throw SourceError(place_of(key.source(), file),
                        fmt::format("unknown key '{}' in {}{}", name, section.heading, did_you_mean(name, names)));
    out.keys[name] = place_of(node.source(), file);
    known != nullptr ? known->read(node, file, out) : section.other(key, node, file, out);
  }
  for (const Key<T>& key : section.keys)
    if (key.required && !out.wrote(key.text.name))
      throw SourceError(out.place,
                        fmt::format("{} lacks {}: {}{}", section.heading,
                                    key.section ? key.section().heading : fmt::format("the key '{}'", key.text.name),
                                    key.text.help, key.text.unit == "1" ? "" : ", in " + key.text.unit));
  if (section.check) section.check(file, out);
}

// Below: one function per type of value. `required` keys have no default; what else the struct holds is the default.

inline std::string print_value(double v) { return fmt::format("{}", v); }
inline std::string print_value(int v) { return std::to_string(v); }
inline std::string print_value(bool v) { return v ? "true" : "false"; }
inline std::string print_value(const std::string& v) { return v; }
template <class S>
std::string print_value(const std::array<S, 3>& v) {
  return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]);
}
template <class S>
std::string print_value(const std::optional<S>& v) {
  return v ? print_value(*v) : "";
}

inline std::string print_value(const std::vector<Vector3>& v) {
  return v.empty() ? "none" : fmt::format("{}", v.size());
}

enum class Need { required, optional };

// The shared part: `read` turns a node and the key's rule into the member's value. `absent` is printed as the default
// instead of the member's own initial value when it is not empty.
template <class T, class M, class Read>
Key<T> key_of(const char* type, const std::string& name, M T::*member, const std::string& unit, Range range, Need need,
              const std::string& help, const std::string& absent, Read read) {
  Key<T> key;
  key.required = need == Need::required;
  std::string fallback = key.required ? "required" : absent.empty() ? print_value(T{}.*member) : absent;
  key.text = {name, type, unit, "", fallback, help};
  if (std::isfinite(range.lower) || std::isfinite(range.upper)) key.text.range = to_string(range);
  ValueRule rule{name, unit, range};
  key.read = [=](const toml::node& node, const std::string& file, T& out) { out.*member = read(node, rule, file); };
  return key;
}

template <class T, class M>
Key<T> number_key(const std::string& name, M T::*member, const std::string& unit, Range range, Need need,
                  const std::string& help, const std::string& absent = "") {
  return key_of<T>("number", name, member, unit, range, need, help, absent, read_number);
}

template <class T>
Key<T> vector_key(const std::string& name, Vector3 T::*member, const std::string& unit, Range range, Need need,
                  const std::string& help) {
  return key_of<T>("3 numbers", name, member, unit, range, need, help, "", read_vector3);
}

template <class T>
Key<T> points_key(const std::string& name, std::vector<Vector3> T::*member, const std::string& unit, Need need,
                  const std::string& help, const std::string& absent) {
  return key_of<T>("points of 3 numbers", name, member, unit, Range{}, need, help, absent, read_points);
}

template <class T, class M>
Key<T> integer_key(const std::string& name, M T::*member, Range range, Need need, const std::string& help,
                   const std::string& absent = "") {
  return key_of<T>("integer", name, member, "1", range, need, help, absent, read_integer);
}

template <class T>
Key<T> integers_key(const std::string& name, std::array<int, 3> T::*member, Range range, Need need,
                    const std::string& help) {
  return key_of<T>("3 integers", name, member, "1", range, need, help, "", read_integer3);
}

template <class T>
Key<T> boolean_key(const std::string& name, bool T::*member, const std::string& help) {
  return key_of<T>("true or false", name, member, "1", Range{}, Need::optional, help, "", read_boolean);
}

template <class T>
Key<T> text_key(const std::string& name, std::string T::*member, Need need, const std::string& help,
                const std::string& absent = "") {
  return key_of<T>("string", name, member, "1", Range{}, need, help, absent, read_text);
}

template <class T>
Key<T> choice_key(const std::string& name, std::string T::*member, const std::vector<std::string>& choices,
                  const std::string& help) {
  Key<T> key = key_of<T>("string", name, member, "1", Range{}, Need::optional, help, "",
                         [choices](const toml::node& node, const ValueRule& rule, const std::string& file) {
                           return read_choice(node, rule, choices, file);
                         });
  key.text.range = fmt::format("{}", fmt::join(choices, ", "));
  return key;
}

// `make` is a function rather than a section so that the sections need no order of initialisation.
template <class T, class M>
Key<T> table_key(const std::string& name, M T::*member, Section<M> (*make)(), Need need, const std::string& help) {
  Key<T> key;
  key.required = need == Need::required;
  key.text = {name, "table", "1", "", key.required ? "required" : "none", help};
  key.section = [make] { return text_of(make()); };
  key.read = [=](const toml::node& node, const std::string& file, T& out) {
    const toml::table* table = node.as_table();
    if (table == nullptr)
      throw SourceError(place_of(node.source(), file),
                        fmt::format("'{}' must be a table, found {}", name, describe(node)));
    read_section(*table, make(), file, out.*member);
  };
  return key;
}

template <class T, class M>
Key<T> table_key(const std::string& name, std::optional<M> T::*member, Section<M> (*make)(), const std::string& help) {
  Key<T> key;
  key.text = {name, "table", "1", "", key.required ? "required" : "none", help};
  key.section = [make] { return text_of(make()); };
  key.read = [=](const toml::node& node, const std::string& file, T& out) {
    const toml::table* table = node.as_table();
    if (table == nullptr)
      throw SourceError(place_of(node.source(), file),
                        fmt::format("'{}' must be a table, found {}", name, describe(node)));
    read_section(*table, make(), file, (out.*member).emplace());
  };
  return key;
}

template <class T, class M>
Key<T> tables_key(const std::string& name, std::vector<M> T::*member, Section<M> (*make)(), Need need,
                  const std::string& help) {
  Key<T> key;
  key.required = need == Need::required;
  key.text = {name, "tables", "1", "", key.required ? "required" : "none", help};
  key.section = [make] { return text_of(make()); };
  key.read = [=](const toml::node& node, const std::string& file, T& out) {
    const toml::array* array = node.as_array();
    if (array == nullptr || array->empty())
      throw SourceError(place_of(node.source(), file), fmt::format("'{}' must be one or more tables {}, found {}", name,
                                                                   make().heading, describe(node)));
    for (const toml::node& item : *array) {
      const toml::table* table = item.as_table();
      if (table == nullptr)
        throw SourceError(place_of(item.source(), file),
                          fmt::format("'{}' must hold tables, found {}", name, describe(item)));
      read_section(*table, make(), file, (out.*member).emplace_back());
    }
  };
  return key;
}

}  // namespace ergon
