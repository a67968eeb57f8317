#include "runtime/contact/surface_friction.h"

#include <algorithm>

namespace ergon {

namespace {

// Lags of the pairs with one number of points.
struct Lags {
  std::vector<int> stencils;
  std::vector<double> weights, normal, at_rest, sliding, force, start;
};

void append(const RubbingPair& pair, const Eigen::Vector3d& start, Lags& lags) {
  for (size_t p = 0; p < 4; ++p) {
    if (pair.frame.weight[p] == 0) continue;
    lags.stencils.push_back(pair.vertices[p]);
    lags.weights.push_back(pair.frame.weight[p]);
  }
  const Eigen::Vector3d& n = pair.frame.normal;
  lags.normal.insert(lags.normal.end(), n.begin(), n.end());
  lags.start.insert(lags.start.end(), start.begin(), start.end());
  lags.at_rest.push_back(pair.coefficients.at_rest);
  lags.sliding.push_back(pair.coefficients.sliding);
  lags.force.push_back(pair.force);
}

Eigen::Vector3d start_of(const RubbingPair& pair, const Eigen::Matrix3Xd& xlag) {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  for (size_t p = 0; p < 4; ++p) {
    if (pair.frame.weight[p] != 0) start += pair.frame.weight[p] * xlag.col(pair.vertices[p]);
  }
  return start;
}

}  // namespace

SurfaceFriction::SurfaceFriction(System& system, const Kernel& law, const Kernel& secant, double epsv, double fall)
    : system_(&system), epsv_(epsv), secants_(system, secant, fewest, most) {
  potential_.fill(-1);
  for (int points = fewest; points <= most; ++points) {
    potential_[static_cast<size_t>(points)] =
        system.add(Potential::on_combinations("contact_friction", law, points, {{"epsv", {epsv}}, {"fall", {fall}}}));
  }
}

FrictionChange SurfaceFriction::lag(const std::vector<RubbingPair>& pairs, const Eigen::Matrix3Xd& xlag, double dt) {
  std::array<Lags, most + 1> all;
  std::vector<SlidingPoint> sliding;
  Eigen::Matrix3Xd force = Eigen::Matrix3Xd::Zero(3, xlag.cols());
  count_ = 0;
  for (const RubbingPair& pair : pairs) {
    const auto points = 4 - std::count(pair.frame.weight.begin(), pair.frame.weight.end(), 0.0);
    const Eigen::Vector3d start = start_of(pair, xlag);
    append(pair, start, all[static_cast<size_t>(points)]);
    const double coefficient = std::max(pair.coefficients.at_rest, pair.coefficients.sliding);
    sliding.push_back({pair.vertices, pair.frame.weight, pair.frame.normal, start, coefficient * pair.force});
    for (size_t p = 0; p < 4; ++p) {
      if (pair.frame.weight[p] == 0) continue;
      force.col(pair.vertices[p]) += pair.frame.weight[p] * pair.force * pair.frame.normal;
    }
    ++count_;
  }
  for (int points = fewest; points <= most; ++points) {
    const Lags& lags = all[static_cast<size_t>(points)];
    Potential& potential = system_->potential(potential_[static_cast<size_t>(points)]);
    potential.set_combinations(lags.stencils, lags.weights, {});
    if (lags.force.empty()) continue;
    potential.set_lag("n", lags.normal);
    potential.set_lag("mu_static", lags.at_rest);
    potential.set_lag("mu_kinetic", lags.sliding);
    potential.set_lag("force", lags.force);
    potential.set_lag("xlag", lags.start);
    potential.set_lag("dt", {dt});
  }
  secants_.set(sliding, epsv_ * dt);
  FrictionChange result;
  if (force_.cols() != force.cols()) force_.setZero(3, force.cols());
  result.change = (force - force_).colwise().norm().sum();
  result.sum = force.colwise().norm().sum();
  force_ = force;
  return result;
}

bool SurfaceFriction::owns(int potential) const {
  return secants_.owns(potential) || std::find(potential_.begin(), potential_.end(), potential) != potential_.end();
}

}  // namespace ergon
