#include "runtime/contact/motion_boxes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/error.h"

namespace ergon {

namespace {

constexpr double kUnits = 1 << 29;  // along the longest side of all boxes: sums of two stay within an int
constexpr double kSpare = 0.25;     // of a point's motion, beyond its slack

}  // namespace

MotionBoxes::MotionBoxes(const CollisionSurface& surface) : surface_(&surface), number_(surface.object.size(), -1) {
  for (size_t i = 0; i < surface.points.size(); ++i) {
    number_[static_cast<size_t>(surface.points[i])] = static_cast<int>(i);
  }
}

double MotionBoxes::half(double reach, int vertex) const {
  return reach / 2 + surface_->radius[static_cast<size_t>(surface_->object[static_cast<size_t>(vertex)])];
}

bool MotionBoxes::hold(const Eigen::Matrix3Xd& x0, const Eigen::Matrix3Xd& x1, double reach) const {
  if (held_.empty()) return false;
  const auto count = static_cast<std::ptrdiff_t>(held_.size());
  bool all = true;
#pragma omp parallel for schedule(static) reduction(&& : all)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    if (!all) continue;
    const int v = surface_->points[static_cast<size_t>(i)];
    const Box& box = held_[static_cast<size_t>(i)];
    const double r = half(reach, v);
    const double *a = x0.data() + 3 * static_cast<std::ptrdiff_t>(v),
                 *b = x1.data() + 3 * static_cast<std::ptrdiff_t>(v);
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
      inside = inside & (std::min(a[k], b[k]) - r >= box.lower[k]) & (std::max(a[k], b[k]) + r <= box.upper[k]);
    }
    all = all && inside;
  }
  return all;
}

void MotionBoxes::make(const Eigen::Matrix3Xd& x0, const Eigen::Matrix3Xd& x1, double reach, double slack) {
  const auto count = static_cast<std::ptrdiff_t>(surface_->points.size());
  held_.resize(static_cast<size_t>(count));
  boxes_.resize(static_cast<size_t>(count));
  if (count == 0) return;
  Eigen::Array3d lowest = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity()), highest = -lowest;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const int v = surface_->points[static_cast<size_t>(i)];
    const Eigen::Vector3d a = x0.col(v), b = x1.col(v);
    if (!a.allFinite() || !b.allFinite()) {
      held_.clear();
      throw InputError(fmt::format("vertex {} has no finite position", v));
    }
    const Eigen::Array3d move = (b - a).array().abs();
    // What the subtractions here and in hold may round.
    const double rounding =
        4 * std::numeric_limits<double>::epsilon() * std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
    const Eigen::Array3d spare = half(reach, v) + slack + rounding + kSpare * move;
    Box& box = held_[static_cast<size_t>(i)];
    box.lower = a.array().min(b.array()) - spare;
    box.upper = a.array().max(b.array()) + spare;
    lowest = lowest.min(box.lower.array());
    highest = highest.max(box.upper.array());
  }
  const double side = (highest - lowest).maxCoeff(), scale = side > 0 ? kUnits / side : 0;
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Box& box = held_[static_cast<size_t>(i)];
    IntegerBox& units = boxes_[static_cast<size_t>(i)];
    for (int k = 0; k < 3; ++k) {
      const auto at = static_cast<size_t>(k);
      units.lower[at] = static_cast<int>((box.lower[k] - lowest[k]) * scale) - 1;  // truncated, and what was rounded
      units.upper[at] = static_cast<int>((box.upper[k] - lowest[k]) * scale) + 2;
    }
  }
}

}  // namespace ergon
