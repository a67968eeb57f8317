#pragma once
// Pass 8: from the graph to straight-line code.
//
// Establishes a program in which every n-ary sum and product is a chain of two-operand instructions; what depends on
// parameters or rest and lag data alone stands apart (lifetimes), so that it can be computed once; powers, roots and
// reciprocals of one base are shared, with one division each; parts common to several products are formed once.

#include <vector>

#include "codegen/module.h"
#include "codegen/program.h"

namespace ergon {

struct Schedule {
  Program program;
  int value = -1;
  int changed = -1;  // of the projection, with `projected`
  std::vector<int> active, require, update, gradient, hessian, principal, projected;
  // Set where the module has two forms (codegen/module.h).
  int near = -1, far_value = -1;
  std::vector<int> far_gradient, far_hessian;
};

Schedule schedule(Module& module);

}  // namespace ergon
