#pragma once
// Pass 3: the affine quantities that feed everything nonlinear.
//
// Establishes q: the fewest 3-vectors q = (weights (x) I3) x, with constant weights over the stencil's points, through
// which the energy depends on its points (edge vectors of a hinge: 3 instead of 4; one difference for a spring). After
// it no Source::point is left in the graph. Where the affine quantities mix components, or nothing is saved, q is the
// points themselves. A density is left alone: its q is F, and its weights belong to the element.

#include "codegen/module.h"

namespace ergon {

void frontier(Module& module);

}  // namespace ergon
