#pragma once
// Pass 9: straight-line code becomes self-contained C++ of W lanes, readable and without headers.

#include <string>
#include <vector>

#include "codegen/cost.h"
#include "codegen/module.h"
#include "codegen/schedule.h"
#include "codegen/vector_type.h"

namespace ergon {

// Operations per stencil or quadrature point and lane, what is computed once not counted.
struct OperationCounts {
  int value = 0;
  int gradient = 0;   // value and gradient
  int hessian = 0;    // value, gradient and Hessian
  int projected = 0;  // the same with the Hessian projected in closed form; 0 when it has none
  int divisions = 0;  // in the Hessian entry point; square roots are counted apart
  int roots = 0;
  int calls = 0;      // transcendental functions
  int principal = 0;  // blocks of an isotropic density
  int uniforms = 0;   // values computed once per material
  int elements = 0;   // values kept per element
};

struct Emitted {
  std::string source;
  OperationCounts counts;
  std::vector<EntryCost> costs;  // as the head of the source tells them
};

// The entry points of runtime/kernel.h for vectors of that type. Throws SourceError for a number in the energy that no
// float comes near.
Emitted emit(const Module& module, const Schedule& schedule, VectorType type);

}  // namespace ergon
