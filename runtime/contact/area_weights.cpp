#include "runtime/contact/area_weights.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

namespace ergon {

void weight_by_area(CollisionSurface& surface, const Eigen::Matrix3Xd& X, double dhat) {
  std::vector<double> of_vertex(surface.object.size(), 0);
  std::map<std::array<int, 2>, double> of_edge;
  const auto sorted = [](int a, int b) { return std::array{std::min(a, b), std::max(a, b)}; };
  for (const auto& [a, b, c] : surface.triangles) {
    const Eigen::Vector3d p = X.col(a), q = X.col(b), r = X.col(c);
    const double third = (q - p).cross(r - p).norm() / 6;
    for (const int v : {a, b, c}) of_vertex[static_cast<size_t>(v)] += third;
    for (const auto& edge : {sorted(a, b), sorted(b, c), sorted(c, a)}) of_edge[edge] += third;
  }
  const auto width = [&](int vertex) {
    const double radius = surface.radius[static_cast<size_t>(surface.object[static_cast<size_t>(vertex)])];
    return radius > 0 ? 2 * radius : dhat;
  };
  constexpr double sides = 2, estimates = 2;  // surfaces; sums over points and over edges
  surface.edge_weight.clear();
  for (const auto& [a, b] : surface.edges) {
    const auto known = of_edge.find(sorted(a, b));
    const double strip = (X.col(b) - X.col(a)).norm() * width(a);
    if (known == of_edge.end()) {
      of_vertex[static_cast<size_t>(a)] += strip / 2;
      of_vertex[static_cast<size_t>(b)] += strip / 2;
    }
    // A pair of edges counts the mean of both weights: the sum of their areas, over sides and estimates.
    surface.edge_weight.push_back((known == of_edge.end() ? strip : known->second) * 2 / (sides * estimates));
  }
  surface.point_weight.clear();
  for (const int v : surface.points) {
    const double area = of_vertex[static_cast<size_t>(v)];
    surface.point_weight.push_back((area > 0 ? area : width(v) * width(v)) / (sides * estimates));
  }
}

std::vector<double> mean_weights(const CollisionSurface& surface) {
  std::vector<double> sum(surface.radius.size(), 0), count(surface.radius.size(), 0);
  for (size_t i = 0; i < surface.point_weight.size(); ++i) {
    const auto object = static_cast<size_t>(surface.object[static_cast<size_t>(surface.points[i])]);
    sum[object] += surface.point_weight[i];
    count[object] += 1;
  }
  for (size_t object = 0; object < sum.size(); ++object)
    sum[object] = count[object] > 0 ? sum[object] / count[object] : 1;
  return sum;
}

}  // namespace ergon
