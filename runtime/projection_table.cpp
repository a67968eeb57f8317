#include "runtime/lanes/projection_table.h"

#include "runtime/lanes/lanes.h"

namespace ergon::lanes {

const ProjectionTable& projection_table_1();
const ProjectionTable& projection_table_2();
#if defined(__x86_64__)
const ProjectionTable& projection_table_4();
const ProjectionTable& projection_table_8();
#endif

const ProjectionTable& projection_table(int lanes) {
  lane_operations(lanes);
#if defined(__x86_64__)
  if (lanes == 4) return projection_table_4();
  if (lanes == 8) return projection_table_8();
#endif
  return lanes == 2 ? projection_table_2() : projection_table_1();
}

}  // namespace ergon::lanes
