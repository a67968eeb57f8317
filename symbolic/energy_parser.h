#pragma once
// From statements to an energy. It establishes that an energy means the same, and is refused for the same reasons,
// wherever its statements come from: a file, or C++ (symbolic/energy_builder.h).

#include <string>
#include <string_view>

#include "symbolic/energy.h"
#include "symbolic/statements.h"

namespace ergon {

// `text`: the statements as a file holds them; `file`: where faults are that have no line. Throws SourceError.
Energy energy_of(const Statements& statements, std::string_view text, const std::string& file);

}  // namespace ergon
