#pragma once
// How rules that end an iteration, and stiffnesses that stand for constraints, enter the error: each varied by itself
// about what a scene has without it, against the same scene with a strict value, beside the error from dt and mesh.

#include <string>
#include <vector>

#include "tools/study/study_run.h"

namespace ergon {

struct StoppingValue {
  std::string text;                  // "0.01"; as the table has it
  std::vector<std::string> changes;  // "PATH=VALUE"
  bool is_default = false;
};

struct StoppingSweep {
  std::string study;  // tolerance, friction or barrier
  std::string problem;
  std::string key;                           // of the scene, with its unit
  std::vector<std::string> base;             // changes of all runs
  std::vector<StoppingValue> values;         // one is the default
  std::vector<std::string> strict;           // changes of the reference
  std::vector<std::string> finer_dt;         // of the run that tells the error from dt: other than base
  std::vector<std::string> finer_mesh = {};  // likewise of the mesh
};

struct StoppingRow {
  StoppingValue value;
  StudyRun run;
  double error = 0;  // study_error against the strict run
};

struct StoppingStudy {
  StoppingSweep sweep;
  std::vector<StoppingRow> rows;
  double dt_error = 0;    // of the strict run against that with a finer dt
  double mesh_error = 0;  // and with a finer mesh
};

// study: "" for all. brief: the first sweep of each study, three values of it, without the finer mesh. Throws
// InputError for an unknown study.
std::vector<StoppingSweep> stopping_sweeps(const std::string& study, bool brief);

// Throws std::runtime_error where a run that others are compared with fails.
StoppingStudy run_stopping(const StoppingSweep& sweep, StudyRunner& runner);

}  // namespace ergon
