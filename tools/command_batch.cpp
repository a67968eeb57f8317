// ergon batch SWEEP: runs a scene with many values.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <ostream>
#include <stdexcept>

#include "tools/batch_run.h"
#include "tools/command.h"
#include "tools/interrupt.h"

namespace ergon {
namespace {

int batch_it(const std::string& file, bool again, bool list, std::ostream& out) {
  const BatchPlan plan = read_batch(file);
  if (list) {
    for (const BatchJob& job : plan.jobs) {
      out << job.name;
      for (const auto& [key, value] : job.values) out << fmt::format("  {} = {}", key, value);
      out << '\n';
    }
    return exit_done;
  }
  const InterruptGuard guard;
  BatchOptions options;
  options.program = std::filesystem::read_symlink("/proc/self/exe").string();
  options.again = again;
  options.progress = &out;
  options.stop = was_interrupted;
  const std::vector<JobOutcome> outcomes = run_batch(plan, options);
  for (size_t i = 0; i < outcomes.size(); ++i)
    if (outcomes[i].state == JobState::failed)
      out << fmt::format("failed  {}  {}\n", plan.jobs[i].name, outcomes[i].reason);
  out << fmt::format("table: {}\n", (std::filesystem::path(plan.folder) / "table.csv").string()) << std::flush;
  const auto not_done = [](const JobOutcome& outcome) { return outcome.state != JobState::done; };
  const auto missing = std::count_if(outcomes.begin(), outcomes.end(), not_done);
  if (missing > 0)
    throw std::runtime_error(
        fmt::format("{} of {} jobs are not done; the same command again does them", missing, outcomes.size()));
  return exit_done;
}

}  // namespace

void add_batch_command(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("batch", "Runs a scene with many values; gathers a table of results");
  auto file = std::make_shared<std::string>();
  auto again = std::make_shared<bool>(false);
  auto list = std::make_shared<bool>(false);
  command->add_option("sweep", *file, "a sweep file (.toml)")->required();
  command->add_flag("--again", *again, "run jobs that are done too");
  command->add_flag("--list", *list, "list the jobs and run none");
  command->callback([=, &run] { run = [=](std::ostream& out) { return batch_it(*file, *again, *list, out); }; });
}

}  // namespace ergon
