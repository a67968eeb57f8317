#include "runtime/contact/friction_secants.h"

#include <algorithm>
#include <cmath>

namespace ergon {

namespace {

constexpr double at_rest = 0.5;     // of eps: reversals of less are within the static force's own curvature
constexpr double small_step = 0.3;  // of the way slid: a step for which the slope serves as well as the secant

Eigen::Vector3d sum(const SlidingPoint& point, const Eigen::Matrix3Xd& x) {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  for (size_t p = 0; p < point.weight.size(); ++p) {
    if (point.weight[p] != 0) at += point.weight[p] * x.col(point.vertices[p]);
  }
  return at;
}

Eigen::Vector3d across(const Eigen::Vector3d& normal, const Eigen::Vector3d& v) { return v - normal * normal.dot(v); }

}  // namespace

FrictionSecants::FrictionSecants(System& system, const Kernel& law, int fewest, int most) : system_(&system) {
  if (!law.table) return;
  for (int points = fewest; points <= most; ++points) {
    groups_[static_cast<size_t>(points)].potential =
        system.add(Potential::on_combinations("contact_friction_secant", law, points, {}));
  }
}

void FrictionSecants::set(const std::vector<SlidingPoint>& points, double eps) {
  eps_ = eps;
  for (Group& group : groups_) group.points.clear();
  for (const SlidingPoint& point : points) {
    const auto vertices =
        point.weight.size() - static_cast<size_t>(std::count(point.weight.begin(), point.weight.end(), 0.0));
    if (groups_[vertices].potential >= 0) groups_[vertices].points.push_back(point);
  }
  std::vector<int> stencils;
  std::vector<double> weights;
  for (Group& group : groups_) {
    if (group.potential < 0) continue;
    group.held.assign(group.points.size(), 0);
    group.shown = false;
    stencils.clear();
    weights.clear();
    for (const SlidingPoint& point : group.points) {
      for (size_t p = 0; p < point.weight.size(); ++p) {
        if (point.weight[p] == 0) continue;
        stencils.push_back(point.vertices[p]);
        weights.push_back(point.weight[p]);
      }
    }
    Potential& potential = system_->potential(group.potential);
    potential.set_combinations(stencils, weights, {});
    if (group.points.empty()) continue;
    potential.set_lag("t", {1, 0, 0});
    potential.set_lag("xlag", {0, 0, 0});
    potential.set_lag("stiffness", {0});
  }
}

void FrictionSecants::begin_hessian(const Eigen::Matrix3Xd& x) {
  std::vector<double> direction, stiffness, position;
  for (Group& group : groups_) {
    group.shown = std::count(group.held.begin(), group.held.end(), 1) > 0;
    if (!group.shown) continue;
    direction.clear();
    stiffness.clear();
    position.clear();
    for (size_t i = 0; i < group.points.size(); ++i) {
      const SlidingPoint& point = group.points[i];
      const Eigen::Vector3d now = sum(point, x);
      Eigen::Vector3d way = across(point.normal, now - point.start);
      const double length = way.norm();
      const bool used = group.held[i] != 0 && length > 0;
      // With y = length/eps the static force is force*(2y - y^2): secant less slope is force/eps*y. Beyond, the slope
      // is zero or less.
      stiffness.push_back(used ? point.force / eps_ * std::min(length / eps_, eps_ / length) : 0);
      way = used ? Eigen::Vector3d(way / length) : Eigen::Vector3d::UnitX();
      direction.insert(direction.end(), way.begin(), way.end());
      position.insert(position.end(), now.begin(), now.end());
    }
    Potential& potential = system_->potential(group.potential);
    potential.set_lag("t", direction);
    potential.set_lag("xlag", position);
    potential.set_lag("stiffness", stiffness);
  }
}

void FrictionSecants::end_hessian() {
  for (Group& group : groups_) {
    if (group.shown) system_->potential(group.potential).set_lag("stiffness", {0});
    group.shown = false;
  }
}

void FrictionSecants::judge_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) {
  for (Group& group : groups_) {
    for (size_t i = 0; i < group.points.size(); ++i) {
      const SlidingPoint& point = group.points[i];
      const Eigen::Vector3d way = across(point.normal, sum(point, x) - point.start),
                            step = across(point.normal, sum(point, direction)), end = way + step;
      if (group.held[i] == 0)
        group.held[i] = way.dot(end) < 0 && way.norm() > at_rest * eps_ && end.norm() > at_rest * eps_;
      else if (step.norm() < small_step * way.norm())
        group.held[i] = 0;
    }
  }
}

int FrictionSecants::held() const {
  std::ptrdiff_t count = 0;
  for (const Group& group : groups_) count += std::count(group.held.begin(), group.held.end(), 1);
  return static_cast<int>(count);
}

bool FrictionSecants::owns(int potential) const {
  return potential >= 0 && std::any_of(groups_.begin(), groups_.end(),
                                       [potential](const Group& group) { return group.potential == potential; });
}

}  // namespace ergon
