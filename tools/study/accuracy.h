#pragma once
// The work-precision study of a problem: every setting run, its error against a reference, and which settings no other
// one beats in both error and work (the Pareto front).

#include <functional>
#include <string>
#include <vector>

#include "tools/study/accuracy_problems.h"
#include "tools/study/study_run.h"

namespace ergon {

struct AccuracyRow {
  AccuracySetting setting;
  StudyRun run;
  double error = 0;            // study_error against the reference
  bool least_work = false;     // no other is as accurate for less work
  bool least_seconds = false;  // nor in less time
};

struct AccuracyStudy {
  AccuracyProblem problem;
  std::vector<AccuracyRow> rows;
  StudyRun reference;
  double reference_error = 0;  // of the other reference against it
};

// seen: called with each row once it was run. Throws std::runtime_error where a reference fails.
AccuracyStudy run_accuracy(const AccuracyProblem& problem, StudyRunner& runner,
                           const std::function<void(const AccuracyRow&)>& seen);

using Cost = double (*)(const AccuracyRow&);
double work_of(const AccuracyRow& row);
double seconds_of(const AccuracyRow& row);

using Which = std::function<bool(const AccuracySetting&)>;
// The rows, among those of some settings, that no other of them is as accurate as at less cost: from the least cost,
// with errors that fall.
std::vector<const AccuracyRow*> front(const std::vector<AccuracyRow>& rows, Cost cost, const Which& which);
// The one of least cost with at most this error; null where there is none.
const AccuracyRow* cheapest(const std::vector<AccuracyRow>& rows, Cost cost, const Which& which, double error);

// What the study says at an error: how the cheapest setting of all compares with Tet4 (Tri3) and implicit Euler.
struct AccuracyVerdict {
  double error = 0;
  const AccuracyRow* best = nullptr;   // null: no setting is as accurate
  const AccuracyRow* plain = nullptr;  // of linear tetrahedra or triangles and implicit Euler
  // By `plain`. Else it is the costliest of which neither the mesh is fine enough, with any integrator, nor the step is
  // short enough, on any mesh, so that its kind needs more than what it cost.
  bool reached = false;
  double time_ratio = 0, work_ratio = 0;  // of `plain` to `best`
  // With the element and integrator that a scene has by default; of membranes, which have no element by default, Quad9.
  const AccuracyRow* by_default = nullptr;  // null: none is as accurate
  double default_time_ratio = 0, default_work_ratio = 0;
};
std::vector<AccuracyVerdict> verdicts(const AccuracyStudy& study);

// All rows of all studies, the references among them (RFC 4180).
std::string accuracy_table(const std::vector<AccuracyStudy>& studies);
// Run time against error by element, by integrator, and work against error, as SVG.
std::string accuracy_charts(const AccuracyStudy& study);

}  // namespace ergon
