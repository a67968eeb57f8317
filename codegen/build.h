#pragma once
// Pass 10: an emitted source becomes a shared library, by the C++ compiler of the machine.

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "codegen/vector_type.h"

namespace ergon {

// No compiler, or one that refused the source; what() says which and what to do.
class BuildError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// $ERGON_CXX, or "g++".
std::string default_compiler();

// What tells one installed compiler from another: a hash of its file's path, size and time of change; "" when there is
// no such program. An upgrade changes it.
std::string compiler_identity(const std::string& compiler);

// The command line after the compiler's name. -O1: straight-line code of this kind compiles in less time and runs
// faster than at -O2, whose scheduling lengthens live ranges.
std::vector<std::string> compiler_flags(VectorType type);

// Compiles `source` into `library`. Throws BuildError.
void build_library(const std::string& compiler, VectorType type, const std::filesystem::path& source,
                   const std::filesystem::path& library);

}  // namespace ergon
