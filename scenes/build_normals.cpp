#include "scenes/build_normals.h"

#include <algorithm>

#include "runtime/mesh/edge_normals.h"
#include "runtime/mesh/mesh_stencils.h"

namespace ergon {
namespace {

constexpr double most_mass =
    1e-3;  // of an edge's: turning is to weigh little beside moving, also where cells are small

}  // namespace

void set_normals(const std::vector<UsedLaw>& laws, Body& body) {
  if (std::any_of(laws.begin(), laws.end(),
                  [](const UsedLaw& law) { return law.declared->geometry == "shell_triangle"; }))
    body.tips = static_cast<int>(stencils_on_mesh("edge", body.ordered).size()) / 2;
}

void start_normals(const SceneObject& object, const Body& body, BuiltScene& out, std::vector<char>& fixed) {
  if (body.tips == 0) return;
  out.start.x.middleCols(body.first_tip(), body.tips) = edge_normal_tips(body.ordered);
  out.start.v.middleCols(body.first_tip(), body.tips).colwise() =
      Eigen::Map<const Eigen::Vector3d>(object.velocity.data());
  const std::vector<int> edges = stencils_on_mesh("edge", body.ordered);
  const Eigen::VectorXd areas = edge_areas(body.ordered);
  for (int edge = 0; edge < body.tips; ++edge) {
    const int a = edges[2 * static_cast<size_t>(edge)], b = edges[2 * static_cast<size_t>(edge) + 1];
    const double slender = body.section * body.section / (body.ordered.X.col(b) - body.ordered.X.col(a)).squaredNorm();
    const double mass = object.density * body.section * areas[edge] * std::min(slender / 12, most_mass);
    out.mass[body.first_tip() + edge] = mass;
  }
  for (const int edge : edges_of_triangles_within(body.ordered, body.fixed)) {
    fixed[static_cast<size_t>(body.first_tip() + edge)] = 1;
    out.start.v.col(body.first_tip() + edge).setZero();
  }
}

std::vector<int> tips_of(const BodyScript& script, const Body& body) {
  if (body.tips == 0) return {};
  std::vector<int> out = edges_of_triangles_within(body.ordered, script.vertices);
  for (int& vertex : out) vertex += body.first_tip();
  return out;
}

}  // namespace ergon
