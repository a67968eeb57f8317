#pragma once
// How the matter of a homogeneous solid is spread, from its surface, and the four points of equal mass that stand for
// it: they have its mass, its centre and its second moments, so that under every affine map their kinetic energy,
// momentum and weight are those of the solid.

#include <Eigen/Core>
#include <array>

#include "runtime/mesh/mesh.h"

namespace ergon {

struct SolidMoments {
  double volume = 0;       // m^3
  Eigen::Vector3d center;  // m
  Eigen::Matrix3d second;  // m^5, integral of (X - center)(X - center)'
};

// Of what a closed Tri3 surface encloses, exact up to rounding: every triangle makes a tetrahedron with one point,
// which counts by its sign (divergence theorem). Parts within parts are cavities. Throws InputError as closed_parts
// does.
SolidMoments solid_moments(const Mesh& surface);

// The columns are the centre + sqrt(3/volume) sqrt(second) e_k, e_k the corners of a regular tetrahedron on the unit
// sphere: sum e_k = 0, sum e_k e_k' = 4/3. With w_k their barycentric coordinates, integral(w_i w_j) is volume/4 for i
// = j, else 0. Any such four points serve: Laus, Selig 2020, Rigid body dynamics using equimomental systems of
// point-masses, Acta Mechanica 231.
Eigen::Matrix<double, 3, 4> equimomental_points(const SolidMoments& moments);

// Barycentric coordinates of X among four points that are not in one plane; they add to 1.
std::array<double, 4> barycentric(const Eigen::Matrix<double, 3, 4>& points, const Eigen::Vector3d& X);

}  // namespace ergon
