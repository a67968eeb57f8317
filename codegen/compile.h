#pragma once
// The compiler's main path: from an energy to a loaded kernel.

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "codegen/emit.h"
#include "codegen/module.h"
#include "runtime/kernel.h"
#include "symbolic/energy.h"

namespace ergon {

struct CompileOptions {
  std::string case_name{};  // one of the energy's cases; "" when it has none
  int lanes = 1;            // 1, 2, 4 or 8; of floats 1, 4, 8 or 16
  bool single = false;      // evaluate in single precision: the kernel's entry points are ErgonSingle
  std::vector<std::filesystem::path>
      read_only_caches{};         // searched first, e.g. the catalogue compiled with the program
  std::filesystem::path cache{};  // "" means KernelCache::user_folder()
  bool stable = true;             // false: what cancels near rest is left as written
  bool use_cached = true;         // false: build even if a sound kernel is there
  std::string compiler{};         // "" means default_compiler()
  // Called after each pass with its name and the graph as text, when set.
  std::function<void(const std::string& pass, const std::string& text)> dump{};
};

// Seconds spent in each part.
struct CompileTimes {
  double lower = 0, rest = 0, frontier = 0, differentiate = 0, structure = 0, principal = 0, parts = 0, schedule = 0,
         emit = 0, compile = 0, load = 0;
  double total() const {
    return lower + rest + frontier + differentiate + structure + principal + parts + schedule + emit + compile + load;
  }
};

// What the passes give before any C++ compiler is asked.
struct Generated {
  Module module;
  std::string source;
  OperationCounts counts;
  std::vector<EntryCost> costs;
  CompileTimes times;
};

struct CompiledKernel {
  std::shared_ptr<void> library;  // keeps the code loaded
  const ErgonKernel* table = nullptr;
  size_t source_bytes = 0;
  OperationCounts counts;
  CompileTimes times;
  bool cached = false;
};

// `energy` must outlive the result's module. Throws SourceError for what cannot be compiled, and for a density in
// principal stretches that is not symmetric in them.
Generated generate(const Energy& energy, const CompileOptions& options);

// A kernel that a cache holds, loaded; else what building it takes.
struct PreparedKernel {
  CompiledKernel kernel;
  std::string source;      // "" when it was found without being generated
  std::string front, key;  // codegen/front_key.h; of the library
  std::string compiler, maker;
  std::filesystem::path cache;
  VectorType type = 1;
};

// The two halves of compile(): all that is the program's own, and the C++ compiler (which may run in several threads at
// once). finish() throws BuildError (codegen/build.h).
PreparedKernel prepare(const Energy& energy, const CompileOptions& options);
CompiledKernel finish(PreparedKernel prepared);

// Also throws BuildError.
CompiledKernel compile(const Energy& energy, const CompileOptions& options);

}  // namespace ergon
