#include <stdexcept>
#include <string>

#include "runtime/lanes/lanes.h"

namespace ergon::lanes {

const LaneOperations& operations_1();
const LaneOperations& operations_2();
const LaneOperations& single_operations_1();
const LaneOperations& single_operations_4();
#if defined(__x86_64__)
const LaneOperations& operations_4();
const LaneOperations& operations_8();
const LaneOperations& single_operations_8();
const LaneOperations& single_operations_16();
#endif

int best_lanes() {
#if defined(__x86_64__)
  // What -march=x86-64-v4 and -march=x86-64-v3 let the compiler use in vector code.
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) {
    return 8;
  }
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
      __builtin_cpu_supports("bmi2")) {
    return 4;
  }
#endif
  return 2;
}

int best_single_lanes() { return 2 * best_lanes(); }

const LaneOperations& lane_operations(int lanes) {
  if (lanes == 1) return operations_1();
  if (lanes == 2) return operations_2();
#if defined(__x86_64__)
  if (lanes == 4 && best_lanes() >= 4) return operations_4();
  if (lanes == 8 && best_lanes() >= 8) return operations_8();
#endif
  throw std::invalid_argument("kernel built for " + std::to_string(lanes) + " lanes; this machine offers at most " +
                              std::to_string(best_lanes()));
}

const LaneOperations& single_lane_operations(int lanes) {
  if (lanes == 1) return single_operations_1();
  if (lanes == 4) return single_operations_4();
#if defined(__x86_64__)
  if (lanes == 8 && best_single_lanes() >= 8) return single_operations_8();
  if (lanes == 16 && best_single_lanes() >= 16) return single_operations_16();
#endif
  throw std::invalid_argument("kernel built for " + std::to_string(lanes) +
                              " lanes of floats; this machine offers at most " + std::to_string(best_single_lanes()));
}

}  // namespace ergon::lanes
