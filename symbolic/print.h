#pragma once
// An energy told back: as text in its own language, as LaTeX, as MathML, and its symbols as a table.

#include <string>

#include "symbolic/energy.h"

namespace ergon {

// The expression with the author's structure and as few brackets as it needs: reading it gives the same tree.
std::string to_text(const Expression& expression);
std::string to_latex(const Expression& expression);
// As elements of MathML, of which browsers need nothing else.
std::string to_mathml(const Expression& expression);

// Lets, cases, conditions and value, one a line, as `let J = det(F)`.
std::string formula_text(const Energy& energy);

// The same as the lines of an align* environment.
std::string formula_latex(const Energy& energy);

// The same as one <math> element, a table of lines.
std::string formula_mathml(const Energy& energy);

// One line a symbol: name, role, shape, unit, range, help, in aligned columns under a header line.
std::string symbol_table(const Energy& energy);

}  // namespace ergon
