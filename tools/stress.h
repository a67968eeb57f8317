#pragma once
// Runs scenes that try the solver, and judges them.

#include <functional>
#include <string>

#include "tools/stress_cases.h"

namespace ergon {

struct StressOutcome {
  std::string name, element;
  std::string fault;  // "" where the case holds
  long steps = 0;     // taken
  long newton_iterations = 0;
  long unconverged = 0;     // steps
  double smallest_gap = 0;  // m; +inf where nothing came near
  // J, largest rise of energy that no work, load or change of stiffness explains: in a step of implicit Euler; of other
  // integrators since the start, as in what they know of the last step they hold energy that a step may give back.
  double energy_created = 0;
  double energy = 0;    // J, largest sum of kinetic and stored energies, to compare it with
  double residual = 0;  // J, largest of the budget
  double seconds = 0;
};

// Every step is tested exactly for intersections. `steps`: at most so many; 0: all.
StressOutcome run_stress_case(const StressCase& what, const std::string& element, const KernelSource& kernels,
                              long steps = 0);
// Both scenes of a pair of units, and the largest difference of their positions.
StressOutcome run_stress_units(const std::string& element, const KernelSource& kernels, long steps = 0);

}  // namespace ergon
