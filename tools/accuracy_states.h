#pragma once
// States to measure the accuracy of kernels at: small and large strains of one element or stencil, all of whose
// coordinates are doubles, so that the exact answer belongs to the very numbers that a kernel is given.

#include <optional>
#include <random>
#include <vector>

#include "symbolic/cln_algebra.h"
#include "symbolic/energy.h"
#include "symbolic/reference.h"

namespace ergon {

struct AccuracyState {
  Inputs inputs;          // params, rest and lag data
  std::vector<double> x;  // 3 coordinates per point
  std::vector<double> X;  // where the points rest, or what the strain is counted from
};

// A random state in which the points are displaced from X by `strain` times the size of the element (1 m); where
// `require` and `active` conditions hold, or nothing when 50 attempts found none. A density lives on the simplex of the
// coordinate axes (Tet4, Tri3, Edge2), so that F - I (F, for a membrane or line) is made of differences of coordinates.
// The points of a stencil are displaced from their rest positions, from a point in its lag data, or from random points;
// those of a contact stencil from where they touch or edges are parallel.
std::optional<AccuracyState> accuracy_state(const Energy& energy, const std::string& case_name, double strain,
                                            std::mt19937_64& random);

// What a kernel whose q is made of positions, or of displacements, receives: doubles in, doubles out.
std::vector<double> kernel_points(const AccuracyState& state, bool displacement);

// The exact values of all symbols. `relative` holds factors 1 + relative[i] for the inputs, in the order params, rest
// and lag data by name, then points, or their displacements when `displacement` is set; empty means none.
ExactInputs exact_inputs(const Energy& energy, const AccuracyState& state, bool displacement,
                         const std::vector<double>& relative);

// How many factors exact_inputs() takes.
size_t input_count(const AccuracyState& state);

}  // namespace ergon
