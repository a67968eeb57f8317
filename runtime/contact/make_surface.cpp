#include "runtime/contact/make_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "runtime/error.h"
#include "runtime/mesh/mesh_tools.h"

namespace ergon {

namespace {

template <class T>
void sort_unique(std::vector<T>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

std::array<int, 2> ascending(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

void check_cells(const CollisionObject& object) {
  const Mesh& mesh = *object.mesh;
  const int nodes = nodes_of(mesh.element);
  if (mesh.cells.empty()) throw InputError(fmt::format("{}: no cells to make a collision surface of", object.name));
  std::vector<int> cell;
  for (int c = 0; c < mesh.cell_count(); ++c) {
    cell.assign(mesh.cells.begin() + c * nodes, mesh.cells.begin() + (c + 1) * nodes);
    for (const int v : cell) {
      if (v >= 0 && v < mesh.vertices()) continue;
      throw InputError(fmt::format("{}: cell {} names vertex {}; there are {}", object.name, c, v, mesh.vertices()));
    }
    std::sort(cell.begin(), cell.end());
    const auto twice = std::adjacent_find(cell.begin(), cell.end());
    if (twice == cell.end()) continue;
    throw InputError(fmt::format("{}: cell {} names vertex {} twice", object.name, c, *twice));
  }
}

void check_radius(const std::string& name, double radius) {
  if (radius >= 0 && std::isfinite(radius)) return;
  throw InputError(fmt::format("{}: the contact radius is {:g} m; it must be finite and at least 0", name, radius));
}

// Primitives of a mesh in its own vertices.
void add_primitives(const Mesh& mesh, int first_vertex, CollisionSurface& surface) {
  const auto moved = [first_vertex](int v) { return first_vertex + v; };
  const int dimension = dimension_of(mesh.element);
  if (dimension >= 2) {
    for (const auto& t : surface_triangles(mesh)) surface.triangles.push_back({moved(t[0]), moved(t[1]), moved(t[2])});
    return;
  }
  const auto nodes = static_cast<size_t>(nodes_of(mesh.element));
  for (size_t start = 0; start < mesh.cells.size(); start += nodes) {
    const int* cell = mesh.cells.data() + start;
    if (dimension == 0) {
      surface.points.push_back(moved(cell[0]));
    } else if (nodes == 2) {
      surface.edges.push_back(ascending(moved(cell[0]), moved(cell[1])));
    } else {  // the middle is last
      surface.edges.push_back(ascending(moved(cell[0]), moved(cell[2])));
      surface.edges.push_back(ascending(moved(cell[2]), moved(cell[1])));
    }
  }
}

// Triangles of the same three vertices, whichever way round, are one: the first stays.
void drop_repeated(std::vector<std::array<int, 3>>& triangles) {
  std::set<std::array<int, 3>> known;
  std::erase_if(triangles, [&](std::array<int, 3> t) {
    std::sort(t.begin(), t.end());
    return !known.insert(t).second;
  });
}

void complete(CollisionSurface& surface) {
  drop_repeated(surface.triangles);
  for (const auto& t : surface.triangles) {
    for (size_t i = 0; i < 3; ++i) surface.edges.push_back(ascending(t[i], t[(i + 1) % 3]));
  }
  sort_unique(surface.edges);
  for (const auto& edge : surface.edges) surface.points.insert(surface.points.end(), edge.begin(), edge.end());
  sort_unique(surface.points);
}

}  // namespace

CollisionSurface make_surface(const std::vector<CollisionObject>& objects, std::vector<char> moving) {
  CollisionSurface surface;
  const int vertices = static_cast<int>(moving.size()), count = static_cast<int>(objects.size());
  surface.object.assign(moving.size(), -1);
  surface.moving = std::move(moving);
  for (int o = 0; o < count; ++o) {
    const CollisionObject& object = objects[static_cast<size_t>(o)];
    if (object.name.empty()) throw InputError(fmt::format("collision object {} has no name", o + 1));
    if (std::find(surface.names.begin(), surface.names.end(), object.name) != surface.names.end()) {
      throw InputError(fmt::format("two collision objects are named '{}'; give each its own name", object.name));
    }
    check_radius(object.name, object.radius);
    check_cells(object);
    const int first = object.first_vertex, last = first + object.mesh->vertices();
    if (first < 0 || last > vertices) {
      throw InputError(
          fmt::format("{}: its vertices are {} to {} of a system of {}", object.name, first, last - 1, vertices));
    }
    for (int v = first; v < last; ++v) {
      int& owner = surface.object[static_cast<size_t>(v)];
      if (owner >= 0) {
        throw InputError(fmt::format("vertex {} belongs to both {} and {}", v,
                                     surface.names[static_cast<size_t>(owner)], object.name));
      }
      owner = o;
    }
    surface.names.push_back(object.name);
    surface.radius.push_back(object.radius);
    add_primitives(*object.mesh, first, surface);
  }
  complete(surface);
  surface.meet.assign(objects.size(), std::vector<char>(objects.size(), 1));
  return surface;
}

void check_surface(const CollisionSurface& surface) {
  const size_t vertices = surface.object.size(), objects = surface.radius.size();
  if (surface.moving.size() != vertices) {
    throw InputError(
        fmt::format("{} vertices have an object, {} tell whether they move", vertices, surface.moving.size()));
  }
  if (surface.names.size() != objects || surface.meet.size() != objects) {
    throw InputError(fmt::format("{} objects have a radius, {} a name and {} a row of meet", objects,
                                 surface.names.size(), surface.meet.size()));
  }
  for (size_t a = 0; a < objects; ++a) {
    check_radius(surface.names[a], surface.radius[a]);
    if (surface.meet[a].size() != objects) {
      throw InputError(fmt::format("{}: its row of meet has {} entries for {} objects", surface.names[a],
                                   surface.meet[a].size(), objects));
    }
    for (size_t b = 0; b < a; ++b) {
      if (surface.meet[a][b] == surface.meet[b][a]) continue;
      throw InputError(fmt::format("whether {} and {} meet is said in two ways", surface.names[b], surface.names[a]));
    }
  }
  const std::set<int> points(surface.points.begin(), surface.points.end());
  std::set<std::array<int, 2>> edges;
  std::set<std::array<int, 3>> triangles;
  if (points.size() != surface.points.size()) throw InputError("a point of the collision surface stands in it twice");
  for (const int v : surface.points) {
    const bool known = v >= 0 && v < static_cast<int>(vertices);
    const int object = known ? surface.object[static_cast<size_t>(v)] : -1;
    if (object < 0 || object >= static_cast<int>(objects)) {
      throw InputError(fmt::format("point {} of the collision surface belongs to no object", v));
    }
  }
  const auto same_object = [&](int a, int b) {
    return surface.object[static_cast<size_t>(a)] == surface.object[static_cast<size_t>(b)];
  };
  for (const auto& [a, b] : surface.edges) {
    if (!points.contains(a) || !points.contains(b))
      throw InputError(fmt::format("edge {}-{}: its ends are not points", a, b));
    if (a == b || !same_object(a, b))
      throw InputError(fmt::format("edge {}-{} does not join two points of an object", a, b));
    if (!edges.insert(ascending(a, b)).second)
      throw InputError(fmt::format("edge {}-{} stands in the surface twice", a, b));
  }
  for (auto t : surface.triangles) {
    for (size_t i = 0; i < 3; ++i) {
      if (edges.contains(ascending(t[i], t[(i + 1) % 3]))) continue;
      throw InputError(
          fmt::format("triangle {}-{}-{}: its side {}-{} is no edge", t[0], t[1], t[2], t[i], t[(i + 1) % 3]));
    }
    std::sort(t.begin(), t.end());
    if (!triangles.insert(t).second) {
      throw InputError(fmt::format("triangle {}-{}-{} stands in the surface twice", t[0], t[1], t[2]));
    }
  }
}

}  // namespace ergon
