#include "scenes/body.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>

#include "runtime/error.h"
#include "runtime/mesh/mesh_build.h"
#include "runtime/mesh/mesh_import.h"
#include "runtime/mesh/mesh_tools.h"

namespace ergon {
namespace {

// Cells that one object may have: well beyond what is solved in practice, and below what overflows an index.
constexpr double most_cells = 5e7;

Eigen::Vector3d vector(const Vector3& v) { return {v[0], v[1], v[2]}; }

std::string brackets(const Eigen::Vector3d& v) { return fmt::format("[{:.4g}, {:.4g}, {:.4g}]", v[0], v[1], v[2]); }

Transform placing(const SceneObject& object) {
  auto about = [&](size_t axis) {
    return Eigen::AngleAxisd(object.rotate[axis], Eigen::Vector3d::Unit(static_cast<int>(axis)));
  };
  const Eigen::AngleAxisd rotation(about(2) * about(1) * about(0));
  return {object.scale, rotation.axis(), rotation.angle(), vector(object.translate)};
}

Mesh box_mesh(const SceneObject& object) {
  const BoxSource& box = *object.box;
  const double tets = object.element == "hex8" ? 1 : 6;
  const double cells = tets * box.cells[0] * box.cells[1] * box.cells[2];
  if (cells > most_cells)
    throw SourceError(box.at("cells"),
                      fmt::format("this makes {:.3g} cells; at most {:.3g} fit into one object", cells, most_cells));
  return object.element == "hex8" ? box_hexes(vector(box.size), box.cells) : box_tets(vector(box.size), box.cells);
}

Mesh filled_mesh(const SceneObject& object, const std::string& path) {
  const Mesh surface = transformed(read_surface(path), placing(object));
  const auto bounds = bounding_box(surface);
  const double volume = (bounds.col(1) - bounds.col(0)).prod();
  // A regular tetrahedron of edge a has the volume a^3/8.49.
  if (object.max_edge > 0 && 8.49 * volume / std::pow(object.max_edge, 3) > most_cells)
    throw SourceError(object.at("max_edge"),
                      fmt::format("the box around this mesh would take {:.3g} tetrahedra with edges of {} m; at most "
                                  "{:.3g} fit into one object",
                                  8.49 * volume / std::pow(object.max_edge, 3), object.max_edge, most_cells));
  FillOptions fill;
  fill.max_edge_length = object.max_edge;
  return fill_surface(surface, fill);
}

Mesh file_mesh(const SceneObject& object, const std::string& path) {
  Mesh mesh = transformed(read_mesh(path), placing(object));
  if (dimension_of(mesh.element) != 3)
    throw SourceError(object.at("mesh"),
                      fmt::format("{} holds {} cells; an object needs solid cells (a closed surface in .obj, .stl or "
                                  ".ply is filled)",
                                  path, name_of(mesh.element)));
  const bool refine = object.element == "tet10" && mesh.element == Element::tet4;
  if (object.wrote("element") && !refine && element_named(object.element) != mesh.element)
    throw SourceError(object.at("element"),
                      fmt::format("{} holds {} cells; leave 'element' out to use them", path, name_of(mesh.element)));
  return mesh;
}

Mesh load_mesh(const SceneObject& object, const std::string& folder) {
  const std::string path = (std::filesystem::path(folder) / object.mesh).lexically_normal().string();
  Mesh mesh;
  if (object.box)
    mesh = transformed(box_mesh(object), placing(object));
  else if (object.mesh.ends_with(".msh"))
    mesh = file_mesh(object, path);
  else
    mesh = filled_mesh(object, path);
  if (object.element == "tet10" && mesh.element == Element::tet4) mesh = to_quadratic(mesh, Element::tet10);
  mesh.source = object.box ? "box of object '" + object.name + "'" : path;
  check_mesh(mesh);
  return mesh;
}

std::vector<int> fixed_vertices(const SceneObject& object, const Mesh& mesh) {
  std::vector<int> out;
  for (const BoxSelector& box : object.fixed) {
    const std::vector<int> inside = vertices_in_box(mesh, vector(box.min), vector(box.max));
    if (inside.empty()) {
      const auto bounds = bounding_box(mesh);
      throw SourceError(box.place,
                        fmt::format("this box holds no vertex of object '{}', which reaches from {} m to {} m",
                                    object.name, brackets(bounds.col(0)), brackets(bounds.col(1))));
    }
    out.insert(out.end(), inside.begin(), inside.end());
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace

Body load_body(const SceneObject& object, const std::string& folder) {
  Body body;
  body.name = object.name;
  const Place& place = object.box ? object.at("box") : object.at("mesh");
  try {
    body.mesh = load_mesh(object, folder);
  } catch (const InputError& bad) {
    throw SourceError(place, fmt::format("object '{}': {}", object.name, bad.what()));
  }
  ReorderedMesh reordered = spatial_order(body.mesh);
  body.ordered = std::move(reordered.mesh);
  body.vertex_from = std::move(reordered.vertex_from);
  body.fixed = fixed_vertices(object, body.ordered);
  for (const auto& triangle : surface_triangles(body.ordered))
    body.surface.insert(body.surface.end(), triangle.begin(), triangle.end());
  std::sort(body.surface.begin(), body.surface.end());
  body.surface.erase(std::unique(body.surface.begin(), body.surface.end()), body.surface.end());
  return body;
}

}  // namespace ergon
