#pragma once

namespace ergon {

// The text of runtime/kernel.h, embedded when Ergon is built, so that emitted files need no header and cannot differ
// from it.
extern const char* const kKernelAbiText;

}  // namespace ergon
