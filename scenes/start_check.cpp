#include "scenes/start_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ergon {
namespace {

void check_body(const SceneObject& object, const Body& body, const SceneGround& ground) {
  const Eigen::Vector3d normal = Eigen::Vector3d(ground.normal[0], ground.normal[1], ground.normal[2]).normalized();
  int deepest = -1;
  double gap = 0;
  for (int vertex : body.surface) {
    if (std::binary_search(body.fixed.begin(), body.fixed.end(), vertex)) continue;
    const double here = normal.dot(body.ordered.X.col(vertex)) - ground.height;
    if (here > 0 || (deepest >= 0 && here >= gap)) continue;
    deepest = vertex;
    gap = here;
  }
  if (deepest < 0) return;
  const Eigen::Vector3d x = body.ordered.X.col(deepest);
  const Eigen::Vector3d move = (-gap + ground.dhat) * normal;
  throw SourceError(
      object.at("translate"),
      fmt::format(
          "object '{}' starts {} the ground of line {}: its vertex {} at [{:.4g}, {:.4g}, {:.4g}] m is {:.4g} m "
          "deep; 'translate' the object by [{:.4g}, {:.4g}, {:.4g}] m or more",
          object.name, gap < 0 ? "below" : "on", ground.place.line, body.vertex_from[static_cast<size_t>(deepest)],
          x[0], x[1], x[2], std::abs(gap), move[0], move[1], move[2]));
}

}  // namespace

void check_start(const Scene& scene, const std::vector<Body>& bodies) {
  for (const SceneGround& ground : scene.grounds)
    for (size_t i = 0; i < scene.objects.size(); ++i) check_body(scene.objects[i], bodies[i], ground);
}

}  // namespace ergon
