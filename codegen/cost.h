#pragma once
// What each entry point of a kernel costs, counted on the straight-line code that is emitted: a property of the energy,
// the same on every machine and for every width.

#include <string>
#include <vector>

#include "codegen/schedule.h"

namespace ergon {

// Per lane, that is per stencil or point of quadrature; of prepare_uniforms per material.
struct EntryCost {
  std::string entry;   // "prepare_uniforms", "prepare_elements", "conditions", "value", "gradient", "hessian",
                       // "principal", "projected"
  int operations = 0;  // all of the following three among them
  int divisions = 0;
  int roots = 0;
  int calls = 0;          // transcendental functions
  int bytes_in = 0;       // q, rest and lag data, values kept per element: what it reads of them
  int bytes_uniform = 0;  // params and values kept per material: read once for all lanes
  int bytes_out = 0;
};

// In the order above; "principal" only for an isotropic density, and before it "value, far", "gradient, far" and
// "hessian, far" where lanes far from rest have a form of their own (codegen/rest_form.h). "projected" where the
// projected Hessian has a closed form (codegen/closed_form.h).
std::vector<EntryCost> cost_of_entries(const Schedule& schedule);

// Operations of value, gradient and projected Hessian, as the entry points that are evaluated count them: of an
// isotropic density gradient and principal, of a closed form projected, else hessian.
int operations_when_projected(const std::vector<EntryCost>& entries);

// One line per entry point under a line of titles, each line beginning with `margin`.
std::string cost_table(const std::vector<EntryCost>& entries, const std::string& margin);

}  // namespace ergon
