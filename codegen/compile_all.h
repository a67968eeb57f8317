#pragma once
// Several kernels at once: generated one after the other, while the C++ compiler runs for as many of them as there are
// cores.

#include <exception>
#include <string>
#include <vector>

#include "codegen/compile.h"

namespace ergon {

struct CompileJob {
  const Energy* energy = nullptr;
  CompileOptions options;
};

// A kernel, or why there is none.
struct CompileOutcome {
  CompiledKernel kernel;
  std::exception_ptr error;  // of the types that compile() throws
  std::string message;       // its what(); "" when there is a kernel
};

// One outcome for each job, in their order, whatever happens to the others. `workers`: C++ compilers at a time; 0: one
// for each core.
std::vector<CompileOutcome> compile_all(const std::vector<CompileJob>& jobs, int workers = 0);

// The kernels, in order. Throws what the only job that failed threw; when several failed, BuildError with the messages
// of all in the order of the jobs.
std::vector<CompiledKernel> kernels_of(std::vector<CompileOutcome> outcomes);

}  // namespace ergon
