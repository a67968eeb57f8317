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
// (element). Scalars (constant and uniform values) are of the type `real`, all else is V; in a function that has no
// lanes (`scalar`) everything is double.
FunctionText function_text(const Program& program, const Slots& slots, const std::vector<Output>& outputs, bool scalar,
                           bool read_uniforms, bool read_elements, const std::string& raw_inputs,
                           const std::string& real = "double");

// Positive constants below this are there to keep divisors from being zero.
constexpr double kGuard = 1e-200;

// A literal that reads back as the same double, or as the nearest float, and is not an integer.
std::string literal(double value, bool single = false);

}  // namespace ergon
