// ergon bench accuracy: run time and work against error, over five problems.

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <ostream>

#include "runtime/output/atomic_file.h"
#include "scenes/run.h"
#include "tools/bench.h"
#include "tools/study/accuracy.h"

namespace ergon {
namespace {

Row row_of(const AccuracyStudy& study, const AccuracyRow& row) {
  Row out = {{"problem", study.problem.name},
             {"element", row.setting.element},
             {"cells", row.setting.cells},
             {"integrator", row.setting.integrator},
             {"dt", row.setting.dt},
             {"tolerance", row.setting.tolerance},
             {"precision", row.setting.precision},
             {"time_tolerance", row.setting.time_tolerance},
             {"error", nullptr},
             {"seconds", row.run.seconds},
             {"work", row.run.work()},
             {"newton_iterations", row.run.newton_iterations},
             {"linear_solves", row.run.linear_solves},
             {"least_work", row.least_work},
             {"least_seconds", row.least_seconds},
             {"failure", row.run.failure}};
  if (std::isfinite(row.error)) out["error"] = row.error;
  return out;
}

Row row_of(const AccuracyStudy& study, const AccuracyVerdict& verdict) {
  const auto setting = [](const AccuracyRow* row) { return row == nullptr ? Row() : Row(row->setting.text()); };
  const auto number = [](const AccuracyRow* row, Cost cost) { return row == nullptr ? Row() : Row(cost(*row)); };
  return {{"problem", study.problem.name},
          {"smooth", study.problem.smooth},
          {"within", verdict.error},
          {"best", setting(verdict.best)},
          {"seconds", number(verdict.best, seconds_of)},
          {"work", number(verdict.best, work_of)},
          {"plain", setting(verdict.plain)},
          {"plain_reached", verdict.reached},
          {"plain_error", verdict.plain == nullptr ? Row() : Row(verdict.plain->error)},
          {"time_ratio", verdict.time_ratio},
          {"work_ratio", verdict.work_ratio},
          {"default", setting(verdict.by_default)},
          {"default_time_ratio", verdict.default_time_ratio},
          {"default_work_ratio", verdict.default_work_ratio}};
}

Row reference_row(const AccuracyStudy& study) {
  return {{"problem", study.problem.name},
          {"reference", study.problem.reference.text()},
          {"tolerance", study.problem.reference.tolerance},
          {"other_reference", study.problem.other_reference.text()},
          {"reference_error", study.reference_error}};
}

std::string sentence(const AccuracyVerdict& verdict) {
  std::string out = fmt::format("  within {:g} %: ", 100 * verdict.error);
  if (verdict.best == nullptr) return out + "no setting\n";
  out += fmt::format("{}: {:.3g} s, {:.3g} Gflop", verdict.best->setting.text(), seconds_of(*verdict.best),
                     work_of(*verdict.best) / 1e9);
  if (verdict.by_default != nullptr)
    out += fmt::format("; by default ({}) {:.3g} times the time, {:.3g} times the work",
                       verdict.by_default->setting.text(), verdict.default_time_ratio, verdict.default_work_ratio);
  if (verdict.plain == nullptr) return out + "\n";
  const AccuracyRow& plain = *verdict.plain;
  if (verdict.reached)
    return out + fmt::format("; {} takes {:.3g} times the time, {:.3g} times the work\n", plain.setting.text(),
                             verdict.time_ratio, verdict.work_ratio);
  return out + fmt::format("; {} took {:.3g} times the time, {:.3g} times the work, and is still {:.3g} % off\n",
                           plain.setting.text(), verdict.time_ratio, verdict.work_ratio, 100 * plain.error);
}

void print_summary(const AccuracyStudy& study, std::ostream& out) {
  out << fmt::format("{}: {}; {} runs\n", study.problem.name, study.problem.summary, study.rows.size());
  out << fmt::format("  reference {}; {} differs by {:.2g} %\n", study.problem.reference.text(),
                     study.problem.other_reference.text(), 100 * study.reference_error);
  for (const AccuracyVerdict& verdict : verdicts(study)) out << sentence(verdict);
  out << "  front:\n";
  for (const AccuracyRow* row : front(study.rows, work_of, [](const AccuracySetting&) { return true; }))
    out << fmt::format("    {:8.3g} %  {:8.3g} s  {:8.3g} Gflop  {}\n", 100 * row->error, row->run.seconds,
                       row->run.work() / 1e9, row->setting.text());
  out << std::flush;
}

}  // namespace

void bench_accuracy(const BenchAccuracy& options, std::ostream& out) {
  namespace fs = std::filesystem;
  const std::vector<AccuracyProblem> problems = accuracy_problems(options.brief, options.problems);
  prepare_output(options.folder);
  StudyRunner runner(options.folder, options.again);
  Rows rows(out, options.json);
  std::vector<AccuracyStudy> studies;
  for (const AccuracyProblem& problem : problems) {
    size_t done = 0;
    const auto seen = [&](const AccuracyRow& row) {
      ++done;
      if (options.progress)
        out << fmt::format("{} {}/{}  {}  {:.3g} %  {:.3g} s\n", problem.name, done, problem.settings.size(),
                           row.setting.text(), 100 * row.error, row.run.seconds)
            << std::flush;
    };
    studies.push_back(run_accuracy(problem, runner, seen));
    const AccuracyStudy& study = studies.back();
    write_file((fs::path(options.folder) / (problem.name + ".svg")).string(), accuracy_charts(study));
    write_file((fs::path(options.folder) / "accuracy.csv").string(), accuracy_table(studies));
    if (!options.json) {
      print_summary(study, out);
      continue;
    }
    rows.add(reference_row(study));
    for (const AccuracyRow& row : study.rows) rows.add(row_of(study, row));
    for (const AccuracyVerdict& verdict : verdicts(study)) rows.add(row_of(study, verdict));
  }
}

}  // namespace ergon
