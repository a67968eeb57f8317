#pragma once
// Kernel libraries, and notes on them, kept on disk by the hash of everything that determines them. A file ends with a
// hash of its own content, so that one that is damaged or half-written is found out and made again; files appear whole,
// by renaming, so that processes may share a folder.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "codegen/vector_type.h"
#include "runtime/kernel.h"

namespace ergon {

struct LoadedKernel {
  std::shared_ptr<void> library;  // keeps the code loaded
  const ErgonKernel* table = nullptr;
};

class KernelCache {
 public:
  // `folders` are searched in order; the first that can be written receives new kernels.
  explicit KernelCache(std::vector<std::filesystem::path> folders);

  // Where kernels are kept unless told otherwise: $ERGON_CACHE, $XDG_CACHE_HOME/ergon, ~/.cache/ergon, or a folder of
  // this user under the temporary directory.
  static std::filesystem::path user_folder();

  // The kernel of that key made by that compiler (compiler_identity), if a sound file for this machine is there; with
  // "", one made by any.
  std::optional<LoadedKernel> load(const std::string& key, const std::string& maker) const;

  // A short text kept under a key, sealed as libraries are; nothing when no folder has a sound one.
  std::optional<std::string> note(const std::string& key) const;
  // Keeps it in the first folder that can be written, if there is one.
  void keep_note(const std::string& key, const std::string& text) const;

  // Builds a library from `source` with that key and loads it. Throws BuildError; std::runtime_error when no folder is
  // writable.
  LoadedKernel make(const std::string& key, const std::string& maker, const std::string& source, VectorType type,
                    const std::string& compiler, double* compile_seconds) const;

 private:
  std::vector<std::filesystem::path> folders_;
};

}  // namespace ergon
