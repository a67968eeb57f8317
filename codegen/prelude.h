#pragma once
// The opening of an emitted file: the vector type and just the functions that the kernel uses.

#include <set>
#include <string>

#include "codegen/vector_type.h"

namespace ergon {

// `used` holds names such as "v_log" (over lanes) and "s_sqrt" (one double). Transcendental functions over 2, 4 and
// 8 lanes are those of glibc's libmvec (errors up to 4 ulp, see the glibc manual, "Errors in Math Functions"); one lane
// uses libm.
std::string prelude(VectorType type, std::set<std::string> used);

}  // namespace ergon
