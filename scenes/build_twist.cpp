#include "scenes/build_twist.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/error.h"
#include "runtime/mesh/mesh_tools.h"
#include "runtime/mesh/rod_frames.h"

namespace ergon {
namespace {

// Twists of the cells of `ordered` both of whose vertices are in the list, by cell.
std::vector<int> cells_within(const Mesh& mesh, const std::vector<int>& vertices) {
  std::vector<char> in(static_cast<size_t>(mesh.vertices()), 0);
  for (const int v : vertices) in[static_cast<size_t>(v)] = 1;
  std::vector<int> out;
  for (int cell = 0; cell < mesh.cell_count(); ++cell) {
    const auto at = 2 * static_cast<size_t>(cell);
    if (in[static_cast<size_t>(mesh.cells[at])] != 0 && in[static_cast<size_t>(mesh.cells[at + 1])] != 0)
      out.push_back(cell);
  }
  return out;
}

bool asks_for_twist(const std::vector<UsedLaw>& laws) {
  return std::any_of(laws.begin(), laws.end(),
                     [](const UsedLaw& law) { return twists_of_stencil(law.declared->geometry) > 0; });
}

}  // namespace

void set_twist(const SceneObject& object, const std::vector<UsedLaw>& laws, Body& body) {
  if (!asks_for_twist(laws)) {
    for (const char* key : {"axis", "gyration"})
      if (object.wrote(key))
        throw SourceError(object.at(key),
                          fmt::format("'{}' has no use here: no law of object '{}' knows of twist, as those over a "
                                      "rod_corner do",
                                      key, object.name));
    return;
  }
  try {
    std::optional<Eigen::Vector3d> axis;
    if (object.wrote("axis")) axis = Eigen::Map<const Eigen::Vector3d>(object.axis.data());
    const std::vector<Eigen::Vector3d> axes = cross_section_axes(body.mesh, axis);
    for (const int cell : body.cell_from) body.axes.push_back(axes[static_cast<size_t>(cell)]);
  } catch (const InputError& bad) {
    throw SourceError(object.wrote("axis") ? object.at("axis") : object.place,
                      fmt::format("object '{}': {}", object.name, bad.what()));
  }
  body.gyration = object.gyration.value_or(std::sqrt(body.section / (2 * std::numbers::pi)));
}

void start_twist(const SceneObject& object, const Body& body, BuiltScene& out, std::vector<char>& fixed,
                 std::vector<Guide>& guides) {
  if (!body.twists()) return;
  const std::vector<double> lengths = rest_volumes(body.ordered);
  for (int cell = 0; cell < body.ordered.cell_count(); ++cell) {
    const int vertex = body.first_twist + cell;
    out.start.x.col(vertex).setZero();
    out.mass[vertex] = object.density * body.section * lengths[static_cast<size_t>(cell)];
    guides.push_back({vertex, Eigen::Vector3d::UnitX().asDiagonal()});
  }
  for (const int cell : cells_within(body.ordered, body.fixed)) fixed[static_cast<size_t>(body.first_twist + cell)] = 1;
}

void follow_twist(const BodyScript& script, const Body& body, BuiltScene& out, std::vector<char>& fixed) {
  if (!body.twists()) return;
  for (const int cell : cells_within(body.ordered, script.vertices)) {
    const auto at = 2 * static_cast<size_t>(cell);
    const Eigen::Vector3d edge =
        body.ordered.X.col(body.ordered.cells[at + 1]) - body.ordered.X.col(body.ordered.cells[at]);
    out.script.turn(body.first_twist + cell, body.gyration * edge.normalized());
    fixed[static_cast<size_t>(body.first_twist + cell)] = 1;
  }
}

}  // namespace ergon
