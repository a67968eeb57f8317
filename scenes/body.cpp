#include "scenes/body.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "runtime/contact/intersections.h"
#include "runtime/contact/make_surface.h"
#include "runtime/error.h"
#include "runtime/mesh/curve.h"
#include "runtime/mesh/mesh_build.h"
#include "runtime/mesh/mesh_import.h"
#include "runtime/mesh/mesh_tools.h"
#include "runtime/mesh/shapes.h"

namespace ergon {
namespace {

// Cells that one object may have: well beyond what is solved in practice, and below what overflows an index.
constexpr double most_cells = 5e7;

Eigen::Vector3d vector(const Vector3& v) { return {v[0], v[1], v[2]}; }

std::string brackets(const Eigen::Vector3d& v) { return fmt::format("[{:.4g}, {:.4g}, {:.4g}]", v[0], v[1], v[2]); }

Transform placing(const SceneShape& shape) {
  auto about = [&](size_t axis) {
    return Eigen::AngleAxisd(shape.rotate[axis], Eigen::Vector3d::Unit(static_cast<int>(axis)));
  };
  const Eigen::AngleAxisd rotation(about(2) * about(1) * about(0));
  return {shape.scale, rotation.axis(), rotation.angle(), vector(shape.translate)};
}

// The place of what a shape is made from, for messages.
const Place& source_place(const SceneShape& shape) {
  for (const char* key : {"mesh", "box", "sphere", "tube", "torus", "curve", "points"})
    if (shape.wrote(key)) return shape.at(key);
  return shape.place;
}

const char* kind_of_source(const SceneShape& shape) {
  return shape.box            ? "box"
         : shape.sphere       ? "sphere"
         : shape.tube         ? "tube"
         : shape.torus        ? "torus"
         : shape.curve        ? "curve"
         : shape.mesh.empty() ? "points"
                              : "mesh";
}

std::vector<Eigen::Vector3d> vectors(const std::vector<Vector3>& points) {
  std::vector<Eigen::Vector3d> out;
  for (const Vector3& point : points) out.push_back(vector(point));
  return out;
}

// A line or loose points.
Mesh thin_mesh(const SceneShape& shape) {
  if (!shape.curve) return point_mesh(vectors(shape.points));
  const CurveSource& curve = *shape.curve;
  const std::vector<Eigen::Vector3d> points = vectors(curve.points);
  return line_mesh(curve.cells ? smooth_curve(points, curve.closed, *curve.cells) : points, curve.closed);
}

// A surface that is made or read, where it starts.
Mesh placed_surface(const SceneShape& shape, const std::string& path) {
  const Mesh surface =
      shape.sphere  ? sphere_surface(shape.sphere->radius, shape.sphere->cuts)
      : shape.tube  ? tube_surface(shape.tube->inner, shape.tube->outer, shape.tube->length, shape.tube->around,
                                   shape.tube->along)
      : shape.torus ? torus_surface(shape.torus->radius, shape.torus->section, shape.torus->around, shape.torus->across)
                    : read_surface(path);
  return transformed(surface, placing(shape));
}

double section_of(const SceneObject& object, int dimension) {
  const double sections[] = {object.volume, object.cross_section, object.thickness, 1};
  return sections[dimension];
}

Mesh made_box(const SceneObject& object) {
  const BoxSource& box = *object.box;
  const Element element = element_named(object.element_name());
  double cells = elements_per_brick(element);
  for (int axis = 0; axis < dimension_of(element); ++axis) cells *= box.cells[static_cast<size_t>(axis)];
  if (cells > most_cells)
    throw SourceError(box.at("cells"),
                      fmt::format("this makes {:.3g} cells; at most {:.3g} fit into one object", cells, most_cells));
  return shape_of(element) == ReferenceShape::triangle ? alternating_triangles(element, vector(box.size), box.cells)
                                                       : ergon::box_mesh(element, vector(box.size), box.cells);
}

Mesh filled_mesh(const SceneObject& object, const std::string& path) {
  const Mesh surface = placed_surface(object, path);
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
  const Element wanted = element_named(object.element_name());
  if (object.element != "automatic" && wanted != mesh.element && degree_of(wanted) == 2 &&
      linear_element(wanted) == mesh.element)
    return to_quadratic(mesh, wanted);
  if (object.element != "automatic" && wanted != mesh.element)
    throw SourceError(object.at("element"),
                      fmt::format("{} holds {} cells; leave 'element' out to use them", path, name_of(mesh.element)));
  return mesh;
}

// Membranes need a thickness, lines a cross-section, loose points a volume, and nothing else has one.
void check_section(const SceneObject& object, Element element) {
  const int dimension = dimension_of(element);
  const char* kinds[] = {"loose point", "line", "membrane", "solid"};
  for (const auto& [key, use, unit] :
       {std::tuple("thickness", 2, "m"), std::tuple("cross_section", 1, "m^2"), std::tuple("volume", 0, "m^3")}) {
    if (object.wrote(key) && dimension != use)
      throw SourceError(object.at(key), fmt::format("'{}' has no use here: {} cells make a {}", key, name_of(element),
                                                    kinds[dimension]));
    if (!(section_of(object, use) > 0) && dimension == use)
      throw SourceError(
          object.box ? object.at("element") : source_place(object),
          fmt::format("{} cells make a {}: give its '{}' in {}{}", name_of(element), kinds[dimension], key, unit,
                      dimension == 2 ? " (a closed surface in .obj, .stl or .ply is filled, unless 'element' is tri3 "
                                       "or tri6)"
                                     : ""));
  }
}

// The surface of cells as a mesh of its own.
Mesh boundary_of(const Mesh& cells) {
  Mesh out;
  out.element = Element::tri3;
  std::map<int, int> place;
  for (const auto& triangle : surface_triangles(cells))
    for (const int v : triangle) out.cells.push_back(place.emplace(v, static_cast<int>(place.size())).first->second);
  out.X.resize(3, static_cast<int>(place.size()));
  for (const auto& [from, to] : place) out.X.col(to) = cells.X.col(from);
  return out;
}

// All of an affine body that matters.
Mesh affine_surface(const SceneObject& object, const std::string& path) {
  if (object.box)
    return transformed(boundary_of(box_hexes(vector(object.box->size), object.box->cells)), placing(object));
  if (!object.mesh.ends_with(".msh")) return placed_surface(object, path);
  const Mesh cells = read_mesh(path);
  if (dimension_of(cells.element) < 2)
    throw InputError(fmt::format("{}: {} cells enclose no solid, as an affine body is", path, name_of(cells.element)));
  return transformed(boundary_of(cells), placing(object));
}

Mesh load_mesh(const SceneObject& object, const std::string& folder) {
  const std::string path = (std::filesystem::path(folder) / object.mesh).lexically_normal().string();
  Mesh mesh;
  if (object.affine())
    mesh = affine_surface(object, path);
  else if (object.box)
    mesh = transformed(made_box(object), placing(object));
  else if (object.mesh.ends_with(".msh"))
    mesh = file_mesh(object, path);
  else if (object.curve || object.wrote("points"))
    mesh = transformed(thin_mesh(object), placing(object));
  else if (object.keeps_surface())
    mesh = placed_surface(object, path);
  else
    mesh = filled_mesh(object, path);
  // The element that is wanted of what was filled, kept or drawn.
  const Element wanted = element_named(object.element_name());
  if (degree_of(wanted) == 2 && mesh.element == linear_element(wanted)) mesh = to_quadratic(mesh, wanted);
  if (!object.affine()) check_section(object, mesh.element);
  mesh.source = object.mesh.empty() ? fmt::format("{} of object '{}'", kind_of_source(object), object.name) : path;
  check_mesh(mesh);
  return mesh;
}

std::vector<int> selected_vertices(const BoxSelector& box, const SceneObject& object, const Mesh& mesh) {
  const std::vector<int> inside = vertices_in_box(mesh, vector(box.min), vector(box.max));
  if (!inside.empty()) return inside;
  const auto bounds = bounding_box(mesh);
  throw SourceError(box.place, fmt::format("this box holds no vertex of object '{}', which reaches from {} m to {} m",
                                           object.name, brackets(bounds.col(0)), brackets(bounds.col(1))));
}

// Boxes add up: who is held along all axes is fixed.
void hold_vertices(const SceneObject& object, Body& body) {
  const auto count = static_cast<size_t>(body.ordered.vertices());
  std::vector<Eigen::Vector3i> held(count, Eigen::Vector3i::Zero());
  for (const FixedBox& box : object.fixed) {
    if (object.affine() && box.axes != "xyz")
      throw SourceError(box.at("axes"), "an affine body is held as a whole, along all axes; leave 'axes' out");
    for (const int v : selected_vertices(box, object, body.ordered))
      for (const char axis : box.axes) held[static_cast<size_t>(v)][axis - 'x'] = 1;
  }
  for (int v = 0; v < body.ordered.vertices(); ++v) {
    const Eigen::Vector3i& axes = held[static_cast<size_t>(v)];
    if (axes.sum() == 3)
      body.fixed.push_back(v);
    else if (axes.sum() > 0)
      body.guides.push_back({v, Eigen::Vector3d(1 - axes[0], 1 - axes[1], 1 - axes[2]).asDiagonal()});
  }
}

void load_vertices(const SceneObject& object, Body& body) {
  std::set<int> held(body.fixed.begin(), body.fixed.end());
  for (const BodyScript& script : body.scripts) held.insert(script.vertices.begin(), script.vertices.end());
  for (const SceneLoad& load : object.loads) {
    const std::vector<int> loaded = selected_vertices(load, object, body.ordered);
    if (std::all_of(loaded.begin(), loaded.end(), [&](int v) { return held.contains(v); }))
      throw SourceError(load.place, fmt::format("all vertices of object '{}' in this box are fixed or scripted: a load "
                                                "moves none of them; move the box, or leave the load out",
                                                object.name));
    body.loads.push_back(load_shares(body.ordered, loaded));
    if (load.wrote("traction") && body.loads.back().dimension < 2)
      throw SourceError(
          load.at("traction"),
          fmt::format("this box holds no face of object '{}' with all its vertices; widen it, or give the "
                      "'force' on the {} in it",
                      object.name, body.loads.back().dimension == 1 ? "edges" : "vertices"));
  }
}

// A vertex follows one script at most.
std::vector<BodyScript> scripts_of(const SceneObject& object, const Mesh& mesh) {
  std::vector<BodyScript> out;
  std::vector<char> taken(static_cast<size_t>(mesh.vertices()), 0);
  for (const ScriptedBox& box : object.scripted) {
    out.push_back({selected_vertices(box, object, mesh), vector(box.center), box.motion, {}});
    for (const int v : out.back().vertices) {
      if (taken[static_cast<size_t>(v)] != 0)
        throw SourceError(box.place,
                          fmt::format("this box holds vertices of object '{}' that another script moves", object.name));
      taken[static_cast<size_t>(v)] = 1;
    }
  }
  return out;
}

// All vertices or none are held by these.
bool holds_all(const std::vector<int>& held, const BoxSelector& first, const char* key, const Body& body) {
  if (static_cast<int>(held.size()) == body.ordered.vertices()) return true;
  throw SourceError(
      first.place,
      fmt::format("an affine body moves or is held as a whole: the '{}' boxes of object '{}' hold {} of its "
                  "{} vertices; let them hold all, or leave them out",
                  key, body.name, held.size(), body.ordered.vertices()));
}

bool is_held(const SceneObject& object, const Body& body) {
  if (!object.fixed.empty() && holds_all(body.fixed, object.fixed.front(), "fixed", body)) return true;
  if (object.scripted.empty()) return false;
  std::vector<int> held;
  for (const BodyScript& script : body.scripts) held.insert(held.end(), script.vertices.begin(), script.vertices.end());
  return holds_all(held, object.scripted.front(), "scripted", body);
}

void order(Body& body) {
  ReorderedMesh reordered = spatial_order(body.mesh);
  body.ordered = std::move(reordered.mesh);
  body.vertex_from = std::move(reordered.vertex_from);
  body.cell_from = std::move(reordered.cell_from);
}

std::string path_in(const std::string& folder, const std::string& file) {
  return (std::filesystem::path(folder) / file).lexically_normal().string();
}

Mesh file_surface(const SceneObstacle& obstacle, const std::string& path) {
  return path.ends_with(".msh") ? transformed(read_mesh(path), placing(obstacle)) : placed_surface(obstacle, path);
}

void check_shape_cells(const Mesh& shape, const Mesh& mesh) {
  if (shape.element != mesh.element || shape.cell_count() != mesh.cell_count() || shape.vertices() != mesh.vertices())
    throw InputError(fmt::format(
        "{} has {} {} cells over {} vertices, and {} has {} {} cells over {}; a shape moves the vertices and leaves "
        "the cells as they are (vertices at one place count as one)",
        shape.source, shape.cell_count(), name_of(shape.element), shape.vertices(), mesh.source, mesh.cell_count(),
        name_of(mesh.element), mesh.vertices()));
  const auto n = static_cast<size_t>(nodes_of(mesh.element));
  for (size_t i = 0; i < mesh.cells.size(); ++i)
    if (shape.cells[i] != mesh.cells[i])
      throw InputError(
          fmt::format("cell {} of {} joins other vertices than in {}; a shape moves the vertices and "
                      "leaves the cells as they are",
                      i / n, shape.source, mesh.source));
}

void check_own_intersections(const Mesh& shape, const std::string& name) {
  const CollisionSurface surface =
      make_surface({{name, &shape, 0, 0}}, std::vector<char>(static_cast<size_t>(shape.vertices()), 1));
  const std::vector<Intersection> crossing = find_intersections(surface, shape.X);
  if (crossing.empty()) return;
  const auto& [edge, triangle] = crossing.front();
  throw InputError(
      fmt::format("{} intersects itself: edge {}-{} crosses triangle {}-{}-{} near {} m{}; move its parts "
                  "apart, or set touches_itself = false",
                  shape.source, edge[0], edge[1], triangle[0], triangle[1], triangle[2], brackets(shape.X.col(edge[0])),
                  crossing.size() > 1 ? fmt::format(", and {} more", crossing.size() - 1) : ""));
}

std::vector<ScriptShape> shapes_of(const SceneObstacle& obstacle, const Body& body, const std::string& folder) {
  std::vector<ScriptShape> out;
  for (const ShapeKey& key : obstacle.shapes) {
    try {
      const std::string path = path_in(folder, key.mesh);
      Mesh shape = file_surface(obstacle, path);
      shape.source = path;
      check_shape_cells(shape, body.mesh);
      check_mesh(shape);
      if (obstacle.touches_itself) check_own_intersections(shape, obstacle.name);
      out.push_back({key.time, Eigen::Matrix3Xd(3, shape.vertices())});
      for (int v = 0; v < shape.vertices(); ++v)
        out.back().x.col(v) = shape.X.col(body.vertex_from[static_cast<size_t>(v)]);
    } catch (const InputError& bad) {
      throw SourceError(key.at("mesh"), fmt::format("obstacle '{}': {}", obstacle.name, bad.what()));
    }
  }
  return out;
}

}  // namespace

Body load_body(const SceneObject& object, const std::string& folder) {
  Body body;
  body.name = object.name;
  const Place& place = source_place(object);
  std::optional<SolidMoments> moments;
  try {
    body.mesh = load_mesh(object, folder);
    if (object.affine()) moments = solid_moments(body.mesh);
  } catch (const InputError& bad) {
    throw SourceError(place, fmt::format("object '{}': {}", object.name, bad.what()));
  }
  order(body);
  hold_vertices(object, body);
  body.scripts = scripts_of(object, body.ordered);
  load_vertices(object, body);
  if (object.affine() && !is_held(object, body)) body.moments = moments;
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

Body load_obstacle(const SceneObstacle& obstacle, const std::string& folder) {
  Body body;
  body.name = obstacle.name;
  const std::string path = path_in(folder, obstacle.mesh);
  try {
    if (obstacle.box)
      body.mesh =
          transformed(box_mesh(element_named(obstacle.element), vector(obstacle.box->size), obstacle.box->cells),
                      placing(obstacle));
    else if (obstacle.curve || obstacle.wrote("points"))
      body.mesh = transformed(thin_mesh(obstacle), placing(obstacle));
    else
      body.mesh = obstacle.wrote("mesh") ? file_surface(obstacle, path) : placed_surface(obstacle, path);
    body.mesh.source =
        obstacle.mesh.empty() ? fmt::format("{} of obstacle '{}'", kind_of_source(obstacle), obstacle.name) : path;
    check_mesh(body.mesh);
  } catch (const InputError& bad) {
    throw SourceError(source_place(obstacle), fmt::format("obstacle '{}': {}", obstacle.name, bad.what()));
  }
  order(body);
  body.fixed.resize(static_cast<size_t>(body.ordered.vertices()));
  std::iota(body.fixed.begin(), body.fixed.end(), 0);
  if (!obstacle.motion.empty() || !obstacle.shapes.empty())
    body.scripts.push_back({body.fixed, vector(obstacle.center), obstacle.motion, shapes_of(obstacle, body, folder)});
  return body;
}

int vertices_of(const std::vector<Body>& bodies) {
  return bodies.back().first_vertex + bodies.back().ordered.vertices();
}

}  // namespace ergon
