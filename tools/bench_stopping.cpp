// ergon bench stopping: what tolerances of iterations and stiffnesses of contact add to the error.

#include <fmt/format.h>

#include <cmath>
#include <ostream>

#include "tools/bench.h"
#include "tools/study/stopping.h"

namespace ergon {
namespace {

Row row_of(const StoppingStudy& study, const StoppingRow& row) {
  Row out = {{"study", study.sweep.study},
             {"problem", study.sweep.problem},
             {"key", study.sweep.key},
             {"value", row.value.text},
             {"default", row.value.is_default},
             {"error", nullptr},
             {"dt_error", study.dt_error},
             {"mesh_error", study.mesh_error},
             {"newton_iterations", row.run.newton_iterations},
             {"linear_solves", row.run.linear_solves},
             {"work", row.run.work()},
             {"seconds", row.run.seconds},
             {"failure", row.run.failure}};
  if (std::isfinite(row.error)) out["error"] = row.error;
  return out;
}

void print(const StoppingStudy& study, std::ostream& out) {
  const StoppingSweep& sweep = study.sweep;
  out << fmt::format("{}: {}, {}; dt alone is {:.2g} % off", sweep.study, sweep.problem, sweep.key,
                     100 * study.dt_error);
  if (!sweep.finer_mesh.empty()) out << fmt::format(", the mesh alone {:.2g} %", 100 * study.mesh_error);
  out << '\n';
  for (const StoppingRow& row : study.rows) {
    if (!row.run.failure.empty()) {
      out << fmt::format("  {:>20}  fails: {}\n", row.value.text, row.run.failure);
      continue;
    }
    out << fmt::format("  {:>20}  {:9.2g} %  {:6} Newton iterations  {:8.3g} Gflop  {:6.2g} s{}\n", row.value.text,
                       100 * row.error, row.run.newton_iterations, row.run.work() / 1e9, row.run.seconds,
                       row.value.is_default ? "  default" : "");
  }
  out << std::flush;
}

}  // namespace

void bench_stopping(const BenchStopping& options, std::ostream& out) {
  StudyRunner runner(options.folder, options.again);
  Rows rows(out, options.json);
  for (const StoppingSweep& sweep : stopping_sweeps(options.study, options.brief)) {
    const StoppingStudy study = run_stopping(sweep, runner);
    if (!options.json) print(study, out);
    for (const StoppingRow& row : study.rows)
      if (options.json) rows.add(row_of(study, row));
  }
}

}  // namespace ergon
