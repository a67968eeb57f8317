#include "runtime/contact/motion_boxes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/contact/surface_trees.h"
#include "runtime/error.h"

namespace ergon {

using Eigen::Array3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

namespace {

constexpr std::ptrdiff_t kSerial = 8192;  // fewer are not worth waking other threads
constexpr double kUnits = 1 << 29;  // along the longest side of all: a box and a shift add up to less than an int holds
constexpr double kSpare = 0.25;     // of a point's motion, beyond its slack
constexpr double kDrift = 0.25;     // of the slack: mean motions below it are left to the boxes

}  // namespace

MotionBoxes::MotionBoxes(const CollisionSurface& surface)
    : surface_(&surface), number_(point_numbers(surface)), count_(surface.radius.size(), 0) {
  for (const int v : surface.points) count_[object_of(v)] += 1;
}

double MotionBoxes::half(double reach, int vertex) const { return reach / 2 + surface_->radius[object_of(vertex)]; }

double MotionBoxes::fraction(const Matrix3Xd& x) const {
  double along = 0, all = 0;
  for (const int v : surface_->points) along += drift_[object_of(v)].dot(x.col(v));
  for (size_t o = 0; o < drift_.size(); ++o) {
    along -= drift_[o].dot(start_[o]);
    all += count_[o] * drift_[o].squaredNorm();
  }
  return std::clamp(along / all, 0.0, 1.0);
}

double MotionBoxes::excess(const Matrix3Xd& x0, const Matrix3Xd& x1, double reach) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (held_.empty()) return surface_->points.empty() ? 0 : infinity;
  // A smaller reach leaves no more room to move: ranges are balls and would not hold what moves into the corners.
  const double asked = std::max(reach, reach_);
  const double from = still_ ? 0 : fraction(x0), to = still_ ? 0 : &x1 == &x0 ? from : fraction(x1);
  const auto count = static_cast<std::ptrdiff_t>(held_.size());
  double most = -infinity;
#pragma omp parallel for schedule(static) if (count > kSerial) reduction(max : most)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const int v = surface_->points[static_cast<size_t>(i)];
    const Box& box = held_[static_cast<size_t>(i)];
    const Vector3d& drift = drift_[object_of(v)];
    const double r = half(asked, v);
    for (int k = 0; k < 3; ++k) {
      const double a = x0(k, v) - from * drift[k], b = x1(k, v) - to * drift[k];
      for (const double over :
           {box.lower[k] + r - a, box.lower[k] + r - b, a + r - box.upper[k], b + r - box.upper[k]}) {
        if (!(over <= most)) most = std::isnan(over) ? infinity : over;
      }
    }
  }
  return most;
}

void MotionBoxes::find_drift(const Matrix3Xd& x0, const Matrix3Xd& x1) {
  start_.assign(count_.size(), Vector3d::Zero());
  drift_.assign(count_.size(), Vector3d::Zero());
  for (const int v : surface_->points) {
    if (!x0.col(v).allFinite() || !x1.col(v).allFinite()) {
      throw InputError(fmt::format("vertex {} has no finite position", v));
    }
    start_[object_of(v)] += x0.col(v);
    drift_[object_of(v)] += x1.col(v) - x0.col(v);
  }
  for (size_t o = 0; o < count_.size(); ++o) drift_[o] /= std::max(count_[o], 1.0);
}

void MotionBoxes::make(const Matrix3Xd& x0, const Matrix3Xd& x1, double excess, Slack& chosen) {
  held_.clear();
  find_drift(x0, x1);
  double motion = 0;
  for (const int v : surface_->points) motion += (x1.col(v) - x0.col(v) - drift_[object_of(v)]).norm();
  motion /= std::max(1.0, static_cast<double>(surface_->points.size()));
  const double slack = chosen.next(*surface_, x0, motion, excess);
  reach_ = chosen.reach();
  still_ = true;
  for (Vector3d& drift : drift_) {
    if (drift.norm() <= kDrift * slack) drift.setZero();
    still_ = still_ && drift.isZero(0);
  }
  const auto count = static_cast<std::ptrdiff_t>(surface_->points.size());
  held_.resize(static_cast<size_t>(count));
  boxes_.resize(static_cast<size_t>(count));
  range_.resize(static_cast<size_t>(count));
  Array3d lowest = Array3d::Constant(std::numeric_limits<double>::infinity()), highest = -lowest;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const int v = surface_->points[static_cast<size_t>(i)];
    const Array3d drift = drift_[object_of(v)], a = x0.col(v), b = x1.col(v).array() - drift;
    // What the subtractions here and in hold() may round.
    const double size = a.abs().maxCoeff() + b.abs().maxCoeff() + 2 * drift.abs().maxCoeff();
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * size;
    const double r = half(reach_, v);
    const Array3d spare = r + slack + rounding + kSpare * (b - a).abs();
    Box& box = held_[static_cast<size_t>(i)];
    box.lower = a.min(b) - spare;
    box.upper = a.max(b) + spare;
    range_[static_cast<size_t>(i)] = r + (a - r - box.lower.array()).max(box.upper.array() - r - a).matrix().norm();
    lowest = lowest.min(box.lower.array() + drift.min(0));
    highest = highest.max(box.upper.array() + drift.max(0));
  }
  const double side = count > 0 ? (highest - lowest).maxCoeff() : 0;
  units_ = side > 0 ? kUnits / side : 0;
#pragma omp parallel for schedule(static) if (count > kSerial)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Box& box = held_[static_cast<size_t>(i)];
    IntegerBox& units = boxes_[static_cast<size_t>(i)];
    for (int k = 0; k < 3; ++k) {
      const auto at = static_cast<size_t>(k);
      units.lower[at] = static_cast<int>((box.lower[k] - lowest[k]) * units_) - 1;  // truncated, and what was rounded
      units.upper[at] = static_cast<int>((box.upper[k] - lowest[k]) * units_) + 2;
    }
  }
}

Shift MotionBoxes::in_units(const Vector3d& move) const {
  Shift shift;
  shift.length = move.norm();
  for (int k = 0; k < 3; ++k) {
    const auto at = static_cast<size_t>(k);
    if (move[k] < 0) shift.lower[at] = static_cast<int>(move[k] * units_) - 2;
    if (move[k] > 0) shift.upper[at] = static_cast<int>(move[k] * units_) + 2;
  }
  return shift;
}

Shift MotionBoxes::shift(int object_a, int object_b) const {
  return in_units(drift_[static_cast<size_t>(object_b)] - drift_[static_cast<size_t>(object_a)]);
}

Shift MotionBoxes::drift(int object) const { return in_units(drift_[static_cast<size_t>(object)]); }

}  // namespace ergon
