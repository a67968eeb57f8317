#pragma once
// Distances of points, edges and triangles, with the parts of them that are nearest. They keep their digits where edges
// are nearly parallel, where a triangle or an edge has no extent and where the gap is far below the size of the parts:
// the squared distance is that of the points found, and those are refined on the part that was chosen.

#include <Eigen/Core>

namespace ergon {

// Parts are named by a bit mask of the ends or corners that they hang on: 1, 2, 4 are corners, 3, 5, 6 are edges
// and 7 is the face of a triangle; 1 and 2 are the ends of an edge and 3 its inside.
struct PointEdgeDistance {
  double gap2 = 0;     // m^2
  unsigned part = 0;   // of the edge
  double weight[2]{};  // of the ends in the nearest point; zero where the part does not hang on an end; they add to 1
};
struct PointTriangleDistance {
  double gap2 = 0;
  unsigned part = 0;  // of the triangle
  double weight[3]{};
};
struct EdgeEdgeDistance {
  double gap2 = 0;
  unsigned part_a = 0, part_b = 0;
  double weight_a[2]{}, weight_b[2]{};
};

PointEdgeDistance point_edge_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& e0, const Eigen::Vector3d& e1);
PointTriangleDistance point_triangle_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& t0,
                                              const Eigen::Vector3d& t1, const Eigen::Vector3d& t2);
EdgeEdgeDistance edge_edge_distance(const Eigen::Vector3d& a0, const Eigen::Vector3d& a1, const Eigen::Vector3d& b0,
                                    const Eigen::Vector3d& b1);

}  // namespace ergon
