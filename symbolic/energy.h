#pragma once
// One energy: what an `.energy` file reads into, and what a C++ program builds for itself.

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "symbolic/expression.h"

namespace ergon {

// What a declared name is, and with it how long its value lasts.
enum class Role {
  dof,    // differentiated: the points of a stencil, or F of a density
  param,  // one value per material
  rest,   // per-stencil data of the undeformed state, constant over a run
  lag     // per-stencil data held constant while differentiating, renewed between solves
};

struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_open = true;
  bool upper_open = true;
  bool operator==(const Range&) const = default;
  bool contains(double v) const {
    return (lower_open ? v > lower : v >= lower) && (upper_open ? v < upper : v <= upper);
  }
};

// "(0, inf)"
std::string to_string(const Range& range);

struct Symbol {
  std::string name;
  Role role = Role::param;
  Shape shape;
  Unit unit;
  Range range;
  std::string help;
  Place place;
};

struct Let {
  std::string name;
  std::string case_name;  // "" when it holds in every case
  ExpressionPtr expression;
  Place place;
};

// left < right (strict); written the other way round it is stored swapped. Its margin is right - left.
struct Condition {
  ExpressionPtr left;
  ExpressionPtr right;
  Place place;
};

struct Energy {
  // The last two are parts that are composed to stencil energies (symbolic/compose.h): a law over a gap, without
  // points; a distance that gives the gap, without a value.
  enum class Kind { density, stencil, barrier, distance };
  Kind kind = Kind::density;
  std::string name;
  std::string geometry;  // density: "solid" (F 3x3), "membrane" (3x2), "line" (3x1); barrier: ""; else "point" ...
  std::string summary;   // the comment lines above the header
  std::string cite;
  // In order of declaration; those that the header declares come first, as dofs: "F" of a density, "gap" and "gap2" of
  // a barrier.
  std::vector<Symbol> symbols;
  std::vector<Let> lets;  // in order; a case's lets stand where they were written
  std::vector<std::string> cases;
  std::vector<Condition> active;  // whoever builds the list of stencils keeps those where all hold
  std::vector<Condition> require;
  // Lags that the energy renews itself when a step has ended, by expressions of what it then sees; they start at 0.
  std::vector<Let> updates;
  ExpressionPtr value;  // null in a distance
  // `natural EXPRESSION` of a density: the shape without stress over the one at rest, a number or a square matrix over
  // the columns of F; null for none.
  ExpressionPtr natural;
  std::string part_of;       // `part TEXT`: the sum that it is sound in; "" for one that is sound alone
  std::string constraint;    // `constraint NAME = EXPRESSION`: the let that the value draws to 0; "" without one
  std::string load;          // `load PARAM`: what the value is in proportion to; "" for one that is no load
  bool fixed_frame = false;  // `frame fixed`: the author states that it is not invariant under rotation
  std::string text;          // the file as read
  std::string file;

  bool complete() const { return kind == Kind::density || kind == Kind::stencil; }
  bool renews(std::string_view symbol_name) const;
  const Symbol* find(std::string_view symbol_name) const;
  std::vector<const Symbol*> with_role(Role role) const;
};

const std::vector<std::string>& stencil_names();

// Points of a stencil ("point" 1, "edge" 2, "hinge" 4 ...); 0 when there is none of that name.
int points_of_stencil(std::string_view stencil);

// The last points of a stencil may be twists of edges: their first component alone has a meaning, an angle times a
// radius (m). They neither turn nor shift with the others, and are 0 at rest. How many a stencil has ("rod_corner" 2).
int twists_of_stencil(std::string_view stencil);
bool is_twist(const Energy& energy, const Symbol& dof);

// Shape of F in a density of that geometry; nothing when there is none of that name.
std::optional<Shape> shape_of_F(std::string_view geometry);

// Reads and analyses (names, shapes, units, ranges) one energy, or one part. Throws SourceError at the exact place.
Energy parse_energy(std::string_view text, const std::string& file);
Energy read_energy(const std::string& file);

}  // namespace ergon
