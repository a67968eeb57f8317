#include "runtime/solver/step_cost.h"

namespace ergon {

namespace {

void add_seconds(const NewtonSeconds& part, NewtonSeconds& sum) {
  sum.evaluate += part.evaluate;
  sum.factor += part.factor;
  sum.solve += part.solve;
  sum.line_search += part.line_search;
  sum.contact += part.contact;
}

template <class Counted>
void add_counts(const Counted& part, StepRecord& sum) {
  sum.follow_iterations += part.follow_iterations;
  sum.factorisations += part.factorisations;
  sum.factor_flops += part.factor_flops;
  sum.halvings += part.halvings;
  sum.shifts += part.shifts;
  sum.indefinite += part.indefinite;
  add_seconds(part.seconds, sum.seconds);
}

}  // namespace

void add_solve(const NewtonResult& result, StepRecord& record) {
  record.newton_iterations += result.iterations;
  add_counts(result, record);
}

void add_refused(const StepRecord& refused, StepRecord& record) {
  record.newton_iterations += refused.newton_iterations;
  add_counts(refused, record);
  record.seconds.total += refused.seconds.total;
  record.refused += refused.refused + 1;
}

}  // namespace ergon
