#include "runtime/mesh/rod_frames.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "runtime/error.h"

namespace ergon {
namespace {

constexpr size_t kPoints = 5;    // of a rod corner
constexpr double kAlong = 1e-6;  // the sine of an angle below which two directions are one

Eigen::Vector3d direction(const Mesh& mesh, int cell) {
  const auto at = 2 * static_cast<size_t>(cell);
  return (mesh.X.col(mesh.cells[at + 1]) - mesh.X.col(mesh.cells[at])).normalized();
}

// A vector across unit a, carried along the great circle from a to b.
Eigen::Vector3d transported(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& v) {
  return v - v.dot(b) / (1 + a.dot(b)) * (a + b);
}

Eigen::Vector3d first_axis(const Eigen::Vector3d& along, const std::optional<Eigen::Vector3d>& axis) {
  constexpr double mostly = 0.9;
  const Eigen::Vector3d usual =
      std::abs(along.z()) > mostly ? Eigen::Vector3d::UnitX() : Eigen::Vector3d(Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d wanted = axis.value_or(usual), across = wanted - along * along.dot(wanted);
  if (!(across.norm() > kAlong * wanted.norm()))
    throw InputError(
        fmt::format("the axis of the cross-section, [{:g}, {:g}, {:g}], runs along the first edge; it must "
                    "point across",
                    wanted[0], wanted[1], wanted[2]));
  return across.normalized();
}

}  // namespace

std::vector<int> rod_corners_of(const Mesh& mesh) {
  const auto vertices = static_cast<size_t>(mesh.vertices());
  std::vector<int> ends(vertices, -1), begins(vertices, -1);  // the edge that ends, begins at a vertex
  for (int cell = 0; cell < mesh.cell_count(); ++cell) {
    const auto at = 2 * static_cast<size_t>(cell);
    const int from = mesh.cells[at], to = mesh.cells[at + 1];
    for (int* known : {&begins[static_cast<size_t>(from)], &ends[static_cast<size_t>(to)]}) {
      if (*known >= 0)
        throw InputError(
            fmt::format("edges {} and {} of this line both {} at vertex {}; a rod that twists does not "
                        "branch, and its edges run in one direction",
                        *known, cell, known == &begins[static_cast<size_t>(from)] ? "begin" : "end",
                        known == &begins[static_cast<size_t>(from)] ? from : to));
      *known = cell;
    }
  }
  std::vector<int> out;
  for (size_t vertex = 0; vertex < vertices; ++vertex) {
    if (ends[vertex] < 0 || begins[vertex] < 0) continue;
    const int before = mesh.cells[2 * static_cast<size_t>(ends[vertex])];
    const int after = mesh.cells[2 * static_cast<size_t>(begins[vertex]) + 1];
    out.insert(out.end(), {before, static_cast<int>(vertex), after, mesh.vertices() + ends[vertex],
                           mesh.vertices() + begins[vertex]});
  }
  return out;
}

std::vector<Eigen::Vector3d> cross_section_axes(const Mesh& mesh, const std::optional<Eigen::Vector3d>& axis) {
  const auto cells = static_cast<size_t>(mesh.cell_count());
  const std::vector<int> corners = rod_corners_of(mesh);
  std::vector<int> next(cells, -1);
  std::vector<char> follows(cells, 0);
  for (size_t start = 0; start < corners.size(); start += kPoints) {
    const int first = corners[start + 3] - mesh.vertices(), second = corners[start + 4] - mesh.vertices();
    next[static_cast<size_t>(first)] = second;
    follows[static_cast<size_t>(second)] = 1;
  }
  std::vector<Eigen::Vector3d> out(cells, Eigen::Vector3d::Zero());
  const auto carry_from = [&](size_t start) {
    out[start] = first_axis(direction(mesh, static_cast<int>(start)), axis);
    auto cell = static_cast<int>(start);
    for (int to = next[start]; to >= 0 && out[static_cast<size_t>(to)].isZero(0);
         cell = to, to = next[static_cast<size_t>(to)])
      out[static_cast<size_t>(to)] =
          transported(direction(mesh, cell), direction(mesh, to), out[static_cast<size_t>(cell)]).normalized();
  };
  for (size_t cell = 0; cell < cells; ++cell)
    if (follows[cell] == 0) carry_from(cell);
  for (size_t cell = 0; cell < cells; ++cell)
    if (out[cell].isZero(0)) carry_from(cell);
  return out;
}

std::vector<double> frame_turns(const Mesh& mesh, const std::vector<int>& corners,
                                const std::vector<Eigen::Vector3d>& axes) {
  std::vector<double> out;
  for (size_t start = 0; start < corners.size(); start += kPoints) {
    const int first = corners[start + 3] - mesh.vertices(), second = corners[start + 4] - mesh.vertices();
    const Eigen::Vector3d along = direction(mesh, second), &there = axes[static_cast<size_t>(second)];
    const Eigen::Vector3d carried = transported(direction(mesh, first), along, axes[static_cast<size_t>(first)]);
    out.push_back(std::atan2(carried.cross(there).dot(along), carried.dot(there)));
  }
  return out;
}

}  // namespace ergon
