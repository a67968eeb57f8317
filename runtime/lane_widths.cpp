// The width of vectors at which parts of contact run.

#include <stdexcept>
#include <string>

#include "runtime/lanes/distances.h"
#include "runtime/lanes/lanes.h"
#include "runtime/lanes/overlaps.h"
#include "runtime/lanes/steps.h"

namespace ergon::lanes {

const DistanceOperations& distance_operations_1();
const DistanceOperations& distance_operations_2();
const OverlapOperations& overlap_operations_1();
const OverlapOperations& overlap_operations_2();
const StepOperations& step_operations_1();
const StepOperations& step_operations_2();
#if defined(__x86_64__)
const DistanceOperations& distance_operations_4();
const DistanceOperations& distance_operations_8();
const OverlapOperations& overlap_operations_4();
const OverlapOperations& overlap_operations_8();
const StepOperations& step_operations_4();
const StepOperations& step_operations_8();
#endif

const DistanceOperations& distance_operations(int lanes) {
  lane_operations(lanes);  // throws
#if defined(__x86_64__)
  if (lanes == 8) return distance_operations_8();
  if (lanes == 4) return distance_operations_4();
#endif
  return lanes == 2 ? distance_operations_2() : distance_operations_1();
}

const OverlapOperations& overlap_operations(int lanes) {
  lane_operations(lanes);
#if defined(__x86_64__)
  if (lanes == 8) return overlap_operations_8();
  if (lanes == 4) return overlap_operations_4();
#endif
  return lanes == 2 ? overlap_operations_2() : overlap_operations_1();
}

const StepOperations& step_operations(int lanes) {
  lane_operations(lanes);
#if defined(__x86_64__)
  if (lanes == 8) return step_operations_8();
  if (lanes == 4) return step_operations_4();
#endif
  return lanes == 2 ? step_operations_2() : step_operations_1();
}

}  // namespace ergon::lanes
