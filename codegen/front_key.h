#pragma once
// The key of a kernel that is known before its source is generated, and the note kept under it: a kernel that is in the
// cache is found without running a pass. It establishes that whatever can change the source changes the key, the
// program that generates it included.

#include <optional>
#include <string>
#include <string_view>

#include "codegen/emit.h"
#include "codegen/program_identity.h"
#include "codegen/vector_type.h"
#include "symbolic/energy.h"

namespace ergon {

struct FrontOptions {
  std::string case_name{};
  VectorType type = 1;
  bool stable = true;
  std::string compiler{};
};

// `program`: the identity of the program that generates.
std::string front_key(const Energy& energy, const FrontOptions& options, std::string_view program = kProgramIdentity);

// What generating gave: the key of the library and what is told of it.
struct KernelNote {
  std::string key;
  size_t source_bytes = 0;
  OperationCounts counts;
};

std::string to_text(const KernelNote& note, const std::string& front);
// Nothing when the text is not a note of that front key.
std::optional<KernelNote> note_from(const std::string& text, const std::string& front);

// "spring-w8-" of doubles, "spring-f16-" of floats: how keys begin.
std::string key_stem(const Energy& energy, VectorType type);

}  // namespace ergon
