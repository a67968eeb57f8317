#pragma once
// A sweep over scenes: from SWEEP.toml to the list of its jobs, each a whole scene of its own. It establishes, before
// anything runs, that every job's scene can be read and that every measure exists.

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace ergon {

struct BatchJob {
  std::string name;                                         // "0007"; the name of its folder
  std::vector<std::pair<std::string, std::string>> values;  // key of the scene and value as text, in order of the file
  std::string scene;                                        // its text; files are named ../inputs/NAME
  std::string fingerprint;                                  // of the scene and of all files that it names
};

struct BatchPlan {
  std::string folder;   // of all results
  int at_once = 0;      // jobs; 0: as many as cores and memory hold
  int threads = 1;      // of each job
  bool verify = false;  // every step of each job is tested for intersections, as `ergon run --verify` does
  std::vector<std::string> measures;  // paths into summary.json, as "seconds.total" and "probes.tip.z"
  std::vector<std::string> keys;      // that are swept, in the order of the file
  std::vector<std::pair<std::string, std::string>> inputs;  // files that scenes name, and their names in inputs/
  std::vector<BatchJob> jobs;
};

// SWEEP.toml: `scene` (relative to the file; with a * in its name all files that match, each a value of the key
// `scene`), `folder` (default out/NAME), `jobs`, `threads`, `verify`, `measures`; [grid]: for keys of the scene
// (scenes/scene_text.h says how they are written, in quotes) arrays of values, of which every combination is run;
// [[list]]: tables of values, each of which is run with every combination of the grid. Throws SourceError at the first
// thing that is not right, in the sweep or in the scene of a job.
BatchPlan read_batch(const std::string& file);

}  // namespace ergon
