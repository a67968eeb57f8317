#pragma once
// What the compiler makes of an energy, as findings of `ergon check`: structure, cost, accuracy. No C++ compiler is
// asked: the graph is evaluated as the kernel would.

#include <string>
#include <vector>

#include "symbolic/checks.h"

namespace ergon {

// "constant, positive semi-definite", "isotropic, projected in closed form", ...: of the Hessian of one case.
std::string structure_text(const Energy& energy, const std::string& case_name);

// Of every case; "structure", "cost" and "accuracy" in this order. An error where value or derivatives of the graph are
// not those of 50 digits.
std::vector<Finding> kernel_findings(const Energy& energy);

}  // namespace ergon
