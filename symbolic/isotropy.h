#pragma once
// Whether a density is isotropic, or invariant under rotation, found from its values alone, however it is written.

#include <string>

#include "symbolic/energy.h"

namespace ergon {

// psi(R F Q) = psi(F) for rotations R of space and Q of the material, tried at random exactly rational states and
// rotations (Cayley's formula) within the declared ranges, in 50 digits. False for a stencil energy, for a density tied
// to rest or lag data that turn with neither, and when fewer than three states have a finite value.
bool is_isotropic(const Energy& energy, const std::string& case_name);

// psi(R F) = psi(F), found in the same way: the density sees strain alone.
bool is_frame_invariant(const Energy& energy, const std::string& case_name);

}  // namespace ergon
