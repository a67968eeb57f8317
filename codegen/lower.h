#pragma once
// Pass 1: an energy becomes a graph. Establishes value, conditions and the layout of inputs; operations stand in the
// order in which the author wrote them. Points are inputs of Source::point (3*point + component); a density's F is
// Source::q. A density in principal stretches (symbolic/stretches.h) is a function of them: F is diag(s), and s is
// Source::q.

#include "codegen/module.h"

namespace ergon {

// The layout of inputs alone, with an empty graph.
Module empty_module(const Energy& energy, const std::string& case_name);

Module lower(const Energy& energy, const std::string& case_name);

// Splices unnamed sums that are used once into the sum that uses them.
void flatten(Module& module);

}  // namespace ergon
