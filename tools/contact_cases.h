#pragma once
// Random placements and motions of four points, from the ordinary to the degenerate, as they occur in contact.

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

  // Two primitives of size 1 at a gap of 1e-6 to 0.1, each vertex moving by 1e-3 to 1 in a direction of its own: about
  // as many collide within the time as do not.
  struct Moving {
    FourPoints x, motion;
  };
  Moving near_contact(bool edges) {
    Moving m;
    m.x = edges ? edge_edge(0) : point_triangle(0);
    double s = uniform(0, 1), t = uniform(0, 1);
    if (!edges && s + t > 1) s = 1 - s, t = 1 - t;
    Eigen::Vector3d to = m.x[1] + s * (m.x[2] - m.x[1]) + t * (m.x[3] - m.x[1]);
    if (edges) to = m.x[0] + s * (m.x[1] - m.x[0]) - t * (m.x[3] - m.x[2]);
    const Eigen::Vector3d normal = edges ? (m.x[1] - m.x[0]).cross(m.x[3] - m.x[2]).normalized()
                                         : (m.x[2] - m.x[1]).cross(m.x[3] - m.x[1]).normalized();
    const double away = std::pow(10, uniform(-6, -1));
    to += (integer(0, 3) > 0 ? away : -away) * (integer(0, 1) > 0 ? normal : direction());
    if (edges) {
      m.x[3] += to - m.x[2];
      m.x[2] = to;
    } else {
      m.x[0] = to;
    }
    const double speed = std::pow(10, uniform(-3, 0));
    for (Eigen::Vector3d& v : m.motion) v = speed * vector();
    return m;
  }

  // Any placement with any motion.
  Moving any(bool edges) {
    Moving m;
    m.x = edges ? edge_edge(integer(0, kEdgeEdgeKinds - 1)) : point_triangle(integer(0, kPointTriangleKinds - 1));
    m.motion = motion(integer(0, kMotionKinds - 1), m.x, edges ? 2 : 1);
    return m;
  }

  static constexpr int kMotionKinds = 11;
  // Displacements of points at x, of which the first `first` are of one primitive.
  FourPoints motion(int kind, const FourPoints& x, size_t first) {
    const auto zero = Eigen::Vector3d::Zero();
    FourPoints m{zero, zero, zero, zero};
    const Eigen::Vector3d common = vector();
    // From a point of one primitive to one of the other.
    double u = uniform(0, 1), v = uniform(0, 1 - u);
    if (integer(0, 2) == 0) u = 0;
    if (integer(0, 2) == 0) v = 0;
    const Eigen::Vector3d onto = first == 1 ? Eigen::Vector3d(x[1] + u * (x[2] - x[1]) + v * (x[3] - x[1]) - x[0])
                                            : Eigen::Vector3d(x[2] + u * (x[3] - x[2]) - x[0] - v * (x[1] - x[0]));
    for (size_t i = 0; i < 4; ++i) {
      if (kind == 1) m[i] = vector();
      if (kind == 2) m[i] = gap() * vector();
      if (kind == 3) m[i] = common;
      if (kind == 4) m[i] = vector().cwiseProduct(Eigen::Vector3d(1, 1, 0));
      if (kind == 6) m[i] = common;
      if (kind == 7) m[i] = whole();
      if (kind == 10) m[i] = gap() * direction();
    }
    const double aim = uniform(0.5, 3), arrive = uniform(0.9, 1.1);
    for (size_t i = 0; i < first; ++i) {
      if (kind == 5) m[i] = aim * onto;
      if (kind == 6) m[i] += arrive * onto;                      // arriving, carried along
      if (kind == 8) m[i] = 1e3 * (onto + gap() * direction());  // fast
      if (kind == 9 && i == 0) m[i] = 2 * onto + gap() * direction();
      if (kind == 10) m[i] += 2 * onto;  // at times past an edge or a corner
    }
    return m;
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace ergon
