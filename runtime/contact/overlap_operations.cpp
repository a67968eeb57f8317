#include "runtime/lanes/lanes.h"
#include "runtime/lanes/overlaps.h"

namespace ergon::lanes {

const OverlapOperations& overlap_operations_1();
#if defined(__x86_64__)
const OverlapOperations& overlap_operations_4();
const OverlapOperations& overlap_operations_8();
#endif

const OverlapOperations& overlap_operations() {
#if defined(__x86_64__)
  if (best_lanes() == 8) return overlap_operations_8();
  if (best_lanes() == 4) return overlap_operations_4();
#endif
  return overlap_operations_1();
}

}  // namespace ergon::lanes
