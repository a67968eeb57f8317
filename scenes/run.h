#pragma once
// Runs a scene that was built: steps, frames, report, summary. It establishes that the output folder can be written
// before computing starts, and that a run that ends early leaves whole files with the last good state among them.

#include <functional>
#include <string>

#include "scenes/builder.h"
#include "scenes/scene.h"
#include "scenes/summary.h"

namespace ergon {

struct RunOptions {
  std::string folder;  // "": nothing is written
  // Called after each step with its record and the number of steps of the whole run.
  std::function<void(const StepRecord& record, long steps)> progress;
  // Given the first state, and the one after each step that was accepted.
  std::function<void(const State& state)> observe;
  // Asked before each step; true ends the run there.
  std::function<bool()> stop;
  State* last_state = nullptr;  // receives the last good state
  bool verify = false;          // test all surfaces for intersections after every step, in exact arithmetic
};

// The folder of the scene's output unless another is asked for: as the scene says, or out/ and the name of its file.
std::string output_folder(const Scene& scene);

// Makes the folder. Throws OutputError when it cannot be made or nothing can be written into it.
void prepare_output(const std::string& folder);

// Writes into the folder: NAME.pvd and NAME_frames/ (unless the scene wants no frames), report.jsonl with one line per
// step, summary.json. A step that fails ends the run: the summary's `failure` says which step and why, and the last
// good state is written as a frame; likewise a step after which surfaces intersect, with `verify`. Throws OutputError
// when a file cannot be written.
RunSummary run_scene(const Scene& scene, BuiltScene& built, const RunOptions& options);

}  // namespace ergon
