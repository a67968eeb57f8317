#include "runtime/mesh/shapes.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>

#include "runtime/error.h"

namespace ergon {

namespace {

// The twelve vertices of an icosahedron: cyclic permutations of (0, +-1, +-golden ratio).
std::vector<Eigen::Vector3d> icosahedron_vertices() {
  const double golden = (1 + std::sqrt(5.0)) / 2;
  std::vector<Eigen::Vector3d> vertices;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double one : {-1.0, 1.0}) {
      for (const double ratio : {-golden, golden}) {
        Eigen::Vector3d v = Eigen::Vector3d::Zero();
        v[(axis + 1) % 3] = one;
        v[(axis + 2) % 3] = ratio;
        vertices.push_back(v);
      }
    }
  }
  return vertices;
}

// Its twenty faces: all triples of vertices that are pairwise nearest, seen from outside.
std::vector<std::array<int, 3>> icosahedron_faces(const std::vector<Eigen::Vector3d>& v) {
  const auto are_near = [&](size_t i, size_t j) { return (v[i] - v[j]).squaredNorm() < 4.5; };  // edges have 4
  std::vector<std::array<int, 3>> faces;
  for (size_t i = 0; i < v.size(); ++i) {
    for (size_t j = i + 1; j < v.size(); ++j) {
      for (size_t k = j + 1; k < v.size(); ++k) {
        if (!are_near(i, j) || !are_near(j, k) || !are_near(k, i)) continue;
        const bool outward = v[i].dot(v[j].cross(v[k])) > 0;
        faces.push_back({static_cast<int>(i), static_cast<int>(outward ? j : k), static_cast<int>(outward ? k : j)});
      }
    }
  }
  return faces;
}

void append(Mesh& mesh, int a, int b, int c) { mesh.cells.insert(mesh.cells.end(), {a, b, c}); }

}  // namespace

Mesh sphere_surface(double radius, int cuts) {
  if (!(radius > 0) || !std::isfinite(radius))
    throw InputError(fmt::format("a sphere's radius is {:g} m; it must be above 0", radius));
  if (cuts < 1) throw InputError(fmt::format("a sphere's edges are cut into {}; at least 1 is needed", cuts));
  const std::vector<Eigen::Vector3d> corners = icosahedron_vertices();
  Mesh mesh;
  mesh.element = Element::tri3;
  std::vector<Eigen::Vector3d> points;
  // A point by the corners it lies between and how many cuts it is away from their opposite sides: the same on both
  // faces of an edge.
  std::map<std::map<int, int>, int> known;
  const auto vertex = [&](const std::array<int, 3>& face, int i, int j) {
    std::map<int, int> weights;
    for (const auto& [corner, weight] :
         {std::pair(face[0], cuts - i - j), std::pair(face[1], i), std::pair(face[2], j)})
      if (weight > 0) weights[corner] = weight;
    const auto [found, is_new] = known.emplace(weights, static_cast<int>(points.size()));
    if (is_new) {
      Eigen::Vector3d p = Eigen::Vector3d::Zero();
      for (const auto& [corner, weight] : weights) p += weight * corners[static_cast<size_t>(corner)];
      points.push_back(radius * p.normalized());
    }
    return found->second;
  };
  for (const std::array<int, 3>& face : icosahedron_faces(corners)) {
    for (int i = 0; i < cuts; ++i) {
      for (int j = 0; j < cuts - i; ++j) {
        append(mesh, vertex(face, i, j), vertex(face, i + 1, j), vertex(face, i, j + 1));
        if (i + j + 2 > cuts) continue;
        append(mesh, vertex(face, i + 1, j), vertex(face, i + 1, j + 1), vertex(face, i, j + 1));
      }
    }
  }
  mesh.X.resize(3, static_cast<int>(points.size()));
  for (size_t i = 0; i < points.size(); ++i) mesh.X.col(static_cast<int>(i)) = points[i];
  return mesh;
}

Mesh tube_surface(double inner, double outer, double length, int around, int along) {
  if (!(inner > 0) || !(outer > inner) || !std::isfinite(outer) || !(length > 0) || !std::isfinite(length))
    throw InputError(
        fmt::format("a tube's radii are {:g} m and {:g} m and its length is {:g} m; 0 < inner < outer and "
                    "a positive length are needed",
                    inner, outer, length));
  if (around < 3 || along < 1)
    throw InputError(
        fmt::format("a tube has {} cells around and {} along; at least 3 and 1 are needed", around, along));
  Mesh mesh;
  mesh.element = Element::tri3;
  mesh.X.resize(3, 2 * around * (along + 1));
  const auto vertex = [&](int side, int i, int j) { return (side * (along + 1) + j) * around + i % around; };
  for (int side = 0; side < 2; ++side) {
    const double radius = side == 0 ? inner : outer;
    for (int j = 0; j <= along; ++j) {
      for (int i = 0; i < around; ++i) {
        const double angle = 2 * M_PI * i / around;
        mesh.X.col(vertex(side, i, j)) =
            Eigen::Vector3d(length * j / along, radius * std::cos(angle), radius * std::sin(angle));
      }
    }
  }
  // Counter-clockwise seen from the side to which the first edge, turned into the second, points.
  const auto quadrilateral = [&](int a, int b, int c, int d) {
    append(mesh, a, b, c);
    append(mesh, a, c, d);
  };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < along; ++j) {
      quadrilateral(vertex(1, i, j), vertex(1, i + 1, j), vertex(1, i + 1, j + 1), vertex(1, i, j + 1));
      quadrilateral(vertex(0, i, j), vertex(0, i, j + 1), vertex(0, i + 1, j + 1), vertex(0, i + 1, j));
    }
    quadrilateral(vertex(0, i, 0), vertex(0, i + 1, 0), vertex(1, i + 1, 0), vertex(1, i, 0));
    quadrilateral(vertex(1, i, along), vertex(1, i + 1, along), vertex(0, i + 1, along), vertex(0, i, along));
  }
  return mesh;
}

Mesh torus_surface(double radius, double section, int around, int across) {
  if (!(section > 0) || !(radius > section) || !std::isfinite(radius))
    throw InputError(fmt::format(
        "a ring's radius is {:g} m and that of its section {:g} m; 0 < section < radius is needed", radius, section));
  if (around < 3 || across < 3)
    throw InputError(
        fmt::format("a ring has {} cells around and {} across; at least 3 and 3 are needed", around, across));
  Mesh mesh;
  mesh.element = Element::tri3;
  mesh.X.resize(3, around * across);
  const auto vertex = [&](int i, int j) { return (i % around) * across + j % across; };
  for (int i = 0; i < around; ++i) {
    const double along = 2 * M_PI * i / around;
    for (int j = 0; j < across; ++j) {
      const double about = 2 * M_PI * j / across, distance = radius + section * std::cos(about);
      mesh.X.col(vertex(i, j)) =
          Eigen::Vector3d(distance * std::cos(along), distance * std::sin(along), section * std::sin(about));
    }
  }
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      append(mesh, vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1));
      append(mesh, vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1));
    }
  }
  return mesh;
}

}  // namespace ergon
