#pragma once
// Cases that are scenes: the text of a scene file, run to its end without writing anything.

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

// Throws SourceError for what is wrong with the scene, and std::runtime_error where a step fails.
SceneCase run_scene_case(const std::string& name, const std::string& text);

}  // namespace ergon
