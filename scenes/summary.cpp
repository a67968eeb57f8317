#include "scenes/summary.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace ergon {

std::pair<std::string, std::string> part_and_reason(const std::string& skipped) {
  const size_t colon = skipped.find(": ");
  return {skipped.substr(0, colon), colon == std::string::npos ? "" : skipped.substr(colon + 2)};
}

void add_step(RunSummary& summary, const StepRecord& record) {
  if (record.accepted) {
    summary.steps = record.step;
    summary.time = record.time;
    if (!record.converged) ++summary.unconverged_steps;
    summary.max_energy_rise =
        std::max(summary.max_energy_rise, record.energy.total - record.energy_added - summary.end_energy);
    summary.end_energy = record.energy.total;
    summary.smallest_gap = std::min(summary.smallest_gap, record.smallest_gap);
  }
  summary.newton_iterations += record.newton_iterations;
  summary.linear_solves += record.factorisations - record.shifts;
  summary.factor_flops += record.factor_flops;
  summary.halvings += record.halvings;
  summary.refused += record.refused;
  summary.most_contacts = std::max(summary.most_contacts, record.contacts);
  StepSeconds& sum = summary.step_seconds;
  sum.evaluate += record.seconds.evaluate;
  sum.factor += record.seconds.factor;
  sum.solve += record.seconds.solve;
  sum.line_search += record.seconds.line_search;
  sum.contact += record.seconds.contact;
  sum.total += record.seconds.total;
  for (const std::string& part : record.skipped) {
    auto same =
        std::find_if(summary.skipped.begin(), summary.skipped.end(), [&](const auto& s) { return s.first == part; });
    if (same == summary.skipped.end()) same = summary.skipped.insert(same, {part, 0});
    ++same->second;
  }
}

std::vector<std::pair<std::string, double>> seconds_by_part(const StepSeconds& s) {
  const double parts = s.evaluate + s.factor + s.solve + s.line_search + s.contact;
  return {{"evaluate", s.evaluate}, {"factor", s.factor},       {"solve", s.solve}, {"line_search", s.line_search},
          {"contact", s.contact},   {"other", s.total - parts}, {"total", s.total}};
}

std::vector<std::pair<std::string, double>> seconds_by_part(const RunSummary& summary) {
  std::vector<std::pair<std::string, double>> out = {{"read_energies", summary.build.energies},
                                                     {"mesh", summary.build.meshes},
                                                     {"kernels", summary.build.kernels},
                                                     {"setup", summary.build.setup}};
  for (const auto& [part, seconds] : seconds_by_part(summary.step_seconds))
    if (part != "total") out.emplace_back(part, seconds);
  out.emplace_back("output", summary.output_seconds);
  out.emplace_back("total", summary.total_seconds());
  return out;
}

std::string to_json(const RunSummary& s) {
  nlohmann::ordered_json json;
  json["scene"] = s.scene;
  json["finished"] = s.failure.empty() && !s.stopped;
  json["failure"] = s.failure.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(s.failure);
  json["integrator"] = s.integrator;
  json["threads"] = s.threads;
  json["vertices"] = s.vertices;
  json["cells"] = s.cells;
  json["steps"] = s.steps;
  json["time"] = s.time;
  json["unconverged_steps"] = s.unconverged_steps;
  json["newton_iterations"] = s.newton_iterations;
  json["linear_solves"] = s.linear_solves;
  json["factor_flops"] = s.factor_flops;
  json["linear_iterations"] = 0;  // no iterative linear solver was used
  json["halvings"] = s.halvings;
  json["refused"] = s.refused;
  json["most_contacts"] = s.most_contacts;
  json["smallest_gap"] = s.smallest_gap;
  json["max_energy_rise"] = s.max_energy_rise;
  json["start_energy"] = s.start_energy;
  json["end_energy"] = s.end_energy;
  json["largest_speed"] = s.largest_speed;
  json["probes"] = nlohmann::ordered_json::object();
  for (const auto& [name, x] : s.probes) json["probes"][name] = {{"x", x[0]}, {"y", x[1]}, {"z", x[2]}};
  json["frames"] = s.frames;
  json["peak_memory"] = s.peak_memory;
  for (const auto& [part, seconds] : seconds_by_part(s)) json["seconds"][part] = seconds;
  json["skipped"] = nlohmann::ordered_json::array();
  for (const auto& [text, steps] : s.skipped) {
    auto [part, reason] = part_and_reason(text);
    json["skipped"].push_back({{"part", part}, {"reason", reason}, {"steps", steps}});
  }
  json["warnings"] = s.warnings;
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace ergon
