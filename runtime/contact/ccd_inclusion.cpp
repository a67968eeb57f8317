#include "runtime/contact/ccd_inclusion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/contact/distance.h"

// The difference of two points, one on each primitive, is F(t, u, v) = origin(t) + u*along(t) + v*across(t), each
// linear in time. Over a box of (t, u, v) it stays in the hull of its values at the eight corners. Boxes whose hull is
// beyond the limit along some direction are done with; others are halved, the earliest first, so that when one is too
// small to be halved, all time before it is free.

namespace ergon {
namespace {

using Eigen::Vector3d;

constexpr double kRounding = 0x1p-48;  // of the sum of all lengths in F: six roundings of each
constexpr double kMore = 1 + 0x1p-49;
constexpr double kResolved = 0x1p-6;  // of the way that there is: smaller hulls are not halved
constexpr size_t kBoxes = 2048;
constexpr int kRounds = 1 << 14;

struct Moving {
  Vector3d at, rate;
  Vector3d operator()(double t) const { return at + t * rate; }
};
struct Difference {
  Moving origin, along, across;
  bool triangle;  // u + v <= 1
};

struct Box {
  std::array<double, 3> low, high;  // t, u, v; halves of halves: exact
};
bool later(const Box& a, const Box& b) { return a.low[0] > b.low[0]; }

struct Corners {
  Vector3d value[8];  // bit 0: t, bit 1: u, bit 2: v
  Corners(const Difference& f, const Box& box) {
    for (int i = 0; i < 2; ++i) {
      const double t = i == 0 ? box.low[0] : box.high[0];
      const Vector3d origin = f.origin(t), along = f.along(t), across = f.across(t);
      for (int j = 0; j < 4; ++j) {
        value[i | j << 1] =
            origin + (j & 1 ? box.high[1] : box.low[1]) * along + (j & 2 ? box.high[2] : box.low[2]) * across;
      }
    }
  }
  // All of the hull, rounding of each corner included, is farther from the origin than `limit`.
  bool beyond(double limit, double error) const {
    Vector3d n = Vector3d::Zero();
    for (const Vector3d& v : value) n += v;
    const double length = n.norm();
    double least = value[0].dot(n);
    for (const Vector3d& v : value) least = std::min(least, v.dot(n));
    return least > kMore * (limit + error) * length;
  }
  double extent(int axis) const {
    double extent = 0;
    for (int i = 0; i < 8; ++i) {
      if ((i >> axis & 1) == 0) extent = std::max(extent, (value[i | 1 << axis] - value[i]).lpNorm<1>());
    }
    return extent;
  }
};

double search(const Difference& f, double gap, const CcdQuery& query) {
  double error = 0;
  for (const Moving* m : {&f.origin, &f.along, &f.across}) {
    error += kRounding * (m->at.lpNorm<1>() + m->rate.lpNorm<1>());
  }
  gap = (1 + 1e-8) * gap;  // runtime/contact/distance.h keeps nine digits
  const double limit = query.separation + query.kept * std::max(0.0, gap - query.separation);
  const double resolved = kResolved * (gap - limit);
  std::array<Box, kBoxes> heap;
  size_t count = 0;
  const auto push = [&](const Box& box) {
    if (f.triangle && box.low[1] + box.low[2] > 1) return;
    if (Corners(f, box).beyond(limit, error)) return;
    heap[count++] = box;
    std::push_heap(heap.begin(), heap.begin() + static_cast<std::ptrdiff_t>(count), later);
  };
  push({{0, 0, 0}, {1, 1, 1}});
  for (int round = 0; count > 0; ++round) {
    Box box = heap[0];
    if (box.low[0] >= query.at_most) break;
    if (round == kRounds || count + 1 == kBoxes) return box.low[0];
    const Corners corners(f, box);
    const double extent[3] = {corners.extent(0), corners.extent(1), corners.extent(2)};
    const auto axis = static_cast<size_t>(std::max_element(extent, extent + 3) - extent);
    if (!(extent[axis] > std::max(resolved, error))) return box.low[0];
    std::pop_heap(heap.begin(), heap.begin() + static_cast<std::ptrdiff_t>(count), later);
    --count;
    const double middle = (box.low[axis] + box.high[axis]) / 2;
    Box upper = box;
    upper.low[axis] = box.high[axis] = middle;
    push(box);
    push(upper);
  }
  return query.at_most;
}

}  // namespace

double point_triangle_step_by_inclusion(const CcdQuery& q) {
  const auto difference = [&](int i, int j) { return Moving{q.x[j] - q.x[i], q.motion[j] - q.motion[i]}; };
  const double gap = std::sqrt(point_triangle_distance(q.x[0], q.x[1], q.x[2], q.x[3]).gap2);
  return search({difference(0, 1), difference(1, 2), difference(1, 3), true}, gap, q);
}

double edge_edge_step_by_inclusion(const CcdQuery& q) {
  const auto difference = [&](int i, int j) { return Moving{q.x[j] - q.x[i], q.motion[j] - q.motion[i]}; };
  const double gap = std::sqrt(edge_edge_distance(q.x[0], q.x[1], q.x[2], q.x[3]).gap2);
  return search({difference(0, 2), difference(1, 0), difference(2, 3), false}, gap, q);
}

}  // namespace ergon
