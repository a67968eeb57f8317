#pragma once
// Sums that cancel where an argument is small, whatever the energy: part of pass 2, for what has no rest form.
//
// Establishes that these stand in a form without cancellation, k being any number:
//   log(1 + x)          log1p(x)
//   k exp(x) - k        k expm1(x)
//   k - k cos(x)        2 k sin(x/2)^2
//   k sqrt(1 + x) - k   k x/(1 + sqrt(1 + x))

#include "codegen/module.h"

namespace ergon {

void remove_cancellations(Module& module);

}  // namespace ergon
