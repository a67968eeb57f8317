#pragma once
// The parts of check_energy, one function a check; none is returned where a check does not apply.

#include <optional>

#include "symbolic/checks.h"
#include "symbolic/stretches.h"

namespace ergon {

// Value and derivatives are real and finite wherever the conditions hold.
std::optional<Finding> check_defined(const Energy& energy, const std::string& case_name);

// Twice differentiable inside the domain: the worst at each place of the text where it is not.
std::vector<Finding> check_smooth(const Energy& energy, const std::string& case_name);

// Begins smoothly where `active` begins to hold, and does not fall without bound where `require` ends.
std::vector<Finding> check_boundaries(const Energy& energy, const std::string& case_name);

// The value keeps under rotation and translation, or the energy states `frame fixed` and it does not.
std::optional<Finding> check_rigid_motion(const Energy& energy, const std::string& case_name);

// Of an energy that states `load PARAM`: the value is in proportion to the param.
std::optional<Finding> check_load(const Energy& energy, const std::string& case_name);

// The next four are given what seen_from_natural() makes of an energy (symbolic/natural.h): F is then told from the
// shape without stress. No stress in the undeformed state: F the identity, or dofs at the rest positions of their names
// (x0 at X0).
std::optional<Finding> check_rest(const Energy& energy, const std::string& case_name);

// A solid with parameters E and nu has the linearisation that these moduli have.
std::optional<Finding> check_moduli(const Energy& energy, const std::string& case_name);

// Small strains of the undeformed state cost energy.
std::optional<Finding> check_stable_at_rest(const Energy& energy, const std::string& case_name);

// How far a solid may be stretched and pressed along one, two and three axes, and sheared, until a small strain gives
// energy away: between a hundredth and a hundredfold of its length.
std::optional<Finding> check_range(const Energy& energy, const std::string& case_name);

// By which turns of its shape at rest a solid or membrane keeps its value (symbolic/symmetry.h).
std::optional<Finding> check_symmetry(const Energy& energy, const std::string& case_name);

// Whether the value of a density grows without bound as it collapses along an axis.
std::optional<Finding> check_collapse(const Energy& energy, const std::string& case_name);

// A solid is finite for det(F) < 0, or `require` keeps it away from there.
std::optional<Finding> check_inversion(const Energy& energy, const std::string& case_name);

}  // namespace ergon
