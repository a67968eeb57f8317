#pragma once
// Declarations: `param E nu Pa (0, inf) help`, with several names to one unit.

#include <vector>

#include "symbolic/energy.h"
#include "symbolic/statements.h"

namespace ergon {

// The symbols that a statement declares; `offset` is behind its keyword. The unit is the first word behind the first
// name that reads as a unit. Throws SourceError.
std::vector<Symbol> parse_declaration(const Statement& statement, size_t offset, Role role);

std::string_view to_string(Role role);

}  // namespace ergon
