#include "runtime/mesh/mesh_stencils.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "runtime/error.h"
#include "runtime/mesh/element_faces.h"
#include "runtime/mesh/rod_frames.h"

namespace ergon {
namespace {

std::vector<int> vertices_of(const Mesh& mesh) {
  std::vector<int> vertices = mesh.cells;
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

std::vector<int> edges_of(const Mesh& mesh) {
  const std::vector<std::array<int, 2>> corners = corner_edges(mesh.element);
  const int nodes = nodes_of(mesh.element);
  std::vector<std::array<int, 2>> edges;
  for (size_t start = 0; start < mesh.cells.size(); start += static_cast<size_t>(nodes)) {
    for (const auto& [a, b] : corners) {
      const int va = mesh.cells[start + static_cast<size_t>(a)], vb = mesh.cells[start + static_cast<size_t>(b)];
      edges.push_back({std::min(va, vb), std::max(va, vb)});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<int> flat;
  for (const auto& [a, b] : edges) flat.insert(flat.end(), {a, b});
  return flat;
}

// Every two edges of each vertex: the one that ends there before the one that begins there.
std::vector<int> corners_of(const Mesh& mesh) {
  std::map<int, std::vector<std::pair<bool, int>>> ends;  // vertex -> (it begins there, the other end)
  for (size_t start = 0; start < mesh.cells.size(); start += 2) {
    const int a = mesh.cells[start], b = mesh.cells[start + 1];
    ends[a].emplace_back(true, b);
    ends[b].emplace_back(false, a);
  }
  std::vector<int> flat;
  for (auto& [vertex, others] : ends) {
    std::stable_sort(others.begin(), others.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (size_t i = 0; i < others.size(); ++i) {
      for (size_t j = i + 1; j < others.size(); ++j)
        flat.insert(flat.end(), {others[i].second, vertex, others[j].second});
    }
  }
  return flat;
}

// A third corner and whether its triangle passes the edge upwards in numbers.
struct Side {
  bool upwards;
  int third;
};

std::vector<int> hinges_of(const Mesh& mesh) {
  std::map<std::array<int, 2>, std::vector<Side>> sides;  // by edge, lower vertex first
  for (size_t start = 0; start < mesh.cells.size(); start += 3) {
    const int* t = mesh.cells.data() + start;
    for (int i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3];
      sides[{std::min(a, b), std::max(a, b)}].push_back({a < b, t[(i + 2) % 3]});
    }
  }
  std::vector<int> flat;
  for (const auto& [edge, of] : sides) {
    for (size_t i = 0; i < of.size(); ++i) {
      for (size_t j = i + 1; j < of.size(); ++j) {
        const bool first = of[i].upwards || !of[j].upwards;
        flat.insert(flat.end(), {edge[0], edge[1], of[first ? i : j].third, of[first ? j : i].third});
      }
    }
  }
  return flat;
}

std::vector<int> cells_of(const Mesh& mesh) { return mesh.cells; }

std::array<int, 3> sorted(int a, int b, int c) {
  std::array<int, 3> out = {a, b, c};
  std::sort(out.begin(), out.end());
  return out;
}

// Around every vertex, the vertices that it shares a triangle with, ascending.
std::vector<std::vector<int>> neighbours_of(const Mesh& mesh) {
  std::vector<std::vector<int>> around(static_cast<size_t>(mesh.X.cols()));
  for (size_t start = 0; start < mesh.cells.size(); start += 3) {
    for (size_t i = 0; i < 3; ++i) {
      for (size_t j = 1; j < 3; ++j)
        around[static_cast<size_t>(mesh.cells[start + i])].push_back(mesh.cells[start + (i + j) % 3]);
    }
  }
  for (std::vector<int>& others : around) {
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
  }
  return around;
}

// Completes a patch of triangle and neighbours (-1: none) by the nearest vertices that it does not name yet.
void fill_patch(int* patch, const std::vector<std::vector<int>>& around) {
  std::vector<int> reached(patch, patch + 3);
  size_t next = 0;
  const auto named = [&](int v) { return std::find(patch, patch + 6, v) != patch + 6; };
  for (int* missing = std::find(patch, patch + 6, -1); missing != patch + 6;
       missing = std::find(patch, patch + 6, -1)) {
    while (next < reached.size() && named(reached[next])) {
      for (const int v : around[static_cast<size_t>(reached[next])])
        if (std::find(reached.begin(), reached.end(), v) == reached.end()) reached.push_back(v);
      ++next;
    }
    if (next == reached.size())
      throw InputError(
          fmt::format("a patch names 6 vertices; the triangle of vertices {}, {}, {} is connected to fewer: "
                      "refine the mesh",
                      patch[0], patch[1], patch[2]));
    *missing = reached[next];
  }
}

std::vector<int> patches_of(const Mesh& mesh) {
  std::map<std::array<int, 2>, std::vector<int>> thirds;  // by edge, lower vertex first: corners opposite to it
  for (size_t start = 0; start < mesh.cells.size(); start += 3) {
    const int* t = mesh.cells.data() + start;
    for (int i = 0; i < 3; ++i) {
      const int a = t[(i + 1) % 3], b = t[(i + 2) % 3];
      thirds[{std::min(a, b), std::max(a, b)}].push_back(t[i]);
    }
  }
  const std::vector<std::vector<int>> around = neighbours_of(mesh);
  std::vector<int> flat;
  for (size_t start = 0; start < mesh.cells.size(); start += 3) {
    const int* t = mesh.cells.data() + start;
    std::array<int, 6> patch = {t[0], t[1], t[2], -1, -1, -1};
    for (size_t i = 0; i < 3; ++i) {
      const int a = t[(i + 1) % 3], b = t[(i + 2) % 3];
      const std::vector<int>& of = thirds[{std::min(a, b), std::max(a, b)}];
      if (of.size() > 2)
        throw InputError(
            fmt::format("the edge of vertices {} and {} has {} triangles; patches are made of surfaces that do "
                        "not branch",
                        std::min(a, b), std::max(a, b), of.size()));
      // A vertex that lies across two edges (the tip of a tetrahedron's surface) would be named twice.
      const int across = of.size() < 2 ? -1 : of[of[0] == t[i] ? 1 : 0];
      if (std::find(patch.begin(), patch.end(), across) == patch.end() || across < 0)
        patch[3 + i] = across;
      else
        throw InputError(
            fmt::format("vertex {} lies across two edges of the triangle of vertices {}, {}, {}: patches need "
                        "a finer mesh",
                        across, t[0], t[1], t[2]));
    }
    fill_patch(patch.data(), around);
    flat.insert(flat.end(), patch.begin(), patch.end());
  }
  return flat;
}

std::vector<int> shell_triangles_of(const Mesh& mesh) {
  const std::vector<int> edges = edges_of(mesh);
  std::map<std::array<int, 2>, int> number;
  for (size_t i = 0; i < edges.size(); i += 2)
    number.emplace(std::array{edges[i], edges[i + 1]}, static_cast<int>(i / 2));
  std::vector<int> flat;
  for (size_t start = 0; start < mesh.cells.size(); start += 3) {
    const int* t = &mesh.cells[start];
    flat.insert(flat.end(), t, t + 3);
    for (int i = 0; i < 3; ++i) {
      const int a = t[(i + 1) % 3], b = t[(i + 2) % 3];
      flat.push_back(mesh.vertices() + number.at({std::min(a, b), std::max(a, b)}));
    }
  }
  return flat;
}

struct KindOfStencil {
  const char* name;
  int points;
  std::vector<Element> elements;  // that have some; empty: all
  std::vector<int> (*find)(const Mesh&);
  std::vector<RestSize> sizes;
};

const std::vector<KindOfStencil>& kinds() {
  static const std::vector<KindOfStencil> table = {
      {"point", 1, {}, vertices_of, {}},
      {"edge", 2, {}, edges_of, {{"L", {0, 1}}}},
      {"corner", 3, {Element::edge2}, corners_of, {{"L0", {0, 1}}, {"L1", {1, 2}}}},
      {"triangle", 3, {Element::tri3}, cells_of, {{"A", {0, 1, 2}}}},
      {"tetrahedron", 4, {Element::tet4}, cells_of, {{"V", {0, 1, 2, 3}}}},
      {"hinge", 4, {Element::tri3}, hinges_of, {{"L", {0, 1}}, {"A0", {0, 1, 2}}, {"A1", {0, 1, 3}}}},
      {"patch",
       6,
       {Element::tri3},
       patches_of,
       {{"A", {0, 1, 2}}, {"inner0", {1, 2, 3}, true}, {"inner1", {2, 0, 4}, true}, {"inner2", {0, 1, 5}, true}}},
      {"shell_triangle", 6, {Element::tri3}, shell_triangles_of, {{"A", {0, 1, 2}}}},
      {"rod_corner", 5, {Element::edge2}, rod_corners_of, {{"L0", {0, 1}}, {"L1", {1, 2}}}},
  };
  return table;
}

bool has(const KindOfStencil& kind, Element element) {
  if (kind.elements.empty()) return element != Element::point || kind.points == 1;
  return std::find(kind.elements.begin(), kind.elements.end(), element) != kind.elements.end();
}

const KindOfStencil& kind_named(std::string_view name) {
  for (const KindOfStencil& kind : kinds()) {
    if (name == kind.name) return kind;
  }
  throw InputError(
      fmt::format("no stencils '{}' can be made from a mesh; it has {}", name, fmt::join(stencil_kinds(), ", ")));
}

std::set<std::array<int, 3>> triangles_of(const Mesh& mesh) {
  std::set<std::array<int, 3>> cells;
  for (size_t start = 0; start < mesh.cells.size(); start += 3)
    cells.insert(sorted(mesh.cells[start], mesh.cells[start + 1], mesh.cells[start + 2]));
  return cells;
}

double simplex_size(const std::vector<Eigen::Vector3d>& x) {
  const Eigen::Vector3d a = x[1] - x[0];
  if (x.size() == 2) return a.norm();
  const Eigen::Vector3d normal = a.cross(x[2] - x[0]);
  return x.size() == 3 ? normal.norm() / 2 : std::abs(normal.dot(x[3] - x[0])) / 6;
}

}  // namespace

std::vector<int> stencils_on_mesh(std::string_view kind, const Mesh& mesh) {
  const KindOfStencil& found = kind_named(kind);
  if (has(found, mesh.element)) return found.find(mesh);
  throw InputError(fmt::format("'{}' stencils are made from a mesh of {} elements; this one has {}", kind,
                               elements_with(kind), name_of(mesh.element)));
}

std::vector<std::string> stencil_kinds() {
  std::vector<std::string> names;
  for (const KindOfStencil& kind : kinds()) names.emplace_back(kind.name);
  return names;
}

std::vector<std::string> stencil_kinds(Element element) {
  std::vector<std::string> names;
  for (const KindOfStencil& kind : kinds()) {
    if (has(kind, element)) names.emplace_back(kind.name);
  }
  return names;
}

std::string elements_with(std::string_view kind) {
  std::vector<std::string> names;
  for (const Element element : kind_named(kind).elements) names.push_back(name_of(element));
  return names.empty() ? "any" : fmt::format("{}", fmt::join(names, " or "));
}

std::vector<RestSize> rest_sizes(std::string_view kind) { return kind_named(kind).sizes; }

std::vector<double> rest_size_of(const RestSize& size, std::string_view kind, const std::vector<int>& stencils,
                                 const Mesh& mesh) {
  const auto points = static_cast<size_t>(kind_named(kind).points);
  std::vector<double> values;
  if (size.is_cell) {
    const std::set<std::array<int, 3>> cells = triangles_of(mesh);
    for (size_t start = 0; start < stencils.size(); start += points) {
      const auto at = [&](size_t i) { return stencils[start + static_cast<size_t>(size.points[i])]; };
      values.push_back(cells.contains(sorted(at(0), at(1), at(2))) ? 1 : 0);
    }
    return values;
  }
  std::vector<Eigen::Vector3d> at(size.points.size());
  for (size_t start = 0; start < stencils.size(); start += points) {
    for (size_t i = 0; i < at.size(); ++i) at[i] = mesh.X.col(stencils[start + static_cast<size_t>(size.points[i])]);
    values.push_back(simplex_size(at));
  }
  return values;
}

}  // namespace ergon
