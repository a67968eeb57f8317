#pragma once
// Directions about which a density may be symmetric, and turns about them, in 60 digits.

#include <string>
#include <vector>

#include "symbolic/energy.h"
#include "symbolic/sample_states.h"
#include "symbolic/singular_values.h"

namespace ergon {

constexpr int axis_digits = 60;
constexpr double axis_tolerance = 1e-30;

using Axis = Triple<cln::cl_F>;  // of the length 1

struct NamedAxis {
  std::string name;  // "" for one found from values
  Axis axis;
};

bool parallel(const Axis& a, const Axis& b);
bool perpendicular(const Axis& a, const Axis& b);
Axis across(const Axis& a, const Axis& b);                      // cross(a, b) to the length 1
Axis diagonal_of(const Axis& a, const Axis& b, const Axis& c);  // their sum, to the length 1
Axis coordinate_axis(int i);

// "(0.6, 0.8, 0)", the first component that is not 0 positive.
std::string numbers_of(const Axis& axis);

// Rotations, 3x3 column by column: by the n-th part of a whole turn, and by twice the angle whose tangent is t.
std::vector<Rational> part_of_turn(const Axis& axis, int n);
std::vector<Rational> turn_by(const Axis& axis, const Rational& t);

// Vectors of `data` that the density declares, as many components as F has columns, and what follows from them: "a",
// "cross(a, b)", "the bisector of a and b", "the bisector of a and -b"; in the plane of a membrane also "across a".
std::vector<NamedAxis> declared_axes(const Energy& energy, const ExactInputs& data);

// Appended unless one is there that is parallel.
void add_axis(NamedAxis axis, std::vector<NamedAxis>& axes);

// The first two derivatives of a density at F = s I, with the first s of a short list at which they are finite. A turn
// of the shape at rest that keeps the density keeps them.
class ScaledShape {
 public:
  ScaledShape(const Energy& energy, const std::string& case_name, const ExactInputs& data);

  // Eigenvectors of a symmetric matrix in which stress and the contractions of the stiffness have parts.
  void add_axes_of_stress(std::vector<NamedAxis>& axes) const;

  // Where the stiffness of a stretch along one direction is greatest and least, for densities that are too symmetric
  // for the matrix to tell directions apart, as cubic ones; nothing where it is alike in all directions.
  void add_axes_of_stiffness(std::vector<NamedAxis>& axes) const;

 private:
  cln::cl_F stress(int i, int j) const;
  cln::cl_F stiffness(int i, int j, int k, int l) const;  // by F(i, j) and F(k, l)
  // The second derivative by F along n n', which is a form c(n, n, n, n), and the vector c(., n, n, n).
  cln::cl_F along(const Axis& n) const;
  Axis slope(const Axis& n) const;
  Axis extreme(bool greatest) const;
  void add_axes_across(const Axis& n, std::vector<NamedAxis>& axes) const;

  int columns_;
  std::vector<cln::cl_F> gradient_, hessian_;  // empty where none is finite
};

}  // namespace ergon
