#include "tools/scene_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <ostream>

#include "runtime/lanes/lanes.h"
#include "runtime/output/progress.h"
#include "scenes/scene_reader.h"
#include "scenes/scene_text.h"
#include "tools/choices.h"
#include "tools/installation.h"
#include "tools/interrupt.h"

namespace ergon {
namespace {

std::string start_line(const Scene& scene, const BuiltScene& built) {
  int cells = 0;
  for (const Body& body : built.bodies) cells += body.mesh.cell_count();
  return fmt::format("{}: {} vertices, {} cells, {} steps of {:g} s; ready in {:.2f} s\n", scene.file,
                     built.system->vertices(), cells, built.steps, built.step.dt, built.seconds.total());
}

}  // namespace

std::string folder_of(const SceneRun& options, const Scene& scene) {
  if (!options.write) return "";
  return options.folder.empty() ? output_folder(scene) : options.folder;
}

Scene changed_scene(const SceneRun& options) {
  if (options.changes.empty()) return read_scene(options.file);
  SceneText text(options.file);
  const Place place{"--set", 0, 0};
  for (const std::string& change : options.changes) {
    const auto [path, value] = read_change(change, place);
    text.set(path, *value.get("value"), place);
  }
  return text.read();
}

RunSummary run_scene_file(const SceneRun& options) {
  const Scene scene = changed_scene(options);
  RunOptions run;
  run.folder = folder_of(options, scene);
  if (!run.folder.empty()) prepare_output(run.folder);
  const Catalogue catalogue(Catalogue::default_folders());
  BuiltScene built = build_scene(
      scene, catalogue,
      [&](const std::vector<KernelRequest>& requests) {
        return load_kernels(requests, lanes::best_lanes(), precision_named(scene.solver.precision));
      },
      [&](const Frame& faults) {
        if (!options.intersections.empty()) write_vtu(options.intersections, faults);
      });
  const InterruptGuard guard;
  run.stop = was_interrupted;
  run.verify = options.verify;
  if (options.progress == nullptr) return run_scene(scene, built, run);

  for (const std::string& warning : built.warnings) *options.progress << "warning  " << warning << '\n';
  *options.progress << start_line(scene, built) << std::flush;
  Progress progress(*options.progress, isatty(STDOUT_FILENO) != 0, static_cast<int>(built.steps));
  run.progress = [&progress, &built](const StepRecord& record, long) {
    progress.update(static_cast<int>(std::lround(record.time / built.step.dt)), record.time,
                    fmt::format("{} Newton{}", record.newton_iterations,
                                record.contacts == 0 ? "" : fmt::format(", {} contacts", record.contacts)));
  };
  const RunSummary summary = run_scene(scene, built, run);
  progress.finish();
  return summary;
}

std::string to_text(const RunSummary& summary) {
  std::string text = fmt::format("{} steps to {:g} s, {} Newton iterations, {} linear solves, {:.1f} MB\n",
                                 summary.steps, summary.time, summary.newton_iterations, summary.linear_solves,
                                 static_cast<double>(summary.peak_memory) / 1e6);
  text += "seconds:";
  for (const auto& [part, seconds] : seconds_by_part(summary)) text += fmt::format("  {} {:.3f}", part, seconds);
  text += '\n';
  for (const auto& [part, steps] : summary.skipped)
    text +=
        fmt::format("skipped  {}{}\n", part, steps == 0 ? "" : fmt::format(" ({} of {} steps)", steps, summary.steps));
  return text;
}

}  // namespace ergon
