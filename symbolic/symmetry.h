#pragma once
// The material symmetry of a density: by which rotations the shape at rest may be turned before it is strained without
// a change of the value. Found from values alone, however the density is written.

#include <optional>
#include <string>
#include <vector>

#include "symbolic/energy.h"

namespace ergon {

struct MaterialSymmetry {
  // From the most to the least symmetric. The turns of a membrane are those of its plane and those that put it upside
  // down: it is isotropic, tetragonal (square), hexagonal, orthotropic, trigonal or has none.
  enum class Group {
    isotropic,
    transversely_isotropic,  // about one axis
    cubic,                   // along three axes
    hexagonal,               // about one axis; so are the next two
    tetragonal,
    trigonal,
    orthotropic,  // about three axes
    monoclinic,   // about one axis
    none
  };
  Group group = Group::none;
  // As told: "a" (a direction that the density declares), "cross(a, b)", "the bisector of a and b", "across a", "x" (of
  // the axes in which the shape at rest is drawn; "the first axis" of a membrane), "(0.6, 0.8, 0)", or "an axis that
  // its data give".
  std::vector<std::string> axes;
};

// psi(R' F Q) = psi(F) with Q = R, or the part of R in the plane of a membrane, at three random exactly rational F and
// for three sets of random data, in 60 digits to 1e-30. Axes are sought among directions that the density declares,
// those of its coordinates, and those of its stress and stiffness in a shape that is grown alike in all directions
// (Cowin, Mehrabadi 1987. On the Identification of Material Symmetry for Anisotropic Elastic Materials. QJMAM 40(4)). A
// density with `natural` is seen from that shape, and what it renews is as it starts. Nothing for other energies, for
// lines, and where fewer than three states have a finite value.
std::optional<MaterialSymmetry> material_symmetry(const Energy& energy, const std::string& case_name);

// "orthotropic along a, b and cross(a, b)".
std::string to_string(const MaterialSymmetry& symmetry);

}  // namespace ergon
