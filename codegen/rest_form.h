#pragma once
// Pass 2: what cancels near rest is rewritten, so that value and gradient keep their digits there.
//
// Establishes, for a density whose value and stress vanish at rest F = I as an identity in its parameters: q is the
// displacement gradient G = F - I (`displacement`; of a membrane or line, whose density must be invariant under
// rotation, in the axes of the element at rest, where I is the first columns of the identity), and the value is its own
// remainder of second order in G (codegen/rest_algebra.h). Sums and products of it hold at every G; with functions and
// quotients the value so written serves states where `near` > 0, |G|^2 < 1/16, and `far` holds it as its author wrote
// it. In all other energies only single sums are rewritten (codegen/cancellations.h).

#include "codegen/module.h"

namespace ergon {

void rest_form(Module& module);

}  // namespace ergon
