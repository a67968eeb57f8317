#pragma once
// Random placements of four points, from the ordinary to the degenerate, as they occur in contact.

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>

namespace ergon {

using FourPoints = std::array<Eigen::Vector3d, 4>;

class ContactCases {
 public:
  explicit ContactCases(unsigned seed) : random_(seed) {}

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  Eigen::Vector3d vector() { return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; }
  Eigen::Vector3d direction() { return vector().normalized(); }
  // Coordinates of few bits: what is degenerate stays so exactly.
  Eigen::Vector3d whole() {
    return {static_cast<double>(integer(-4, 4)), static_cast<double>(integer(-4, 4)),
            static_cast<double>(integer(-4, 4))};
  }
  double gap() { return std::pow(10.0, uniform(-16, 0)); }

  static constexpr int kPointTriangleKinds = 10;
  // p, t0, t1, t2.
  FourPoints point_triangle(int kind) {
    FourPoints x{vector(), vector(), vector(), vector()};
    if (kind == 1) {  // at a gap from a place on it
      double u = uniform(0, 1), v = uniform(0, 1 - u);
      if (integer(0, 2) == 0) u = 0;
      if (integer(0, 2) == 0) v = 0;
      x[0] = x[1] + u * (x[2] - x[1]) + v * (x[3] - x[1]) + gap() * direction();
    } else if (kind == 2) {  // a sliver
      x[3] = x[1] + uniform(-0.5, 1.5) * (x[2] - x[1]) + gap() * direction();
    } else if (kind == 3) {  // a sliver, near its line
      x[3] = x[1] + uniform(-0.5, 1.5) * (x[2] - x[1]) + gap() * direction();
      x[0] = x[1] + uniform(-0.5, 1.5) * (x[2] - x[1]) + gap() * direction();
    } else if (kind == 4) {  // small whole numbers: points on corners, sides, faces, triangles without area
      for (Eigen::Vector3d& p : x) p = whole();
    } else if (kind == 5) {  // without area
      x[2] = x[1] + gap() * direction();
      x[3] = integer(0, 1) == 0 ? x[1] : x[2];
    } else if (kind == 6) {  // vertex on vertex
      x[0] = x[static_cast<size_t>(integer(1, 3))] + (integer(0, 1) == 0 ? 0 : gap()) * direction();
    } else if (kind == 7) {  // in the plane of the triangle
      for (Eigen::Vector3d& p : x) p.z() = 0.25;
    } else if (kind == 8) {  // far from the origin
      x[0] = x[1] + uniform(0, 1) * (x[2] - x[1]) + gap() * direction();
      for (Eigen::Vector3d& p : x) p += Eigen::Vector3d(1e6, -1e6, 1e6);
    } else if (kind == 9) {  // tiny
      const double size = gap();
      for (Eigen::Vector3d& p : x) p *= size;
    }
    return x;
  }

  static constexpr int kEdgeEdgeKinds = 11;
  // a0, a1, b0, b1.
  FourPoints edge_edge(int kind) {
    FourPoints x{vector(), vector(), vector(), vector()};
    if (kind == 1) {  // inside by inside at a gap
      const double s = uniform(0, 1), t = uniform(0, 1);
      const Eigen::Vector3d move = x[0] + s * (x[1] - x[0]) - x[2] - t * (x[3] - x[2]) + gap() * direction();
      x[2] += move;
      x[3] += move;
    } else if (kind == 2) {  // nearly parallel, to 1e-16
      x[2] = x[0] + uniform(-1, 1) * (x[1] - x[0]) + gap() * direction();
      x[3] = x[2] + uniform(-2, 2) * (x[1] - x[0]) + gap() * direction();
    } else if (kind == 3) {  // nearly parallel, at a distance
      x[3] = x[2] + uniform(-2, 2) * (x[1] - x[0]) + gap() * direction();
    } else if (kind == 4) {
      for (Eigen::Vector3d& p : x) p = whole();
    } else if (kind == 5) {  // of no or next to no length
      x[1] = x[0] + (integer(0, 1) == 0 ? 0 : gap()) * direction();
      if (integer(0, 1) == 0) x[3] = x[2];
    } else if (kind == 6) {  // end to end
      x[2] = x[static_cast<size_t>(integer(0, 1))] + (integer(0, 1) == 0 ? 0 : gap()) * direction();
    } else if (kind == 7) {  // parallel and whole, collinear at times
      x[0] = whole();
      x[2] = integer(0, 1) == 0 ? whole() : x[0];
      const Eigen::Vector3d d = whole();
      x[1] = x[0] + integer(-3, 3) * d;
      x[2] += integer(-3, 3) * d;
      x[3] = x[2] + integer(-3, 3) * d;
    } else if (kind == 8) {
      x[2] = x[0] + uniform(0, 1) * (x[1] - x[0]) + gap() * direction();
      for (Eigen::Vector3d& p : x) p += Eigen::Vector3d(1e6, -1e6, 1e6);
    } else if (kind == 9) {
      const double size = gap();
      for (Eigen::Vector3d& p : x) p *= size;
    } else if (kind == 10) {  // crossing in one plane
      for (Eigen::Vector3d& p : x) p.z() = -0.5;
    }
    return x;
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace ergon
