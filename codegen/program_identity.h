#pragma once

namespace ergon {

// Tells one build of the compiler from another: the hashes of the libraries made of symbolic/ and codegen/, set when
// the program is linked (tools/program_identity.cmake).
extern const char* const kProgramIdentity;

}  // namespace ergon
