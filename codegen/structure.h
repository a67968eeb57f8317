#pragma once
// Pass 5: what need not be computed again, or at all. Establishes constant_gradient, constant_hessian, zero_hessian and
// psd_hessian of the module, and its projection where that has a closed form.

#include "codegen/module.h"

namespace ergon {

void find_structure(Module& module);

}  // namespace ergon
