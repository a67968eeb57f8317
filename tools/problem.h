#pragma once
// One energy on one mesh as a System of a single potential: what `ergon eval` and `ergon bench kernels` evaluate.

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runtime/mesh/mesh.h"
#include "runtime/potential.h"
#include "runtime/system.h"
#include "symbolic/energy.h"

namespace ergon {

// Params, rest and lag data by name; rest and lag values hold for all stencils.
using Values = std::map<std::string, std::vector<double>>;

// The inputs that must be given: all but rest positions (X0 of a dof x0), which the mesh tells. In order of
// declaration.
std::vector<const Symbol*> needed_inputs(const Energy& energy);

// Those of `all` stencils of a stencil energy whose `active` conditions hold at x (3 x vertices, m). Throws InputError
// as make_system does.
std::vector<int> active_stencils(const Energy& energy, const Kernel& kernel, const Mesh& mesh,
                                 const std::vector<int>& all, const Values& values, const Eigen::Matrix3Xd& x);

// The potential on `stencils` (of a density: on the mesh's cells, by quadrature of that exactness or the element's
// default; `stencils` is not used). Throws InputError for an
// input that is missing, naming its meaning, range and unit, and for an element the energy cannot live on.
System make_system(const Energy& energy, const Kernel& kernel, const Mesh& mesh, const std::vector<int>& stencils,
                   const Values& values, std::optional<int> exactness = std::nullopt);

}  // namespace ergon
