#include "runtime/predicates.h"

#include <algorithm>
#include <cmath>

#include "runtime/double_double.h"

namespace ergon {
namespace {

using Eigen::Vector3d;

// A sum without rounding: parts that do not overlap, the smallest first. Adding to it is GROW-EXPANSION, theorem 10.
class ExactSum {
 public:
  void add(double value) {
    int kept = 0;
    for (int i = 0; i < size_; ++i) {
      const DoubleDouble sum = two_sum(value, part_[i]);
      if (sum.tail != 0) part_[kept++] = sum.tail;
      value = sum.head;
    }
    if (value != 0) part_[kept++] = value;
    size_ = kept;
  }
  // The largest part outweighs all others.
  int sign() const { return size_ == 0 ? 0 : part_[size_ - 1] > 0 ? 1 : -1; }

 private:
  double part_[200];  // one at most for each that is added
  int size_ = 0;
};

DoubleDouble difference(double a, double b) { return two_sum(a, -b); }

void add_product(double a, double b, ExactSum& sum) {
  if (a == 0 || b == 0) return;
  const DoubleDouble ab = two_product(a, b);
  sum.add(ab.tail);
  sum.add(ab.head);
}
void add_product(double a, double b, double c, ExactSum& sum) {
  if (a == 0 || b == 0) return;
  const DoubleDouble ab = two_product(a, b);
  add_product(ab.tail, c, sum);
  add_product(ab.head, c, sum);
}
// Products of numbers of two parts are sums of products of the parts.
void add_product(const DoubleDouble& a, const DoubleDouble& b, ExactSum& sum) {
  for (const double x : {a.head, a.tail}) {
    for (const double y : {b.head, b.tail}) add_product(x, y, sum);
  }
}
void add_product(const DoubleDouble& a, const DoubleDouble& b, const DoubleDouble& c, ExactSum& sum) {
  for (const double x : {a.head, a.tail}) {
    for (const double y : {b.head, b.tail}) {
      for (const double z : {c.head, c.tail}) add_product(x, y, z, sum);
    }
  }
}

int exact_orientation(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  DoubleDouble m[3][3];
  const Vector3d* rows[3] = {&a, &b, &c};
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) m[i][k] = difference((*rows[i])(k), d(k));
  }
  ExactSum sum;
  for (int k = 0; k < 3; ++k) {
    const int u = (k + 1) % 3, v = (k + 2) % 3;
    add_product(m[0][k], m[1][u], m[2][v], sum);
    add_product(-m[0][k], m[1][v], m[2][u], sum);
  }
  return sum.sign();
}

// Segments from p to q and from a to b in the plane of two axes; all ends belong to them.
bool segments_meet(const Vector3d& p, const Vector3d& q, const Vector3d& a, const Vector3d& b, int u, int v) {
  const int at_a = orientation_in_plane(p, q, a, u, v), at_b = orientation_in_plane(p, q, b, u, v);
  const int at_p = orientation_in_plane(a, b, p, u, v), at_q = orientation_in_plane(a, b, q, u, v);
  if (at_a * at_b < 0 && at_p * at_q < 0) return true;
  const auto between = [&](const Vector3d& x, const Vector3d& s, const Vector3d& t) {
    return std::min(s(u), t(u)) <= x(u) && x(u) <= std::max(s(u), t(u)) && std::min(s(v), t(v)) <= x(v) &&
           x(v) <= std::max(s(v), t(v));
  };
  return (at_a == 0 && between(a, p, q)) || (at_b == 0 && between(b, p, q)) || (at_p == 0 && between(p, a, b)) ||
         (at_q == 0 && between(q, a, b));
}

bool meet_in_plane(const Vector3d& p, const Vector3d& q, const Vector3d& a, const Vector3d& b, const Vector3d& c, int u,
                   int v) {
  if (segments_meet(p, q, a, b, u, v) || segments_meet(p, q, b, c, u, v) || segments_meet(p, q, c, a, u, v)) {
    return true;
  }
  // Or the segment is inside.
  const int turn = orientation_in_plane(a, b, c, u, v);
  return turn != 0 && orientation_in_plane(a, b, p, u, v) == turn && orientation_in_plane(b, c, p, u, v) == turn &&
         orientation_in_plane(c, a, p, u, v) == turn;
}

// Of things in one plane, one of the three projections along an axis loses nothing; what meets does so in all of them.
template <class Meet>
bool in_all_projections(const Meet& meet) {
  return meet(0, 1) && meet(1, 2) && meet(2, 0);
}

bool segments_meet(const Vector3d& p, const Vector3d& q, const Vector3d& a, const Vector3d& b) {
  return orientation(p, q, a, b) == 0 &&
         in_all_projections([&](int u, int v) { return segments_meet(p, q, a, b, u, v); });
}

}  // namespace

int sure_orientation(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  const Vector3d ad = a - d, bd = b - d, cd = c - d;
  const double x = bd.y() * cd.z() - bd.z() * cd.y(), y = bd.z() * cd.x() - bd.x() * cd.z(),
               z = bd.x() * cd.y() - bd.y() * cd.x();
  const double volume = ad.x() * x + ad.y() * y + ad.z() * z;
  // Rounding is below 7 units of 2^-53 and a little of the sum of absolute products.
  const Vector3d p = ad.cwiseAbs(), q = bd.cwiseAbs(), r = cd.cwiseAbs();
  const double magnitude = p.x() * (q.y() * r.z() + q.z() * r.y()) + p.y() * (q.z() * r.x() + q.x() * r.z()) +
                           p.z() * (q.x() * r.y() + q.y() * r.x());
  const double bound = 0x1p-50 * magnitude;
  return volume > bound ? 1 : volume < -bound ? -1 : 0;
}

int orientation(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  const int sure = sure_orientation(a, b, c, d);
  return sure != 0 ? sure : exact_orientation(a, b, c, d);
}

int orientation_in_plane(const Vector3d& a, const Vector3d& b, const Vector3d& c, int u, int v) {
  const double left = (a(u) - c(u)) * (b(v) - c(v)), right = (a(v) - c(v)) * (b(u) - c(u));
  const double bound = 0x1p-51 * (std::abs(left) + std::abs(right));
  if (left - right > bound) return 1;
  if (left - right < -bound) return -1;
  ExactSum sum;
  add_product(difference(a(u), c(u)), difference(b(v), c(v)), sum);
  add_product(-difference(a(v), c(v)), difference(b(u), c(u)), sum);
  return sum.sign();
}

bool segment_meets_triangle(const Vector3d& p, const Vector3d& q, const Vector3d& a, const Vector3d& b,
                            const Vector3d& c) {
  const int at_p = orientation(a, b, c, p), at_q = orientation(a, b, c, q);
  if (at_p * at_q > 0) return false;
  if (at_p != 0 || at_q != 0) {  // the segment crosses the plane at one point, to which its line leads
    const int s = orientation(p, q, a, b), t = orientation(p, q, b, c), r = orientation(p, q, c, a);
    return (s >= 0 && t >= 0 && r >= 0) || (s <= 0 && t <= 0 && r <= 0);
  }
  const auto flat = [&](int u, int v) { return orientation_in_plane(a, b, c, u, v) == 0; };
  if (in_all_projections(flat)) {  // the triangle is a segment, or a point
    return segments_meet(p, q, a, b) || segments_meet(p, q, b, c) || segments_meet(p, q, c, a);
  }
  return in_all_projections([&](int u, int v) { return meet_in_plane(p, q, a, b, c, u, v); });
}

}  // namespace ergon
