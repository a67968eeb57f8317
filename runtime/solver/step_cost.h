#pragma once
// The one place where the counters and seconds of solves are added up: of the solves of a step, and of steps that were
// refused with the one that stands in their place.

#include "runtime/solver/newton.h"
#include "runtime/solver/time_step.h"

namespace ergon {

void add_solve(const NewtonResult& result, StepRecord& record);
// Counts the refused step in record.refused too.
void add_refused(const StepRecord& refused, StepRecord& record);

}  // namespace ergon
