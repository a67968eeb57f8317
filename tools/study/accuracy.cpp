#include "tools/study/accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "scenes/scene.h"

namespace ergon {
namespace {

bool is_plain(const AccuracySetting& setting) {
  return (setting.element == "tet4" || setting.element == "tri3") && setting.integrator == "implicit_euler";
}

bool is_default(const AccuracySetting& setting) {
  const AccuracySetting usual;
  SceneObject block;
  block.box.emplace();
  return (setting.element == block.element_name() || setting.element == "quad9") &&
         setting.integrator == TimeSettings{}.integrator && setting.tolerance == usual.tolerance &&
         setting.precision == usual.precision && setting.time_tolerance == 0;
}

// Of the plain ones: neither its mesh nor its step lets any setting be as accurate.
const AccuracyRow* costliest_short_of(const std::vector<AccuracyRow>& rows, double error) {
  const AccuracyRow* out = nullptr;
  for (const AccuracyRow& row : rows) {
    if (!is_plain(row.setting) || !row.run.failure.empty()) continue;
    const auto same_mesh = [&](const AccuracySetting& other) {
      return other.element == row.setting.element && other.cells == row.setting.cells;
    };
    const auto same_step = [&](const AccuracySetting& other) {
      return other.integrator == row.setting.integrator && other.dt == row.setting.dt;
    };
    if (cheapest(rows, work_of, same_mesh, error) != nullptr || cheapest(rows, work_of, same_step, error) != nullptr)
      continue;
    if (out == nullptr || work_of(row) > work_of(*out)) out = &row;
  }
  return out;
}

StudyRun reference_of(const AccuracyProblem& problem, const AccuracySetting& setting, StudyRunner& runner) {
  StudyRun run = runner.run(problem.name, problem.changes(setting));
  if (!run.failure.empty())
    throw std::runtime_error(
        fmt::format("{}: the reference ({}) fails: {}", problem.name, setting.text(), run.failure));
  return run;
}

std::string line_of(const AccuracyStudy& study, const std::string& kind, const AccuracySetting& setting,
                    const StudyRun& run, double error, bool least_work, bool least_seconds) {
  return fmt::format("{},{},{},\"{}\",{},{},{},{},{},{:.6g},{:.6g},{:.6g},{},{},{},{:.6g},{:.6g},{},{},{},\"{}\"\r\n",
                     study.problem.name, kind, setting.element, setting.cells, setting.integrator, setting.dt,
                     setting.tolerance, setting.precision, setting.time_tolerance, error, run.seconds, run.work(),
                     run.steps, run.newton_iterations, run.linear_solves, run.factor_flops, run.hessian_points,
                     run.vertices, least_work, least_seconds, run.failure);
}

}  // namespace

AccuracyStudy run_accuracy(const AccuracyProblem& problem, StudyRunner& runner,
                           const std::function<void(const AccuracyRow&)>& seen) {
  AccuracyStudy study{problem, {}, reference_of(problem, problem.reference, runner), 0};
  study.reference_error = study_error(reference_of(problem, problem.other_reference, runner), study.reference);
  for (const AccuracySetting& setting : problem.settings) {
    StudyRun run = runner.run(problem.name, problem.changes(setting));
    const double error = study_error(run, study.reference);
    study.rows.push_back({setting, std::move(run), error});
    seen(study.rows.back());
  }
  const auto all = [](const AccuracySetting&) { return true; };
  const auto mark = [&](Cost cost, bool AccuracyRow::*flag) {
    for (const AccuracyRow* row : front(study.rows, cost, all))
      study.rows[static_cast<size_t>(row - study.rows.data())].*flag = true;
  };
  mark(work_of, &AccuracyRow::least_work);
  mark(seconds_of, &AccuracyRow::least_seconds);
  return study;
}

double work_of(const AccuracyRow& row) { return row.run.work(); }
double seconds_of(const AccuracyRow& row) { return row.run.seconds; }

std::vector<const AccuracyRow*> front(const std::vector<AccuracyRow>& rows, Cost cost, const Which& which) {
  std::vector<const AccuracyRow*> sorted, out;
  for (const AccuracyRow& row : rows)
    if (row.run.failure.empty() && which(row.setting)) sorted.push_back(&row);
  std::sort(sorted.begin(), sorted.end(), [&](const AccuracyRow* a, const AccuracyRow* b) {
    return cost(*a) != cost(*b) ? cost(*a) < cost(*b) : a->error < b->error;
  });
  for (const AccuracyRow* row : sorted)
    if (out.empty() || row->error < out.back()->error) out.push_back(row);
  return out;
}

const AccuracyRow* cheapest(const std::vector<AccuracyRow>& rows, Cost cost, const Which& which, double error) {
  for (const AccuracyRow* row : front(rows, cost, which))
    if (row->error <= error) return row;
  return nullptr;
}

std::vector<AccuracyVerdict> verdicts(const AccuracyStudy& study) {
  std::vector<AccuracyVerdict> out;
  const auto all = [](const AccuracySetting&) { return true; };
  for (const double error : {0.1, 0.01, 0.001}) {
    AccuracyVerdict verdict{.error = error,
                            .best = cheapest(study.rows, work_of, all, error),
                            .plain = cheapest(study.rows, work_of, is_plain, error),
                            .reached = true};
    if (verdict.plain == nullptr) {
      verdict.reached = false;
      verdict.plain = costliest_short_of(study.rows, error);
    }
    if (verdict.best != nullptr && verdict.plain != nullptr) {
      verdict.time_ratio = seconds_of(*verdict.plain) / seconds_of(*verdict.best);
      verdict.work_ratio = work_of(*verdict.plain) / work_of(*verdict.best);
    }
    verdict.by_default = cheapest(study.rows, work_of, is_default, error);
    if (verdict.by_default != nullptr) {
      verdict.default_time_ratio = seconds_of(*verdict.by_default) / seconds_of(*verdict.best);
      verdict.default_work_ratio = work_of(*verdict.by_default) / work_of(*verdict.best);
    }
    out.push_back(verdict);
  }
  return out;
}

std::string accuracy_table(const std::vector<AccuracyStudy>& studies) {
  std::string out =
      "problem,kind,element,cells,integrator,dt,tolerance,precision,time_tolerance,error,seconds,work,steps,"
      "newton_iterations,linear_solves,factor_flops,hessian_points,vertices,least_work,least_seconds,failure\r\n";
  for (const AccuracyStudy& study : studies) {
    out += line_of(study, "reference", study.problem.reference, study.reference, study.reference_error, false, false);
    for (const AccuracyRow& row : study.rows)
      out += line_of(study, "run", row.setting, row.run, row.error, row.least_work, row.least_seconds);
  }
  return out;
}

}  // namespace ergon
