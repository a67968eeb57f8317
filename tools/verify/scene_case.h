#pragma once
// Cases that are scenes: the text of a scene file, run to its end without writing anything.

#include <functional>
#include <string>

#include "scenes/run.h"

namespace ergon {

struct SceneCase {
  BuiltScene built;
  RunSummary summary;
  State end;

  // Of all bodies together, weighted by mass: displacement from the start (m) and velocity (m/s).
  Eigen::Vector3d displacement() const;
  Eigen::Vector3d velocity() const;
};

struct SceneCaseOptions {
  bool may_stop = false;                        // a step may fail, as past a branching point; summary.failure tells
  std::function<void(BuiltScene&)> start = {};  // changes the first state
};

// Throws SourceError for what is wrong with the scene, and std::runtime_error where a step fails.
SceneCase run_scene_case(const std::string& name, const std::string& text, const SceneCaseOptions& options = {});

}  // namespace ergon
