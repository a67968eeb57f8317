#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tools/batch_run.h"

namespace ergon {
namespace fs = std::filesystem;
namespace {

std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + "\"";
}

nlohmann::json summary_of(const fs::path& folder) {
  std::ifstream in(folder / "summary.json");
  return in ? nlohmann::json::parse(in, nullptr, false) : nlohmann::json();
}

std::string read_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

std::string measure_of(const nlohmann::json& summary, const std::string& measure) {
  const nlohmann::json* at = &summary;
  for (size_t from = 0; from <= measure.size();) {
    const size_t dot = std::min(measure.find('.', from), measure.size());
    const auto found = at->find(measure.substr(from, dot - from));
    if (!at->is_object() || found == at->end() || found->is_null()) return "";
    at = &*found;
    from = dot + 1;
  }
  return at->dump();
}

const char* word_of(JobState state) {
  switch (state) {
    case JobState::done:
      return "done";
    case JobState::failed:
      return "failed";
    case JobState::running:
      return "running";
    default:
      return "open";
  }
}

}  // namespace

JobOutcome outcome_of(const BatchPlan& plan, const BatchJob& job) {
  const fs::path folder = fs::path(plan.folder) / job.name;
  if (read_line(folder / "fingerprint.txt") != job.fingerprint) return {};
  const nlohmann::json summary = summary_of(folder);
  if (!summary.is_object()) return {};
  if (summary.value("finished", false)) return {JobState::done, "", false};
  return {};
}

std::string batch_table(const BatchPlan& plan, const std::vector<JobOutcome>& outcomes) {
  std::string out = "job,state,reason";
  for (const std::string& key : plan.keys) out += "," + field(key);
  for (const std::string& measure : plan.measures) out += "," + field(measure);
  out += "\r\n";
  for (size_t i = 0; i < plan.jobs.size(); ++i) {
    const BatchJob& job = plan.jobs[i];
    out += job.name + "," + word_of(outcomes[i].state) + "," + field(outcomes[i].reason);
    for (const std::string& key : plan.keys) {
      std::string text;
      for (const auto& [name, value] : job.values)
        if (name == key) text = value;
      out += "," + field(text);
    }
    const nlohmann::json summary =
        outcomes[i].state == JobState::done ? summary_of(fs::path(plan.folder) / job.name) : nlohmann::json();
    for (const std::string& measure : plan.measures) out += "," + field(measure_of(summary, measure));
    out += "\r\n";
  }
  return out;
}

}  // namespace ergon
