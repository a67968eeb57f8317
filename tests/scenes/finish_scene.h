#pragma once
// Runs a scene, every step of it tested exactly for intersections.

#include <algorithm>
#include <string>
#include <utility>

#include "scenes/run.h"
#include "tests/paths.h"
#include "tests/scenes/real_kernels.h"

namespace ergon {

struct FinishedScene {
  BuiltScene built;
  RunSummary summary;
  State end;
};

inline Scene shipped_scene(const std::string& name) { return read_scene(test::source("/scenes/") + name); }

// `steps`: 0 for all.
inline FinishedScene finish(const Scene& scene, BuiltScene built, long steps = 0) {
  FinishedScene out{std::move(built), {}, {}};
  if (steps > 0) out.built.steps = std::min(steps, out.built.steps);
  RunOptions options;
  options.last_state = &out.end;
  options.verify = true;
  out.summary = run_scene(scene, out.built, options);
  return out;
}

inline FinishedScene finish(const Scene& scene, long steps = 0) {
  return finish(scene, build_scene(scene, shipped_energies(), real_kernels), steps);
}

inline FinishedScene finish_text(const std::string& text) { return finish(read_scene_text(text, "a.toml")); }

// dt: 0 for that of the scene.
inline FinishedScene finish(const std::string& name, long steps = 0, double dt = 0) {
  Scene scene = shipped_scene(name);
  if (dt > 0) scene.time.dt = dt;
  return finish(scene, steps);
}

inline double mean(const FinishedScene& scene, const Eigen::Matrix3Xd& x, size_t body, int axis) {
  const Body& b = scene.built.bodies[body];
  return x.row(axis).segment(b.first_vertex, b.ordered.vertices()).mean();
}

}  // namespace ergon
