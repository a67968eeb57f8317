#include "tools/verify/meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "runtime/mesh/mesh_build.h"

namespace ergon {

Mesh round_column(Element element, double radius, double height, int n) {
  const int layers = std::max(1, static_cast<int>(std::lround(height / radius * n)));
  Mesh mesh;
  mesh.element = linear_element(element);
  std::map<std::array<long, 3>, int> known;
  std::vector<Eigen::Vector3d> points;
  const auto vertex = [&](double x, double y, int layer) {
    const std::array<long, 3> key = {std::lround(1e9 * x / radius), std::lround(1e9 * y / radius), layer};
    const auto [found, fresh] = known.emplace(key, static_cast<int>(points.size()));
    if (fresh) points.emplace_back(x, y, height * layer / layers);
    return found->second;
  };
  // A block of cells over (s, t), which `place` maps to the disc.
  const auto block = [&](int across, int along, auto place) {
    for (int layer = 0; layer < layers; ++layer)
      for (int j = 0; j < along; ++j)
        for (int i = 0; i < across; ++i)
          for (const int k : {0, 1})
            for (const auto& [a, b] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
              const Eigen::Vector2d at = place(static_cast<double>(i + a) / across, static_cast<double>(j + b) / along);
              mesh.cells.push_back(vertex(at.x(), at.y(), layer + k));
            }
  };
  const double half = 0.45 * radius;
  block(n, n, [&](double s, double t) { return Eigen::Vector2d(half * (2 * s - 1), half * (2 * t - 1)); });
  for (int side = 0; side < 4; ++side)
    block(n, n, [&](double s, double t) {
      const double turn = side * M_PI / 2, angle = (2 * t - 1) * M_PI / 4;
      const Eigen::Vector2d inner(half, half * (2 * t - 1)),
          outer = radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      const Eigen::Vector2d at = (1 - s) * inner + s * outer;
      const double c = std::cos(turn), d = std::sin(turn);
      return Eigen::Vector2d(c * at.x() - d * at.y(), d * at.x() + c * at.y());
    });
  mesh.X.resize(3, static_cast<Eigen::Index>(points.size()));
  for (size_t v = 0; v < points.size(); ++v) mesh.X.col(static_cast<Eigen::Index>(v)) = points[v];
  if (degree_of(element) == 1) return mesh;
  mesh = to_quadratic(mesh, element);
  const double chord = radius * (std::cos(M_PI / (4 * n)) - 1e-6);
  for (int v = 0; v < mesh.vertices(); ++v)
    if (const double r = mesh.X.col(v).head<2>().norm(); r > chord) mesh.X.col(v).head<2>() *= radius / r;
  return mesh;
}

Mesh equilateral_strip(double cell, int along, int across) {
  const double side = 2 * cell / std::sqrt(3.0);
  Mesh mesh;
  mesh.element = Element::tri3;
  std::vector<Eigen::Vector3d> points;
  std::vector<std::vector<int>> columns;
  for (int i = 0; i <= along; ++i) {
    columns.emplace_back();
    const auto add = [&](double y) {
      columns.back().push_back(static_cast<int>(points.size()));
      points.emplace_back(i * cell, y * side, 0);
    };
    if (i % 2 == 0) {
      for (int j = 0; j <= across; ++j) add(j);
    } else {
      add(0);
      for (int j = 0; j < across; ++j) add(j + 0.5);
      add(across);
    }
  }
  const auto triangle = [&](int a, int b, int c) { mesh.cells.insert(mesh.cells.end(), {a, b, c}); };
  for (int i = 0; i < along; ++i) {
    // Of an even column `e`, next to an odd one `o`: sides of e face points of o, and the other way round.
    const bool turned = i % 2 == 1;
    const std::vector<int>&e = columns[static_cast<size_t>(turned ? i + 1 : i)],
          &o = columns[static_cast<size_t>(turned ? i : i + 1)];
    for (size_t j = 0; j + 1 < e.size(); ++j)
      turned ? triangle(e[j + 1], o[j + 1], e[j]) : triangle(e[j], o[j + 1], e[j + 1]);
    for (size_t j = 0; j < e.size(); ++j) turned ? triangle(e[j], o[j + 1], o[j]) : triangle(e[j], o[j], o[j + 1]);
  }
  mesh.X.resize(3, static_cast<Eigen::Index>(points.size()));
  for (size_t v = 0; v < points.size(); ++v) mesh.X.col(static_cast<Eigen::Index>(v)) = points[v];
  return mesh;
}

Mesh pipe_sector(Element element, double radius, double thickness, double length, double angle, int along, int around) {
  Mesh mesh = box_mesh(element, {length, angle, thickness}, {along, around, 1});
  for (int v = 0; v < mesh.vertices(); ++v) {
    const double r = radius - thickness / 2 + mesh.X(2, v), a = mesh.X(1, v);
    mesh.X.col(v).tail<2>() = Eigen::Vector2d(r * std::sin(a), r * std::cos(a));
  }
  return mesh;
}

}  // namespace ergon
