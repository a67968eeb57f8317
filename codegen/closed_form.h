#pragma once
// Projection of the Hessian in closed form, where an energy is a function f(s) of one scalar s(q) whose own Hessian is
// h I, h not depending on q: springs and barriers between points (s = |a|^2 or |a|, a affine), barriers of a plane
// (s affine, h = 0). With g the gradient of s the Hessian is f' h I + f'' g g': the eigenvalue of g is f' h + f''
// |g|^2, that of all that is orthogonal to it f' h. Nothing is told by names: s is any part of the value through which
// all of its dependence on q leads.

#include "codegen/module.h"

namespace ergon {

// Establishes module.projected, the lower triangle with each eigenvalue x < 0 replaced by -x*Source::negative (0 or 1),
// and module.changed, positive where one was; both empty when there is no such s.
void find_closed_form(Module& module);

}  // namespace ergon
