#pragma once
// Pass 4: first and second derivatives with respect to q, on the graph.

#include "codegen/module.h"

namespace ergon {

// Establishes module.gradient (reverse accumulation: every node's adjoint is formed once) and module.hessian (tangents
// of the gradient, lower triangle; entries (i, j) and what they share are one node wherever they are equal); the same
// of module.far where there is one. Products among the adjoints are split into their factors or kept whole, whichever
// takes fewer operations for the energy.
void differentiate(Module& module);

}  // namespace ergon
