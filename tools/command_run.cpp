// ergon run SCENE: simulates a scene.

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <ostream>
#include <stdexcept>

#include "tools/choices.h"
#include "tools/command.h"
#include "tools/scene_run.h"

namespace ergon {
namespace {

int run_it(SceneRun options, bool quiet, std::ostream& out) {
  if (!quiet) options.progress = &out;
  const RunSummary summary = run_scene_file(options);
  const std::string folder = folder_of(options, changed_scene(options));
  if (!quiet) out << to_text(summary);
  out << fmt::format("output: {}\n", folder) << std::flush;
  if (!summary.failure.empty()) throw std::runtime_error(fmt::format("{}: {}", options.file, summary.failure));
  if (summary.stopped) throw std::runtime_error(fmt::format("interrupted after step {}", summary.steps));
  return exit_done;
}

}  // namespace

void add_run_command(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("run", "Simulates a scene; writes frames and a report");
  auto options = std::make_shared<SceneRun>();
  auto quiet = std::make_shared<bool>(false);
  auto threads = std::make_shared<std::optional<int>>();
  command->add_option("scene", options->file, "a scene file (.toml)")->required();
  command->add_option("--out", options->folder, "folder for the results; default: as the scene says, or out/NAME");
  command->add_option(
      "--set", options->changes,
      "PATH=VALUE in place of what the scene says, as time.dt=0.005 or object.beam.energy.0.E=\"2 MPa\"; "
      "may be given several times");
  command->add_option("--threads", *threads, "threads to use; default: all cores");
  command->add_flag("--verify", options->verify,
                    "test all surfaces for intersections after every step, in exact arithmetic; one ends the run");
  command->add_option("--report-intersections", options->intersections,
                      "file (.vtu) for a mesh of the surfaces that intersect at the start, if any do");
  command->add_flag("--quiet", *quiet, "no progress and no summary");
  command->callback([options, quiet, threads, &run] {
    run = [options, quiet, threads](std::ostream& out) {
      if (threads->has_value()) set_threads(**threads);
      return run_it(*options, *quiet, out);
    };
  });
}

}  // namespace ergon
