#pragma once
// Which values of a program outlive an evaluation, and where they are kept.

#include <vector>

#include "codegen/schedule.h"

namespace ergon {

// Slot numbers by instruction, -1 where there is none. A value has a slot when something of shorter lifetime uses it.
struct Slots {
  std::vector<int> uniform, element;    // instruction -> slot
  std::vector<int> uniforms, elements;  // slot -> instruction
};

Slots assign_slots(const Schedule& schedule);

// Instructions that the roots need, operands first, stopping at values that `given` holds a slot for.
std::vector<int> needed(const Program& program, const std::vector<int>& roots,
                        const std::vector<const std::vector<int>*>& given);

}  // namespace ergon
