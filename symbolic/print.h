#pragma once
// An energy told back: as text in its own language, as LaTeX, and its symbols as a table.

#include <string>

#include "symbolic/energy.h"

namespace ergon {

// The expression with the author's structure and as few brackets as it needs: reading it gives the same tree.
std::string to_text(const Expression& expression);
std::string to_latex(const Expression& expression);

// Lets, cases, conditions and value, one a line, as `let J = det(F)`.
std::string formula_text(const Energy& energy);

// The same as the lines of an align* environment.
std::string formula_latex(const Energy& energy);

// One line a symbol: name, role, shape, unit, range, help, in aligned columns under a header line.
std::string symbol_table(const Energy& energy);

}  // namespace ergon
