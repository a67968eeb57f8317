#include "runtime/contact/contact_frame.h"

#include <Eigen/Geometry>

#include "runtime/contact/distance.h"

namespace ergon {

ActiveList& list_of(ActiveSet& active, ContactKind kind) {
  ActiveList* const lists[] = {&active.point_point, &active.point_edge,          &active.point_triangle,
                               &active.edge_edge,   &active.parallel_point_edge, &active.parallel_point_point};
  return *lists[static_cast<int>(kind)];
}

const ActiveList& list_of(const ActiveSet& active, ContactKind kind) {
  return list_of(const_cast<ActiveSet&>(active), kind);
}

ContactFrame contact_frame(ContactKind kind, const int* vertices, const Eigen::Matrix3Xd& x) {
  const auto point = [&](int i) -> Eigen::Vector3d { return x.col(vertices[i]); };
  ContactFrame frame;
  auto& w = frame.weight;
  switch (kind) {
    case ContactKind::point_point:
      w = {1, -1, 0, 0};
      break;
    case ContactKind::point_edge: {
      const PointEdgeDistance d = point_edge_distance(point(0), point(1), point(2));
      w = {1, -d.weight[0], -d.weight[1], 0};
      break;
    }
    case ContactKind::point_triangle: {
      const PointTriangleDistance d = point_triangle_distance(point(0), point(1), point(2), point(3));
      w = {1, -d.weight[0], -d.weight[1], -d.weight[2]};
      break;
    }
    case ContactKind::edge_edge: {
      const EdgeEdgeDistance d = edge_edge_distance(point(0), point(1), point(2), point(3));
      w = {d.weight_a[0], d.weight_a[1], -d.weight_b[0], -d.weight_b[1]};
      break;
    }
    case ContactKind::parallel_point_edge: {
      const PointEdgeDistance d = point_edge_distance(point(0), point(2), point(3));
      w = {1, 0, -d.weight[0], -d.weight[1]};
      break;
    }
    case ContactKind::parallel_point_point:
      w = {1, 0, -1, 0};
      break;
  }
  Eigen::Vector3d way = Eigen::Vector3d::Zero();
  for (int i = 1; i < 4; ++i) {  // differences first: positions far from the origin keep the digits of the gap
    if (w[static_cast<size_t>(i)] != 0) way += w[static_cast<size_t>(i)] * (point(i) - point(0));
  }
  frame.distance = way.norm();
  frame.normal = frame.distance > 0 ? Eigen::Vector3d(way / frame.distance) : Eigen::Vector3d::Zero();
  return frame;
}

double parallel_factor(const int* edges, const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& X) {
  const auto edge = [&](const Eigen::Matrix3Xd& at, int i) -> Eigen::Vector3d {
    return at.col(edges[i + 1]) - at.col(edges[i]);
  };
  const double lengths = edge(X, 0).squaredNorm() * edge(X, 2).squaredNorm();
  const double y = std::min(edge(x, 0).cross(edge(x, 2)).squaredNorm() / (kMollified * lengths), 1.0);
  return y * (2 - y);
}

}  // namespace ergon
