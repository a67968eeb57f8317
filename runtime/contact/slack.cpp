#include "runtime/contact/slack.h"

#include <algorithm>
#include <cmath>

namespace ergon {

namespace {

constexpr double kForget = 0.9;       // of a larger reach, per request
constexpr double kOfReach = 0.25;     // slack over reach while the factor is 1
constexpr double kOfMotion = 0.25;    // and over the mean motion
constexpr double kOfEdges = 0.25;     // at most, of the mean length of edges
constexpr long kFew = 8, kMany = 64;  // requests
constexpr double kChange = 1.5, kLeast = 0.25, kMost = 16;

}  // namespace

void Slack::ask(double reach) {
  reach_ = std::max(reach, kForget * reach_);
  ++requests_;
}

double Slack::next(const CollisionSurface& surface, const Eigen::Matrix3Xd& x, double motion) {
  if (!first_ && requests_ < kFew) factor_ = std::min(kMost, kChange * factor_);
  if (!first_ && requests_ > kMany) factor_ = std::max(kLeast, factor_ / kChange);
  requests_ = 0;
  first_ = false;
  motion_ = std::max(motion, kForget * motion_);
  double length = 0;
  for (const auto& [a, b] : surface.edges) length += (x.col(b) - x.col(a)).norm();
  if (!surface.edges.empty()) length /= static_cast<double>(surface.edges.size());
  const double most = std::max(kOfEdges * length, kOfReach * reach_);
  return std::min(factor_ * (kOfReach * reach_ + kOfMotion * motion_), most);
}

}  // namespace ergon
