#pragma once
// A straight cantilever of 1 m along x with a bending stiffness of 1 N m^2, clamped at x = 0, that moves in the plane
// of x and z: as a solid, as a thin sheet of triangles with hinges, or as a rod, by its element.

#include <string>

#include "tools/verify/model.h"

namespace ergon {

struct BeamForm {
  Element element = Element::hex27;
  int along = 20;             // cells
  int across = 1;             // of a solid, through its height
  double height = 0.01;       // m
  bool right_angled = false;  // a sheet of right-angled triangles with parallel diagonals, else of equilateral ones
};

struct Beam {
  Model model;
  Eigen::VectorXd tip;       // share of each vertex in what is at the free end
  Eigen::VectorXd length;    // m, share of each vertex in what is spread over the length
  CoupledMass::Matrix mass;  // kg, of 1 kg/m
  std::string element, mesh;
  std::string limits;   // why this form does not reach references; empty where it does
  double locks_by = 1;  // how many times too stiff in bending, where that is known

  std::optional<double> bound() const { return limits.empty() ? std::optional(0.01) : std::nullopt; }
  Eigen::Vector3d tip_place() const { return model.x * tip; }
};

// Rods and sheets turn at their vertices only: their first edge is held and its middle is at x = 0.
Beam make_beam(const BeamForm& form);

// The loads between `low` and `high` below which the state reached from rest is stable, found by bisection to a part of
// 1e-4; unstable also means that the state has left the plane or line of its symmetry along `axis`.
double critical_load(Model& model, const std::function<void(double load)>& apply, double low, double high, int axis);

}  // namespace ergon
