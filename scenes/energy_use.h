#pragma once
// Values of a scene as its author wrote them, each with the place it was read from: numbers with units, params that
// vary, the use of a law.

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "symbolic/diagnostic.h"
#include "symbolic/formula.h"
#include "symbolic/units.h"

namespace ergon {

using Vector3 = std::array<double, 3>;

// Where a table of the scene and each of its keys stand. A scene built in C++ may leave all of it empty.
struct Located {
  Place place;
  std::map<std::string, Place> keys;

  bool wrote(const std::string& key) const { return keys.count(key) > 0; }
  // The place of a key's value, or of the table when the key was left out.
  const Place& at(const std::string& key) const {
    auto found = keys.find(key);
    return found == keys.end() ? place : found->second;
  }
};

// A number as written: `unit` is absent when it was a bare number, which counts as SI.
struct WrittenNumber {
  double value = 0;  // SI
  std::optional<Unit> unit;
  std::string text;  // "0.5 MPa"
};

struct FieldValue;

// The values of one param of an energy, components column by column.
struct ParamValue {
  std::vector<WrittenNumber> components;
  std::shared_ptr<const FieldValue> field;  // in place of components where it varies; else null
  Place key_place;
  Place place;
};

// A param that varies over the object or in time: by one of a formula, regions, data of cells, data of vertices.
struct FieldValue : Located {
  std::string text;  // of the formula
  std::map<std::string, ParamValue> constants;
  std::shared_ptr<const Formula> formula;     // null without one
  std::map<std::string, ParamValue> regions;  // by name; "otherwise" stands for all cells in none of these
  std::string cells, vertices;                // a .csv file, relative to the scene
  std::string column;                         // of that file; "" for that named like the param
};

struct EnergyUse : Located {
  std::string law;    // a name in the catalogue, or a path ending in .energy relative to the scene file; or "" and
  std::string text;   // the energy itself, as an .energy file holds it
  int text_line = 0;  // of the scene file, where the text begins
  double stiffness_damping = 0;  // s
  std::optional<ParamValue> constraint_tolerance;
  std::map<std::string, ParamValue> params;
};

}  // namespace ergon
