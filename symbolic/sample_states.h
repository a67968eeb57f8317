#pragma once
// Random states with exact rational components, the same ones in every run.

#include <optional>
#include <random>
#include <vector>

#include "symbolic/cln_algebra.h"
#include "symbolic/energy.h"

namespace ergon {

using Rational = cln::cl_RA;

class StateSampler {
 public:
  // A value of every symbol, within its range: points within 2 of the origin, F near the identity, other quantities of
  // the order of 1.
  ExactInputs any(const Energy& energy);

  // One whose `active` and `require` margins are positive, and, for a solid, det(F) too; nothing when none is found.
  std::optional<ExactInputs> admissible(const Energy& energy, const std::string& case_name);

  // A rotation (3x3, column by column) by Cayley's formula.
  std::vector<Rational> rotation();
  std::vector<Rational> vector3();

  // num/den with num uniform in [-limit, limit].
  Rational fraction(int limit, int den);

 private:
  Rational within(const Range& range);
  std::mt19937 engine_{20200717};
};

// F of an undeformed density: the columns of the 3x3 identity.
std::vector<Rational> undeformed(Shape shape);

// Determinant of a 3x3 matrix, column by column.
Rational determinant(const std::vector<Rational>& a);

// The rest symbol with the positions at rest of a dof: "X0" for "x0", of the same shape and unit; or nullptr.
const Symbol* rest_position(const Energy& energy, const Symbol& dof);

}  // namespace ergon
