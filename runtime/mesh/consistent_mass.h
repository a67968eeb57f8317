#pragma once
// The mass matrix of a mesh that the shape functions of its elements give, integral of density*N_i*N_j. It has the
// mass, the centre and the moments of inertia of the cells as they are interpolated, exactly.

#include "runtime/coupled_mass.h"
#include "runtime/mesh/mesh.h"

namespace ergon {

// Whether lumped_masses keeps the second moments of cells of this element, and so their moments of inertia, or the
// element is of degree 1, whose lumped masses lie at its corners and err by the square of the cell's size, as its
// shape functions do. Not so: Tri6, Tet10 and Hex20, whose scaled diagonal is no rule of quadrature.
bool lumping_suits(Element element);

// `density` as of lumped_masses. Exact on solids, also where curved, and on flat membranes and straight lines. `bound`:
// the matrix of a cell is at least that of the reference element times the least volume factor, and this at least its
// own diagonal times the least eigenvalue of the two. Throws InputError unless the density is positive and finite, and
// for a cell that is inverted at a point of the quadrature.
CoupledMass consistent_mass(const Mesh& mesh, double density);

// Over the vertices: consistent, or diagonal with lumped masses where lumping suits the element.
CoupledMass::Matrix mass_matrix(const Mesh& mesh, double density);

}  // namespace ergon
