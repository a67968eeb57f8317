#pragma once
// What several tests of meshes need.

#include <numeric>
#include <string>
#include <vector>

#include "runtime/error.h"

namespace ergon {

// The message of the InputError that the call throws, or "no error".
template <class Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

inline double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

}  // namespace ergon
