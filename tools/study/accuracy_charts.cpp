#include <fmt/format.h>

#include <algorithm>

#include "tools/study/accuracy.h"
#include "tools/svg.h"

namespace ergon {
namespace {

constexpr double percent = 100;
constexpr double worst_shown = 1;  // error: a motion that is all wrong says no more

ChartLine line_of(const std::string& label, const std::vector<const AccuracyRow*>& rows, Cost cost, double unit) {
  ChartLine line;
  line.label = label;
  for (const AccuracyRow* row : rows) {
    if (row->error > worst_shown) continue;
    line.x.push_back(percent * row->error);
    line.y.push_back(cost(*row) / unit);
  }
  return line;
}

// A line for each value that a key of the settings has: the front of its runs; and the front of all, marked.
Chart chart_of(const AccuracyStudy& study, const std::string& title, std::string AccuracySetting::*key, Cost cost,
               double unit, const std::string& label) {
  Chart chart{title, "error (percent)", label, {}, true, true};
  chart.legend_right = true;
  std::vector<std::string> values;
  for (const AccuracyRow& row : study.rows) {
    const std::string& value = row.setting.*key;
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
  }
  for (const std::string& value : values) {
    const auto has = [&](const AccuracySetting& setting) { return setting.*key == value; };
    chart.lines.push_back(line_of(value, front(study.rows, cost, has), cost, unit));
  }
  const auto all = [](const AccuracySetting&) { return true; };
  chart.lines.push_back(line_of("Pareto front", front(study.rows, cost, all), cost, unit));
  chart.lines.back().marks = true;
  chart.lines.back().color = 6;
  return chart;
}

}  // namespace

std::string accuracy_charts(const AccuracyStudy& study) {
  constexpr double giga = 1e9;
  return svg_of({chart_of(study, "by element", &AccuracySetting::element, seconds_of, 1, "processor time (s)"),
                 chart_of(study, "by integrator", &AccuracySetting::integrator, seconds_of, 1, "processor time (s)"),
                 chart_of(study, "by element, work", &AccuracySetting::element, work_of, giga, "work (Gflop)")},
                fmt::format("{}: {}; the reference is trusted to {:.2g} percent", study.problem.name,
                            study.problem.summary, percent * study.reference_error));
}

}  // namespace ergon
