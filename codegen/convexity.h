#pragma once
// Whether an energy is convex in its degrees of freedom by the way it is composed: sums of squares, norms,
// exponentials, maxima of such. The rules are those of disciplined convex programming (Grant, Boyd, Ye 2006,
// Disciplined convex programming): a function is known to be convex where every part of it is, so that its Hessian is
// positive semi-definite for every state and all values of its parameters within their ranges.

#include "codegen/module.h"

namespace ergon {

// Of the node `value` of the module. False when convexity is not found, which does not say that there is none.
bool is_convex(const Module& module, NodeId value);

}  // namespace ergon
