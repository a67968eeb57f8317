#pragma once
// Problems of any size for any energy, to measure kernels on: a cube of cells, a state near rest, and values for all
// inputs. Deterministic.

#include <Eigen/Core>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/mesh/mesh.h"
#include "symbolic/energy.h"

namespace ergon {

// A cube (square) of 1 m with `cells` cells per edge, cut as box_mesh says; lines: the edges of the Tet4 mesh. Throws
// InputError for cells < 1 and for points.
Mesh sample_mesh(Element element, int cells);

// The rest positions, displaced by smooth noise whose largest component is `amplitude` (m): a sum of three plane waves
// per component, 3 to 6 `spacing` (m) long.
Eigen::Matrix3Xd displaced(const Eigen::Matrix3Xd& X, double spacing, double amplitude);

// The element a density is measured on when none is asked for: Tet4, Tri3 or Edge2.
Element default_element(const Energy& density);

// Throws InputError when a density cannot live on the element.
void check_element(const Energy& density, Element element);

// A value within the declared range for every symbol with this role, components column by column. Attempt 0 is a plain
// choice (1 above a lower bound, the point at 4/5 of a bounded range, the z axis for a dimensionless vector); further
// attempts are drawn at random, over some orders of magnitude.
std::map<std::string, std::vector<double>> sample_values(const Energy& energy, Role role, int attempt);

}  // namespace ergon
