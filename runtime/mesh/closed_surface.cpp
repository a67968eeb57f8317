#include "runtime/mesh/closed_surface.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/error.h"

namespace ergon {
namespace {

// One side of a triangle: the edge from `low` to `high`, and the direction in which the triangle runs along it.
struct Side {
  int low, high;
  int triangle;
  bool forward;
  bool same_edge(const Side& other) const { return low == other.low && high == other.high; }
};

std::string text_of(const Mesh& surface, int v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", surface.X(0, v), surface.X(1, v), surface.X(2, v));
}

std::vector<Side> sorted_sides(const Mesh& surface) {
  std::vector<Side> sides;
  sides.reserve(surface.cells.size());
  for (int t = 0; t < surface.cell_count(); ++t) {
    for (size_t i = 0; i < 3; ++i) {
      const int from = surface.cells[3 * static_cast<size_t>(t) + i];
      const int to = surface.cells[3 * static_cast<size_t>(t) + (i + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), t, from < to});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::array{a.low, a.high, a.triangle} < std::array{b.low, b.high, b.triangle};
  });
  return sides;
}

// Throws unless every edge has exactly two triangles; then sides 2 e and 2 e + 1 are those of edge e.
void check_closed(const Mesh& surface, const std::vector<Side>& sides) {
  int open = 0, branching = 0;
  const Side* open_edge = nullptr;
  const Side* branching_edge = nullptr;
  for (size_t i = 0; i < sides.size();) {
    size_t next = i + 1;
    while (next < sides.size() && sides[next].same_edge(sides[i])) ++next;
    if (next - i == 1 && open++ == 0) open_edge = &sides[i];
    if (next - i > 2 && branching++ == 0) branching_edge = &sides[i];
    i = next;
  }
  if (open_edge) {
    throw InputError(fmt::format(
        "{}: the surface is open: {} edge{} only one triangle, such as the edge from {} to {}; close its holes",
        surface.source, open, open == 1 ? " has" : "s have", text_of(surface, open_edge->low),
        text_of(surface, open_edge->high)));
  }
  if (branching_edge) {
    throw InputError(fmt::format(
        "{}: the surface branches: {} edge{} more than two triangles, such as the edge from {} to {}; remove inner "
        "walls and doubled triangles",
        surface.source, branching, branching == 1 ? " has" : "s have", text_of(surface, branching_edge->low),
        text_of(surface, branching_edge->high)));
  }
}

// Solid angle of the triangle (a, b, c) seen from the origin, positive when it is clockwise from there. Van Oosterom
// and Strackee 1983, The Solid Angle of a Plane Triangle, IEEE Transactions on Biomedical Engineering 30(2), eq. 8.
double solid_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

bool encloses(const Mesh& surface, const SurfacePart& part, const Eigen::Vector3d& point) {
  double sum = 0;
  for (const auto& t : part.triangles) {
    sum += solid_angle(surface.X.col(t[0]) - point, surface.X.col(t[1]) - point, surface.X.col(t[2]) - point);
  }
  return std::abs(sum) > 2 * std::numbers::pi;
}

// Neighbours of each triangle across its edges, and whether both run along the edge in the same direction, in which
// case one of them must be turned over.
struct Neighbour {
  int triangle;
  bool turned;
};

std::vector<std::vector<Neighbour>> neighbours_of(const Mesh& surface, const std::vector<Side>& sides) {
  std::vector<std::vector<Neighbour>> neighbours(static_cast<size_t>(surface.cell_count()));
  for (size_t i = 0; i < sides.size(); i += 2) {
    const Side& a = sides[i];
    const Side& b = sides[i + 1];
    const bool turned = a.forward == b.forward;
    neighbours[static_cast<size_t>(a.triangle)].push_back({b.triangle, turned});
    neighbours[static_cast<size_t>(b.triangle)].push_back({a.triangle, turned});
  }
  return neighbours;
}

std::array<int, 3> corners_of(const Mesh& surface, int triangle) {
  const int* v = &surface.cells[3 * static_cast<size_t>(triangle)];
  return {v[0], v[1], v[2]};
}

void nest(const Mesh& surface, std::vector<SurfacePart>& parts) {
  std::vector<Eigen::AlignedBox3d> boxes(parts.size());
  for (size_t p = 0; p < parts.size(); ++p) {
    for (const auto& t : parts[p].triangles) {
      for (const int v : t) boxes[p].extend(Eigen::Vector3d(surface.X.col(v)));
    }
  }
  for (size_t inner = 0; inner < parts.size(); ++inner) {
    const Eigen::Vector3d point = surface.X.col(parts[inner].triangles[0][0]);
    double smallest = std::numeric_limits<double>::infinity();
    for (size_t outer = 0; outer < parts.size(); ++outer) {
      if (outer == inner || !boxes[outer].contains(point) || !encloses(surface, parts[outer], point)) continue;
      ++parts[inner].depth;
      const double volume = enclosed_volume(surface.X, parts[outer].triangles);
      if (volume < smallest) {
        smallest = volume;
        parts[inner].parent = static_cast<int>(outer);
      }
    }
  }
}

}  // namespace

double enclosed_volume(const Eigen::Matrix3Xd& X, const std::vector<std::array<int, 3>>& triangles) {
  if (triangles.empty()) return 0;
  const Eigen::Vector3d origin = X.col(triangles[0][0]);
  double sum = 0;
  for (const auto& t : triangles) {
    sum += (X.col(t[0]) - origin).dot((X.col(t[1]) - origin).cross(X.col(t[2]) - origin));
  }
  return sum / 6;
}

std::vector<SurfacePart> closed_parts(const Mesh& surface) {
  if (surface.element != Element::tri3) {
    throw InputError(
        fmt::format("{}: a surface is made of Tri3, this mesh is {}", surface.source, name_of(surface.element)));
  }
  if (surface.cells.empty()) throw InputError(surface.source + ": the surface has no triangles");
  const std::vector<Side> sides = sorted_sides(surface);
  check_closed(surface, sides);
  const auto neighbours = neighbours_of(surface, sides);

  std::vector<SurfacePart> parts;
  std::vector<int> orientation(neighbours.size(), 0);  // 1 as given, -1 turned over, 0 not visited
  for (int seed = 0; seed < surface.cell_count(); ++seed) {
    if (orientation[static_cast<size_t>(seed)] != 0) continue;
    orientation[static_cast<size_t>(seed)] = 1;
    std::vector<int> members{seed};
    for (size_t i = 0; i < members.size(); ++i) {
      const int here = orientation[static_cast<size_t>(members[i])];
      for (const Neighbour& neighbour : neighbours[static_cast<size_t>(members[i])]) {
        int& there = orientation[static_cast<size_t>(neighbour.triangle)];
        const int wanted = neighbour.turned ? -here : here;
        if (there == 0) {
          there = wanted;
          members.push_back(neighbour.triangle);
        } else if (there != wanted) {
          throw InputError(
              fmt::format("{}: the surface has only one side: its triangles cannot be oriented, as is seen "
                          "at the triangle with a corner at {}",
                          surface.source, text_of(surface, corners_of(surface, members[i])[0])));
        }
      }
    }
    std::sort(members.begin(), members.end());
    SurfacePart part;
    for (const int t : members) {
      part.triangles.push_back(corners_of(surface, t));
      if (orientation[static_cast<size_t>(t)] < 0) std::swap(part.triangles.back()[1], part.triangles.back()[2]);
    }
    const double volume = enclosed_volume(surface.X, part.triangles);
    const double extent = (surface.X.rowwise().maxCoeff() - surface.X.rowwise().minCoeff()).norm();
    if (std::abs(volume) <= 1e-15 * std::pow(extent, 3)) {
      throw InputError(fmt::format("{}: the part of the surface at {} encloses no volume", surface.source,
                                   text_of(surface, part.triangles[0][0])));
    }
    if (volume < 0) {
      for (auto& t : part.triangles) std::swap(t[1], t[2]);
    }
    parts.push_back(std::move(part));
  }

  std::vector<std::array<int, 3>> all;
  for (int t = 0; t < surface.cell_count(); ++t) all.push_back(corners_of(surface, t));
  const auto [first, second] = crossing_triangles(surface.X, all);
  if (first >= 0) {
    throw InputError(
        fmt::format("{}: the surface cuts itself: triangles {} and {} (counted from 0) cross or "
                    "overlap near {}",
                    surface.source, first, second, text_of(surface, all[static_cast<size_t>(first)][0])));
  }
  nest(surface, parts);
  return parts;
}

}  // namespace ergon
