#pragma once
// A kernel evaluated at test states, with the chain from q to the degrees of freedom.

#include <vector>

#include "codegen/compile.h"
#include "symbolic/reference.h"

namespace ergon::testing {

struct KernelValue {
  double value = 0;
  double require = 0;
  std::vector<double> update;     // new values of what the energy renews, one after the other
  std::vector<double> gradient;   // over all dof components
  std::vector<double> hessian;    // n x n, column by column
  std::vector<double> q_hessian;  // lower triangle packed by rows
  // Of the entry that projects in closed form, when there is one: [0] clamped, [1] absolute.
  std::vector<double> projected[2];
  bool changed[2] = {false, false};
};

// Loads the kernel for a width; kernels are kept in the build folder between runs.
CompiledKernel test_kernel(const Energy& energy, const std::string& case_name, int lanes);

// Evaluates up to any number of states that share the params of the first one, filling lanes with the last state.
std::vector<KernelValue> evaluate_kernel(const Energy& energy, const ErgonKernel& kernel,
                                         const std::vector<Inputs>& states);

// Widths that this machine can run.
std::vector<int> test_widths();

}  // namespace ergon::testing
