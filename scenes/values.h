#pragma once
// From TOML nodes to checked SI values: a number, a string with a unit, vectors of them, integers, choices. Everything
// that does not fit is a SourceError at the node, which says what was found and what was expected.

#include <toml++/toml.h>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "symbolic/energy.h"

namespace ergon {

// What a key of a scene accepts.
struct ValueRule {
  std::string key;
  std::string unit = "1";
  Range range;
};

Place place_of(const toml::source_region& region, const std::string& file);

// "true", "-0.01", "\"abc\"", "an array of 2", "a table".
std::string describe(const toml::node& node);

// A number, or a string of a number and a unit. Throws SourceError for anything else, naming what was `expected`, and
// for an unknown unit.
WrittenNumber read_quantity(const toml::node& node, const std::string& key, const std::string& expected,
                            const std::string& file);
// The same for a param of an energy, which may be an array of quantities, or of such arrays by rows; or a table, which
// says how it varies (scenes/field_keys.h).
ParamValue read_param(const toml::key& key, const toml::node& node, const std::string& file);

double read_number(const toml::node& node, const ValueRule& rule, const std::string& file);
Vector3 read_vector3(const toml::node& node, const ValueRule& rule, const std::string& file);
std::vector<Vector3> read_points(const toml::node& node, const ValueRule& rule, const std::string& file);
int read_integer(const toml::node& node, const ValueRule& rule, const std::string& file);
std::array<int, 3> read_integer3(const toml::node& node, const ValueRule& rule, const std::string& file);
bool read_boolean(const toml::node& node, const ValueRule& rule, const std::string& file);
std::string read_text(const toml::node& node, const ValueRule& rule, const std::string& file);
std::string read_choice(const toml::node& node, const ValueRule& rule, const std::vector<std::string>& choices,
                        const std::string& file);

}  // namespace ergon
