#pragma once
// Kernels for tests of scenes: compiled for this machine, or from the cache.

#include "codegen/compile_all.h"
#include "runtime/lanes/lanes.h"
#include "scenes/builder.h"
#include "scenes/scene_reader.h"
#include "tests/paths.h"

namespace ergon {

inline std::vector<Kernel> real_kernels(const std::vector<KernelRequest>& requests) {
  CompileOptions options;
  options.lanes = lanes::best_lanes();
  options.read_only_caches = {test::built("/kernels")};
  std::vector<CompileJob> jobs;
  for (const auto& [energy, case_name] : requests) {
    options.case_name = case_name;
    jobs.push_back({energy, options});
  }
  std::vector<Kernel> kernels;
  for (const CompiledKernel& compiled : kernels_of(compile_all(jobs)))
    kernels.push_back({compiled.library, compiled.table});
  return kernels;
}

inline Catalogue shipped_energies() { return Catalogue({test::source("/energies")}); }

inline BuiltScene build_text(const std::string& text, const std::string& file = "a.toml") {
  return build_scene(read_scene_text(text, file), shipped_energies(), real_kernels);
}

}  // namespace ergon
