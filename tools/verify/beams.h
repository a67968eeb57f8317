#pragma once
// A straight cantilever of 1 m along x with a bending stiffness of 1 N m^2, clamped at x = 0, that moves in the plane
// of x and z: as a solid, as a thin sheet of triangles, or as a rod, by its element.

#include <string>

#include "tools/verify/model.h"
#include "tools/verify/verify.h"

namespace ergon {

// What a sheet of triangles bends by: hinges between equilateral triangles, between right-angled ones with parallel
// diagonals, with diagonals that turn from cell to cell; or a Koiter shell, of equilateral triangles.
enum class Sheet { hinges, right_angled_hinges, alternating_hinges, koiter };

struct BeamForm {
  Element element = Element::hex27;
  int along = 20;        // cells
  int across = 1;        // of a solid, through its height
  double height = 0.01;  // m
  Sheet sheet = Sheet::hinges;
  double poisson = 0;  // of a Koiter shell
};

struct Beam {
  Model model;
  Eigen::VectorXd tip;       // share of each vertex in what is at the free end
  Eigen::VectorXd length;    // m, share of each vertex in what is spread over the length
  CoupledMass::Matrix mass;  // kg, of 1 kg/m
  std::string element, mesh;
  std::string limits;    // why this form does not reach references; empty where it does
  double stiffness = 1;  // N m^2, what this form has instead of 1; of hinges, what it tends to with smaller cells

  std::optional<double> bound() const { return limits.empty() ? std::optional(0.01) : std::nullopt; }
  Eigen::Vector3d tip_place() const { return model.x.leftCols(tip.size()) * tip; }
};

// Rods and sheets of hinges turn at their vertices only: their first edge is held and its middle is at x = 0.
Beam make_beam(const BeamForm& form);

// What is found of a beam, and what closed forms say of a stiffness of 1 N m^2 and of the one that its form has.
struct BeamAnswer {
  std::string quantity;
  double value, reference, of_stiffness;
};
using BeamQuestion = std::function<std::vector<BeamAnswer>(Beam& beam)>;

// A row for each answer of a beam, and where its form is known to have another stiffness, one that is judged by that: a
// stiffness that explains all answers is the only error there is.
void compare_beam(const BeamForm& form, const BeamQuestion& question, const VerifyRows& rows);
// Of hinges: rows of a mesh, of one of cells half as long, and of what both tend to. The last is judged: between
// equilateral triangles by a Koiter shell with the Poisson's ratio that such hinges have, -1/3, else by the stiffness
// that they have in a free strip.
void compare_hinges(BeamForm form, const BeamQuestion& question, const VerifyRows& rows);

// The loads between `low` and `high` below which the state reached from rest is stable, found by bisection to a part of
// 1e-4; unstable also means that the state has left the plane or line of its symmetry along `axis`.
double critical_load(Model& model, const std::function<void(double load)>& apply, double low, double high, int axis);

}  // namespace ergon
