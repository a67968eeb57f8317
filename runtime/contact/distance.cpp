#include "runtime/contact/distance.h"

#include "runtime/contact/nearest_points.h"
#include "runtime/double_double.h"

namespace ergon {
namespace {

using Eigen::Vector3d;
using nearest::from_to;

// Nearest points are rounded to about 2^-53 of the size of the parts. Where that is more than 2^-35 of the gap, all is
// done with twice the digits.
constexpr double kNear = 0x1p-36;  // of the size squared

double largest(double a, double b) { return a < b ? b : a; }

template <class T>
PointEdgeDistance point_edge(const Vector3d& p, const Vector3d& e0, const Vector3d& e1) {
  const auto found = nearest::on_edge(from_to<T>(p, e0), from_to<T>(p, e1), from_to<T>(e0, e1));
  return {static_cast<double>(found.gap2),
          found.part,
          {static_cast<double>(found.weight[0]), static_cast<double>(found.weight[1])}};
}

template <class T>
PointTriangleDistance point_triangle(const Vector3d& p, const Vector3d& t0, const Vector3d& t1, const Vector3d& t2) {
  const auto found = nearest::on_triangle(from_to<T>(p, t0), from_to<T>(p, t1), from_to<T>(p, t2), from_to<T>(t0, t1),
                                          from_to<T>(t1, t2), from_to<T>(t2, t0));
  return {static_cast<double>(found.gap2),
          found.part,
          {static_cast<double>(found.weight[0]), static_cast<double>(found.weight[1]),
           static_cast<double>(found.weight[2])}};
}

template <class T>
EdgeEdgeDistance edge_edge(const Vector3d& a0, const Vector3d& a1, const Vector3d& b0, const Vector3d& b1) {
  const auto found = nearest::of_edges(from_to<T>(a0, b0), from_to<T>(a0, b1), from_to<T>(a1, b0), from_to<T>(a1, b1),
                                       from_to<T>(a0, a1), from_to<T>(b0, b1));
  return {static_cast<double>(found.gap2),
          found.part_a,
          found.part_b,
          {static_cast<double>(found.weight_a[0]), static_cast<double>(found.weight_a[1])},
          {static_cast<double>(found.weight_b[0]), static_cast<double>(found.weight_b[1])}};
}

}  // namespace

PointEdgeDistance point_edge_distance(const Vector3d& p, const Vector3d& e0, const Vector3d& e1) {
  const PointEdgeDistance found = point_edge<double>(p, e0, e1);
  const double size2 = largest((e0 - p).squaredNorm(), (e1 - p).squaredNorm());
  return found.gap2 < kNear * size2 ? point_edge<DoubleDouble>(p, e0, e1) : found;
}

PointTriangleDistance point_triangle_distance(const Vector3d& p, const Vector3d& t0, const Vector3d& t1,
                                              const Vector3d& t2) {
  const PointTriangleDistance found = point_triangle<double>(p, t0, t1, t2);
  const double size2 = largest(largest((t0 - p).squaredNorm(), (t1 - p).squaredNorm()), (t2 - p).squaredNorm());
  return found.gap2 < kNear * size2 ? point_triangle<DoubleDouble>(p, t0, t1, t2) : found;
}

EdgeEdgeDistance edge_edge_distance(const Vector3d& a0, const Vector3d& a1, const Vector3d& b0, const Vector3d& b1) {
  const EdgeEdgeDistance found = edge_edge<double>(a0, a1, b0, b1);
  const double size2 = largest((a1 - a0).squaredNorm(), (b1 - b0).squaredNorm());
  return found.gap2 < kNear * size2 ? edge_edge<DoubleDouble>(a0, a1, b0, b1) : found;
}

}  // namespace ergon
