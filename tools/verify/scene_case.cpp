#include "tools/verify/scene_case.h"

#include <stdexcept>

#include "runtime/lanes/lanes.h"
#include "scenes/scene_reader.h"
#include "tools/installation.h"

namespace ergon {

Eigen::Vector3d SceneCase::displacement() const {
  const Eigen::VectorXd mass = built.mass_shares();
  return (end.x - built.start.x) * mass / mass.sum();
}

Eigen::Vector3d SceneCase::velocity() const {
  const Eigen::VectorXd mass = built.mass_shares();
  return end.v * mass / mass.sum();
}

SceneCase run_scene_case(const std::string& name, const std::string& text, const SceneCaseOptions& options) {
  const Scene scene = read_scene_text(text, name);
  SceneCase out{build_scene(scene, Catalogue(Catalogue::default_folders()),
                            [](const std::vector<KernelRequest>& requests) {
                              return load_kernels(requests, lanes::best_lanes());
                            }),
                {},
                {}};
  if (options.start) options.start(out.built);
  RunOptions run;
  run.last_state = &out.end;
  out.summary = run_scene(scene, out.built, run);
  if (!options.may_stop && !out.summary.failure.empty()) throw std::runtime_error(name + ": " + out.summary.failure);
  return out;
}

}  // namespace ergon
