#include "runtime/contact/slack.h"

#include <algorithm>
#include <cmath>

namespace ergon {

namespace {

constexpr double kForget = 0.9;       // of a larger reach, per request
constexpr double kOfReach = 0.1;      // slack over reach while the factor is 1
constexpr double kOfMotion = 0.1;     // and over the mean motion
constexpr double kOfEdges = 0.1;      // at most, of the mean length of edges
constexpr long kFew = 8, kMany = 64;  // requests
constexpr double kChange = 1.5, kLeast = 0.25, kMost = 4;

}  // namespace

void Slack::ask(double reach) {
  reach_ = std::max(reach, kForget * reach_);
  ++requests_;
}

double Slack::next(const CollisionSurface& surface, const Eigen::Matrix3Xd& x, double motion, double excess) {
  const bool near = excess <= slack_;
  if (near && requests_ < kFew) factor_ = std::min(kMost, kChange * factor_);
  if ((near && requests_ > kMany) || (!near && factor_ > 1)) factor_ = std::max(kLeast, factor_ / kChange);
  requests_ = 0;
  motion_ = std::max(motion, kForget * motion_);
  double length = 0;
  for (const auto& [a, b] : surface.edges) length += (x.col(b) - x.col(a)).norm();
  if (!surface.edges.empty()) length /= static_cast<double>(surface.edges.size());
  slack_ = std::min(factor_ * (kOfReach * reach_ + kOfMotion * motion_), kOfEdges * length + kOfReach * reach_);
  return slack_;
}

}  // namespace ergon
