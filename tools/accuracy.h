#pragma once
// How accurate a kernel is: its value, gradient and Hessian against 50 digits, over strains from tiny to huge, with the
// rewriting of what cancels (codegen/rest_form.h) and without.

#include <string>
#include <vector>

#include "symbolic/energy.h"

namespace ergon {

// Errors in units of 2^-53, in single precision 2^-24, relative to the exact result; of gradients and Hessians in the
// norm of all their entries.
struct Ulps {
  double median = 0, largest = 0;
};

struct Accuracy {
  double strain = 0;
  int states = 0;
  // By value, gradient, Hessian.
  Ulps naive[3], emitted[3];
  // Largest change of the exact result, relative to it, per relative change of the kernel's inputs: parameters, rest
  // and lag data, and points or, where the kernel takes those, their displacements. An error of a few times
  // 1 + condition is what a backward stable evaluation makes.
  double condition[3] = {0, 0, 0};
  // Largest emitted error over 1 + condition of its state.
  double excess[3] = {0, 0, 0};
};

struct AccuracyOptions {
  double smallest = 1e-12, largest = 1e3;  // strains, one per decade
  int directions = 12;                     // states per strain
  int lanes = 1;
  bool single = false;  // of the kernel in single precision, which is given the state in doubles
};

// One entry for each strain at which a state was found. Throws SourceError and BuildError.
std::vector<Accuracy> measure_accuracy(const Energy& energy, const std::string& case_name,
                                       const AccuracyOptions& options);

}  // namespace ergon
