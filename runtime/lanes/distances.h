#pragma once
// Distances of many pairs of primitives, one pair per lane: what runtime/contact/nearest_points.h finds in double
// precision, without branches. It establishes which pairs need more digits than that.

namespace ergon::lanes {

constexpr int kDistances = 128;  // pairs at a time

struct alignas(64) DistanceRoom {
  double coordinate[12][kDistances];  // m: of four vertices
  double gap2[kDistances];            // m^2; not at least 0 where more digits are needed
  // Point and triangle: the part of the triangle. Two edges: that of the first plus four times that of the second. As
  // in runtime/contact/distance.h.
  double part[kDistances];
  double sine2[kDistances];  // m^4, of edges: |cross(a, b)|^2
};

struct DistanceOperations {
  // x: 3 per vertex; pairs index points and triangles, or edges; count is at most kDistances.
  void (*point_triangle)(const double* x, const int* points, const int (*triangles)[3], const int (*pairs)[2],
                         int count, DistanceRoom&);
  void (*edge_edge)(const double* x, const int (*edges)[2], const int (*pairs)[2], int count, DistanceRoom&);
};

// Throws std::invalid_argument for a width that is none of kWidths or that this machine lacks.
const DistanceOperations& distance_operations(int lanes);

}  // namespace ergon::lanes
