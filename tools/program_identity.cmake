# Writes OUT, which defines kProgramIdentity (codegen/program_identity.h): the hashes of the files CODEGEN and SYMBOLIC.
cmake_minimum_required(VERSION 3.25)
file(SHA256 ${CODEGEN} codegen)
file(SHA256 ${SYMBOLIC} symbolic)
file(CONFIGURE OUTPUT ${OUT} CONTENT
"#include \"codegen/program_identity.h\"\nnamespace ergon {\nconst char* const kProgramIdentity = \"@codegen@-@symbolic@\";\n}\n" @ONLY)
