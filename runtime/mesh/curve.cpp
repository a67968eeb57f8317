#include "runtime/mesh/curve.h"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/error.h"

namespace ergon {
namespace {

using Eigen::Vector3d;

constexpr int samples = 64;  // of each cubic, to measure its length

void check_count(size_t points, bool closed) {
  const size_t least = closed ? 3 : 2;
  if (points >= least) return;
  throw InputError(fmt::format("a {}line has {} point{}; at least {} are needed", closed ? "closed " : "", points,
                               points == 1 ? "" : "s", least));
}

Mesh mesh_of(const std::vector<Vector3d>& points, Element element, const char* source) {
  Mesh mesh;
  mesh.element = element;
  mesh.source = source;
  mesh.X.resize(3, static_cast<Eigen::Index>(points.size()));
  for (size_t i = 0; i < points.size(); ++i) mesh.X.col(static_cast<Eigen::Index>(i)) = points[i];
  return mesh;
}

// The slope at p1 of the parabola through p0, p1 and p2, a before and b after it.
Vector3d slope(const Vector3d& p0, const Vector3d& p1, const Vector3d& p2, double a, double b) {
  return ((p1 - p0) * b / a + (p2 - p1) * a / b) / (a + b);
}

// The cubic with values p, q and slopes u, v over a parameter of the given length; s from 0 to 1.
Vector3d hermite(const Vector3d& p, const Vector3d& q, const Vector3d& u, const Vector3d& v, double length, double s) {
  const double r = 1 - s;
  return r * r * (1 + 2 * s) * p + s * s * (1 + 2 * r) * q + length * (r * r * s * u - s * s * r * v);
}

std::vector<Vector3d> slopes(const std::vector<Vector3d>& points, const std::vector<double>& lengths, bool closed) {
  const size_t n = points.size();
  std::vector<Vector3d> out(n);
  for (size_t i = 0; i < n; ++i) {
    if (!closed && (i == 0 || i + 1 == n)) continue;
    const size_t before = (i + n - 1) % n;
    out[i] = slope(points[before], points[i], points[(i + 1) % n], lengths[before], lengths[i]);
  }
  if (closed) return out;
  // The parabola of the neighbour, or the straight line.
  const auto end = [&](size_t at, size_t next, double length) {
    const Vector3d mean = (points[next] - points[at]) / length * (next > at ? 1 : -1);
    out[at] = n > 2 ? Vector3d(2 * mean - out[next]) : mean;
  };
  end(0, 1, lengths[0]);
  end(n - 1, n - 2, lengths[n - 2]);
  return out;
}

}  // namespace

Mesh point_mesh(const std::vector<Vector3d>& points) {
  if (points.empty()) throw InputError("there are no points");
  Mesh mesh = mesh_of(points, Element::point, "points");
  for (int i = 0; i < mesh.vertices(); ++i) mesh.cells.push_back(i);
  return mesh;
}

Mesh line_mesh(const std::vector<Vector3d>& points, bool closed) {
  check_count(points.size(), closed);
  Mesh mesh = mesh_of(points, Element::edge2, "line");
  const int n = mesh.vertices();
  for (int i = 0; i < (closed ? n : n - 1); ++i) mesh.cells.insert(mesh.cells.end(), {i, (i + 1) % n});
  return mesh;
}

std::vector<Vector3d> smooth_curve(const std::vector<Vector3d>& points, bool closed, int cells) {
  check_count(points.size(), closed);
  if (cells < 1) throw InputError(fmt::format("a line is cut into {} cells; at least 1 is needed", cells));
  const size_t n = points.size(), pieces = closed ? n : n - 1;
  std::vector<double> lengths;
  for (size_t i = 0; i < pieces; ++i) {
    lengths.push_back((points[(i + 1) % n] - points[i]).norm());
    if (!(lengths.back() > 0))
      throw InputError(fmt::format("points {} and {} of the line (counted from 0) are in one place", i, (i + 1) % n));
  }
  const std::vector<Vector3d> slope = slopes(points, lengths, closed);
  std::vector<Vector3d> fine;
  std::vector<double> way;  // up to each of them, m
  for (size_t i = 0; i < pieces; ++i) {
    const size_t j = (i + 1) % n;
    for (int k = i == 0 ? 0 : 1; k <= samples; ++k) {
      const double s = static_cast<double>(k) / samples;
      fine.push_back(hermite(points[i], points[j], slope[i], slope[j], lengths[i], s));
      way.push_back(way.empty() ? 0 : way.back() + (fine.back() - fine[fine.size() - 2]).norm());
    }
  }
  std::vector<Vector3d> out;
  for (int c = 0; c < (closed ? cells : cells + 1); ++c) {
    const double at = way.back() * c / cells;
    const auto next = std::clamp<std::ptrdiff_t>(std::upper_bound(way.begin(), way.end(), at) - way.begin(), 1,
                                                 static_cast<std::ptrdiff_t>(way.size()) - 1);
    const auto i = static_cast<size_t>(next);
    const double part = std::min(1.0, (at - way[i - 1]) / (way[i] - way[i - 1]));
    out.emplace_back(fine[i - 1] + part * (fine[i] - fine[i - 1]));
  }
  return out;
}

}  // namespace ergon
