#pragma once
// Densities in principal stretches: those that call `stretches`. Such a density is a function of the singular values
// of F alone, and a smooth one of F only if it is symmetric in them.

#include <optional>
#include <string>

#include "symbolic/checks.h"
#include "symbolic/energy.h"

namespace ergon {

bool uses_stretches(const Energy& energy);

// Digits to compute with where `digits` of second derivatives are wanted: those of singular values are taken where the
// values are apart by half of the digits (ClnAlgebra::decompose_apart).
int digits_for_derivatives(const Energy& energy, int digits);

// An error where a density that calls `stretches` sees more of F than the stretches, or is not symmetric in them, with
// the state and the two values; tried at random states in 50 digits. Nothing for an energy that does not call it.
std::optional<Finding> check_stretches(const Energy& energy, const std::string& case_name);

}  // namespace ergon
