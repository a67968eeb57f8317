#pragma once
// What `ergon run` and `ergon bench scene` share: from a scene file to the summary of its run.

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "scenes/run.h"

namespace ergon {

struct SceneRun {
  std::string file;
  std::vector<std::string> changes;  // "PATH=VALUE", as SceneText::set
  std::string folder;                // ""; as the scene says
  bool write = true;                 // false: no frames, no report
  std::ostream* progress = nullptr;  // null: none
  bool verify = false;               // RunOptions::verify
  std::string intersections;         // file (.vtu) for a mesh of what intersects at the start; "": none
};

// The scene with its changes. Throws SourceError.
Scene changed_scene(const SceneRun& options);

// Throws SourceError, InputError and OutputError. Ends early, with `stopped` in the summary, when the process is
// interrupted (SIGINT, SIGTERM).
RunSummary run_scene_file(const SceneRun& options);

// The folder that results go to.
std::string folder_of(const SceneRun& options, const Scene& scene);

// Lines that tell a person what a run did and where its time went.
std::string to_text(const RunSummary& summary);

}  // namespace ergon
