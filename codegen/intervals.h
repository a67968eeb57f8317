#pragma once
// Between which values each node of a module lies, from the declared ranges of its inputs.

#include <vector>

#include "codegen/module.h"

namespace ergon {

// Both ends may be infinite. It holds wherever the node is defined, but for rounding.
struct Interval {
  double low = -__builtin_inf(), high = __builtin_inf();
  bool nonnegative() const { return low >= 0; }
  bool nonpositive() const { return high <= 0; }
};

// Of every node, by its number. What is not known to be bounded is taken as any number.
std::vector<Interval> find_intervals(const Module& module);

}  // namespace ergon
