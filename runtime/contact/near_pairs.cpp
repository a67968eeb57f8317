#include "runtime/contact/near_pairs.h"

#include <algorithm>

#include "runtime/lanes/distances.h"
#include "runtime/lanes/lanes.h"

namespace ergon {

namespace {

constexpr std::ptrdiff_t kSerial = 8192;  // fewer are not worth waking other threads
constexpr double kRounding = 1 + 1e-9;    // distances are rounded by less than 2^-35 of them

template <size_t N>
void largest_of_corners(const std::vector<std::array<int, N>>& primitives, const MotionBoxes& motion,
                        std::vector<double>& largest) {
  largest.resize(primitives.size());
  const auto count = static_cast<std::ptrdiff_t>(primitives.size());
#pragma omp parallel for schedule(static) if (count > kSerial)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    double most = 0;
    for (const int v : primitives[static_cast<size_t>(i)]) {
      most = std::max(most, motion.range()[static_cast<size_t>(motion.number_of(v))]);
    }
    largest[static_cast<size_t>(i)] = most;
  }
}

// measure(pairs, count, room) finds the distances of up to kDistances pairs.
template <class Measure>
long keep(std::array<int, 2>* pairs, long count, double drift, const std::vector<double>& range_a,
          const std::vector<double>& range_b, const Measure& measure) {
  lanes::DistanceRoom room;
  long kept = 0;
  for (long first = 0; first < count; first += lanes::kDistances) {
    const int n = static_cast<int>(std::min<long>(lanes::kDistances, count - first));
    measure(reinterpret_cast<const int(*)[2]>(pairs + first), n, room);
    for (int i = 0; i < n; ++i) {
      const std::array<int, 2> pair = pairs[first + i];
      const double limit =
          (range_a[static_cast<size_t>(pair[0])] + range_b[static_cast<size_t>(pair[1])] + drift) * kRounding;
      pairs[kept] = pair;
      kept += !(room.gap2[i] > limit * limit);
    }
  }
  return kept;
}

}  // namespace

void NearPairs::prepare(const MotionBoxes& motion, const Eigen::Matrix3Xd& x) {
  x_ = &x;
  points_ = &motion.range();
  largest_of_corners(surface_->edges, motion, edges_);
  largest_of_corners(surface_->triangles, motion, triangles_);
}

long NearPairs::keep_point_triangle(std::array<int, 2>* pairs, long count, double drift) const {
  const lanes::DistanceOperations& operations = lanes::distance_operations(lanes::best_lanes());
  const auto* triangles = reinterpret_cast<const int(*)[3]>(surface_->triangles.data());
  return keep(pairs, count, drift, *points_, triangles_, [&](const int(*some)[2], int n, lanes::DistanceRoom& room) {
    operations.point_triangle(x_->data(), surface_->points.data(), triangles, some, n, room);
  });
}

long NearPairs::keep_edge_edge(std::array<int, 2>* pairs, long count, double drift) const {
  const lanes::DistanceOperations& operations = lanes::distance_operations(lanes::best_lanes());
  const auto* edges = reinterpret_cast<const int(*)[2]>(surface_->edges.data());
  return keep(pairs, count, drift, edges_, edges_, [&](const int(*some)[2], int n, lanes::DistanceRoom& room) {
    operations.edge_edge(x_->data(), edges, some, n, room);
  });
}

}  // namespace ergon
