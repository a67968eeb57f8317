#pragma once
// Kernels for tests of scenes: compiled for this machine, or from the cache.

#include "codegen/compile.h"
#include "runtime/lanes/lanes.h"
#include "scenes/builder.h"
#include "scenes/scene_reader.h"

namespace ergon {

inline Kernel real_kernel(const Energy& energy, const std::string& case_name) {
  CompileOptions options;
  options.case_name = case_name;
  options.lanes = lanes::best_lanes();
  options.read_only_caches = {ERGON_BINARY_DIR "/kernels"};
  const CompiledKernel compiled = compile(energy, options);
  return {compiled.library, compiled.table};
}

inline Catalogue shipped_energies() { return Catalogue({ERGON_SOURCE_DIR "/energies"}); }

inline BuiltScene build_text(const std::string& text, const std::string& file = "a.toml") {
  return build_scene(read_scene_text(text, file), shipped_energies(), real_kernel);
}

}  // namespace ergon
