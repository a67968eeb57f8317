#pragma once
// Pass 7: Hessians that fall apart. Establishes `parts` of the module where blocks of the Hessian between 3-vectors of
// q vanish identically: the connected components of what couples them, and vectors that are in no entry at all. Only
// the entries within a part stay in the Hessian, so that no others are emitted, stored, projected or multiplied. The
// eigenvalues of the whole are those of its parts.

#include <vector>

#include "codegen/module.h"
#include "runtime/kernel.h"

namespace ergon {

// A Hessian that has a closed form, or is constant, stays whole.
void find_parts(Module& module);

// Rows and columns of the lower triangle, in the order in which the Hessian's entries stand.
struct Entry {
  int row, column;
};
std::vector<Entry> hessian_entries(int q_vectors, const std::vector<int>& parts);
std::vector<Entry> hessian_entries(const ErgonKernel& kernel);

}  // namespace ergon
