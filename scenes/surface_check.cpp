#include "scenes/surface_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

namespace ergon {
namespace {

constexpr size_t most_listed = 5;

size_t body_of(const BuiltScene& built, int vertex) {
  size_t b = built.bodies.size() - 1;
  while (built.bodies[b].first_vertex > vertex) --b;
  return b;
}

int own_number(const Body& body, int vertex) {
  return body.vertex_from[static_cast<size_t>(vertex - body.first_vertex)];
}

// "edge 3-4 of 'cloth'"
std::string part_text(const BuiltScene& built, const char* kind, const int* vertices, int count) {
  const Body& body = built.bodies[body_of(built, vertices[0])];
  std::string numbers;
  for (int i = 0; i < count; ++i) numbers += fmt::format("{}{}", i == 0 ? "" : "-", own_number(body, vertices[i]));
  return fmt::format("{} {} of '{}'", kind, numbers, body.name);
}

std::string place_text(const Eigen::Matrix3Xd& x, int vertex) {
  return fmt::format("near [{:.4g}, {:.4g}, {:.4g}] m", x(0, vertex), x(1, vertex), x(2, vertex));
}

// Two parts of a stencil of points: one point or edge against what is left.
std::string close_text(const BuiltScene& built, const std::vector<int>& stencil) {
  std::string parts;
  for (size_t i = 0; i < stencil.size(); ++i) {
    parts += (i == 0 ? "" : i + 1 == stencil.size() ? " and " : ", ") + vertex_text(built, stencil[i]);
  }
  return parts;
}

// What to do where the two bodies of the first fault are joined: "".
std::string joined_text(const Scene& scene, const BuiltScene& built, const SurfaceFaults& faults) {
  const int a = faults.crossing.empty() ? faults.close.front().front() : faults.crossing.front().edge[0];
  const int b = faults.crossing.empty() ? faults.close.front().back() : faults.crossing.front().triangle[0];
  const std::string &first = built.bodies[body_of(built, a)].name, &second = built.bodies[body_of(built, b)].name;
  for (const SceneAttachment& joined : scene.attachments)
    if ((joined.object == first && joined.to == second) || (joined.object == second && joined.to == first))
      return fmt::format(
          "; what is joined may touch by [[contact.pair]] first = \"{}\", second = \"{}\", ignore = true",
          joined.object, joined.to);
  return "";
}

}  // namespace

std::string vertex_text(const BuiltScene& built, int vertex) {
  for (const Body& body : built.bodies)
    if (body.affine() && vertex >= body.first_control && vertex < body.first_control + 4)
      return fmt::format("the affine map of '{}'", body.name);
  const Body& body = built.bodies[body_of(built, vertex)];
  return fmt::format("vertex {} of '{}'", own_number(body, vertex), body.name);
}

SurfaceFaults find_surface_faults(const BuiltScene& built, const Eigen::Matrix3Xd& x) {
  SurfaceFaults faults;
  faults.crossing = built.surfaces->crossing(x);
  faults.close = built.surfaces->touching(x);
  return faults;
}

std::string to_text(const SurfaceFaults& faults, const BuiltScene& built, const Eigen::Matrix3Xd& x) {
  std::vector<std::string> lines;
  for (const auto& [edge, triangle] : faults.crossing) {
    if (lines.size() == most_listed) break;
    lines.push_back(fmt::format("{} crosses {} {}", part_text(built, "edge", edge.data(), 2),
                                part_text(built, "triangle", triangle.data(), 3), place_text(x, edge[0])));
  }
  for (const std::vector<int>& stencil : faults.close) {
    if (lines.size() == most_listed) break;
    lines.push_back(
        fmt::format("{} are closer than their offsets {}", close_text(built, stencil), place_text(x, stencil[0])));
  }
  const size_t all = faults.crossing.size() + faults.close.size();
  std::string text = fmt::format("{}", fmt::join(lines, "; "));
  if (all > lines.size()) text += fmt::format("; and {} more", all - lines.size());
  return text;
}

Frame frame_of(const SurfaceFaults& faults, const BuiltScene& built, const Eigen::Matrix3Xd& x) {
  std::set<std::array<int, 2>> edges;
  std::set<std::array<int, 3>> triangles;
  for (const auto& [edge, triangle] : faults.crossing) {
    edges.insert(edge);
    triangles.insert(triangle);
  }
  std::map<int, int> place;  // of a vertex in the frame
  const auto point = [&](int v) { return place.emplace(v, static_cast<int>(place.size())).first->second; };
  CellBlock lines{Element::edge2, {}}, faces{Element::tri3, {}}, points{Element::point, {}};
  std::vector<double> object;
  const auto add = [&](CellBlock& block, const auto& vertices) {
    for (const int v : vertices) block.nodes.push_back(point(v));
    object.push_back(static_cast<double>(body_of(built, vertices[0])));
  };
  for (const auto& edge : edges) add(lines, edge);
  for (const auto& triangle : triangles) add(faces, triangle);
  for (const std::vector<int>& stencil : faults.close)
    for (const int v : stencil) add(points, std::array<int, 1>{v});
  Frame frame;
  frame.x.resize(3, static_cast<int>(place.size()));
  for (const auto& [v, column] : place) frame.x.col(column) = x.col(v);
  for (CellBlock* block : {&lines, &faces, &points})
    if (!block->nodes.empty()) frame.cells.push_back(std::move(*block));
  frame.cell_data.push_back(
      {"object", Eigen::Map<const Eigen::RowVectorXd>(object.data(), static_cast<Eigen::Index>(object.size()))});
  return frame;
}

void check_surface_start(const Scene& scene, const BuiltScene& built, const FaultReport& report) {
  const Eigen::Matrix3Xd& x = built.start.x;
  const SurfaceFaults faults = find_surface_faults(built, x);
  if (faults.none()) return;
  if (report) report(frame_of(faults, built, x));
  const int vertex = faults.crossing.empty() ? faults.close.front().front() : faults.crossing.front().edge[0];
  const size_t body = body_of(built, vertex);
  const SceneShape& shape = body < scene.objects.size()
                                ? static_cast<const SceneShape&>(scene.objects[body])
                                : static_cast<const SceneShape&>(scene.obstacles[body - scene.objects.size()]);
  throw SourceError(shape.at("translate"),
                    fmt::format("surfaces collide at the start: {}; move them apart with 'translate', or look at them: "
                                "ergon run SCENE --report-intersections FILE.vtu{}",
                                to_text(faults, built, x), joined_text(scene, built, faults)));
}

}  // namespace ergon
