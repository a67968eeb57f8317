#pragma once
// The body of one emitted function: instructions as C++ statements with readable names.

#include <string>
#include <vector>

#include "codegen/program.h"
#include "codegen/slots.h"

namespace ergon {

struct Output {
  std::string target;  // an lvalue such as "gradient[3]"
  int value;           // instruction
};

struct FunctionText {
  std::string body;
  std::vector<int> instructions;  // computed in it, slots that are only read left out
};

// Statements that compute the outputs. Values that `given` has slots for are read from arrays u (uniform) and e
// (element). Scalars (constant and uniform values) are double, all else is V; in a function of uniforms (`scalar`)
// everything is double.
FunctionText function_text(const Program& program, const Slots& slots, const std::vector<Output>& outputs, bool scalar,
                           bool read_uniforms, bool read_elements, const std::string& raw_inputs);

// A literal that reads back as the same double and is not an integer.
std::string literal(double value);

}  // namespace ergon
