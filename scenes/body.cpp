#include "scenes/body.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <tuple>

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

double section_of(const SceneObject& object, int dimension) {
  return dimension == 2 ? object.thickness : dimension == 1 ? object.cross_section : 1;
}

Mesh made_box(const SceneObject& object) {
  const BoxSource& box = *object.box;
  const Element element = element_named(object.element);
  double cells = elements_per_brick(element);
  for (int axis = 0; axis < dimension_of(element); ++axis) cells *= box.cells[static_cast<size_t>(axis)];
  if (cells > most_cells)
    throw SourceError(box.at("cells"),
                      fmt::format("this makes {:.3g} cells; at most {:.3g} fit into one object", cells, most_cells));
  return ergon::box_mesh(element, vector(box.size), box.cells);
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
  const Element wanted = element_named(object.element);
  if (object.wrote("element") && wanted != mesh.element && degree_of(wanted) == 2 &&
      linear_element(wanted) == mesh.element)
    return to_quadratic(mesh, wanted);
  if (object.wrote("element") && wanted != mesh.element)
    throw SourceError(object.at("element"),
                      fmt::format("{} holds {} cells; leave 'element' out to use them", path, name_of(mesh.element)));
  return mesh;
}

// Membranes need a thickness, lines a cross-section, and nothing else has one.
void check_section(const SceneObject& object, Element element) {
  const int dimension = dimension_of(element);
  const char* kinds[] = {"point", "line", "membrane", "solid"};
  for (const auto& [key, use, unit] : {std::tuple("thickness", 2, "m"), std::tuple("cross_section", 1, "m^2")}) {
    if (object.wrote(key) && dimension != use)
      throw SourceError(object.at(key), fmt::format("'{}' has no use here: {} cells make a {}", key, name_of(element),
                                                    kinds[dimension]));
    if (!(section_of(object, use) > 0) && dimension == use)
      throw SourceError(
          object.at(object.box ? "element" : "mesh"),
          fmt::format("{} cells make a {}: give its '{}' in {} (a closed surface in .obj, .stl or .ply is "
                      "filled)",
                      name_of(element), kinds[dimension], key, unit));
  }
}

Mesh load_mesh(const SceneObject& object, const std::string& folder) {
  const std::string path = (std::filesystem::path(folder) / object.mesh).lexically_normal().string();
  Mesh mesh;
  if (object.box)
    mesh = transformed(made_box(object), placing(object));
  else if (object.mesh.ends_with(".msh"))
    mesh = file_mesh(object, path);
  else
    mesh = filled_mesh(object, path);
  if (object.element == "tet10" && mesh.element == Element::tet4) mesh = to_quadratic(mesh, Element::tet10);
  check_section(object, mesh.element);
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
  body.quadrature = object.quadrature;
  body.section = section_of(object, dimension_of(body.mesh.element));
  if (dimension_of(body.ordered.element) < 2)
    body.surface = body.ordered.cells;
  else
    for (const auto& triangle : surface_triangles(body.ordered))
      body.surface.insert(body.surface.end(), triangle.begin(), triangle.end());
  std::sort(body.surface.begin(), body.surface.end());
  body.surface.erase(std::unique(body.surface.begin(), body.surface.end()), body.surface.end());
  return body;
}

}  // namespace ergon
