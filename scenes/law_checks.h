#pragma once
// What holds of every law that a scene carries, on an object or between two.

#include <string>
#include <vector>

#include "scenes/energy_use.h"
#include "symbolic/energy.h"

namespace ergon {

// "a, b and c".
std::string listed(std::vector<std::string> names);

// Whether this is a rest position, which every potential fills in: X0 of a dof x0.
bool is_rest_position(const Energy& energy, const Symbol& rest);

// Throws SourceError at `place` for a law with cases or an `active`. `carrier`: "an object".
void check_always_acts(const Energy& energy, const Place& place, const char* carrier);
// Throws SourceError at `place` for a lag that is not renewed, neither by time steps (dt, xhat, xlag, Flag) nor by the
// law itself, and is not among those `given` once.
void check_lags(const Energy& energy, const Place& place, const std::vector<std::string>& given = {});
// Stiffness is that of stored energy. Throws SourceError at the scene's line for a law that damps by itself.
void check_damping(const Energy& energy, const EnergyUse& use);

}  // namespace ergon
