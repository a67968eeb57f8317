#include "runtime/contact/pair_stiffness.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "runtime/error.h"

namespace ergon {

namespace {

constexpr double loaded_gap = 0.1;    // of dhat, where a barrier bears the forces that its stiffness is chosen for
constexpr double too_small = 0.05;    // of dhat: pairs that start a step so close get stiffer
constexpr double fastest_growth = 4;  // of a stiffness, from step to step
constexpr double worth_growing = 2;   // of a stiffness within a step: so often do energies before not compare
constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr double near = 1e-3, nearer = 1e-9;  // of dhat

// A logarithm's force grows a millionfold between these gaps.
bool grows_at_contact(const BarrierProbe& probe, double dhat) {
  return -probe.at(nearer * dhat).slope > 10 * -probe.at(near * dhat).slope;
}

}  // namespace

PairStiffness::PairStiffness(BarrierProbe probe, double dhat, int objects, double fixed)
    : probe_(std::move(probe)), dhat_(dhat), fixed_(fixed > 0), infinite_(grows_at_contact(probe_, dhat)) {
  if (fixed_ && !infinite_)
    throw InputError(fmt::format(
        "contact: the barrier's force at a gap of {:g} dhat is {:.3g} N per unit of its stiffness and does not "
        "grow towards contact, so that a fixed stiffness keeps nothing apart; leave 'stiffness' out, or use a barrier "
        "that is infinite there, as log_barrier",
        nearer, -probe_.at(nearer * dhat).slope));
  kappa_.setConstant(objects, objects, fixed);
  last_gap_.setConstant(objects, objects, infinity);
}

void PairStiffness::begin_step(const std::vector<SurfaceResistance>& resistance, double weight,
                               const Eigen::MatrixXd& gaps) {
  last_gap_.setConstant(infinity);
  if (fixed_) return;
  const bool open = needs_resistance();
  if (open) resistance_ = resistance;
  const auto lighter = [&](Eigen::Index a, Eigen::Index b) {
    return std::min(resistance_[static_cast<size_t>(a)].weight, resistance_[static_cast<size_t>(b)].weight);
  };
  const BarrierAt loaded = probe_.at(loaded_gap * dhat_);
  for (Eigen::Index a = 0; a < gaps.rows(); ++a) {
    for (Eigen::Index b = 0; b < gaps.cols(); ++b) {
      const double softer =
          std::min(resistance_[static_cast<size_t>(a)].hessian, resistance_[static_cast<size_t>(b)].hessian);
      if (!infinite_)
        kappa_(a, b) = of_finite(a, b, gaps(a, b));
      else if (open)
        kappa_(a, b) =
            std::max(softer < infinity ? softer / loaded.curvature : 0, weight / -loaded.slope) / lighter(a, b);
      // Where a barrier bears more than it was chosen for, its gap is small, and Newton's method slow: the way that a
      // point slides over the edges of another surface has kinks of the size of the gap.
      if (infinite_ && gaps(a, b) < too_small * dhat_)
        kappa_(a, b) *= std::clamp(probe_.at(gaps(a, b)).slope / loaded.slope, 1.0, fastest_growth);
    }
  }
}

double PairStiffness::of_finite(Eigen::Index a, Eigen::Index b, double gap) const {
  const SurfaceResistance &one = resistance_[static_cast<size_t>(a)], &other = resistance_[static_cast<size_t>(b)];
  const double hessian = std::min(one.hessian, other.hessian), inertia = std::min(one.inertia, other.inertia);
  if (!(hessian < infinity)) return 1;  // nothing moves
  const double ratio = dhat_ / std::min(gap, dhat_);
  return (hessian + inertia * (ratio * ratio - 1)) / std::min(one.weight, other.weight);
}

bool PairStiffness::adapt(const Eigen::MatrixXd& gaps, double resolved) {
  if (fixed_) return false;
  bool grew = false;
  for (Eigen::Index a = 0; a < gaps.rows(); ++a) {
    for (Eigen::Index b = 0; b < gaps.cols(); ++b) {
      const double gap = gaps(a, b), last = last_gap_(a, b), before = kappa_(a, b);
      last_gap_(a, b) = gap;
      if (!infinite_) {
        const double wanted = of_finite(a, b, gap);
        if (wanted > worth_growing * before) kappa_(a, b) = wanted;
      } else if (gap < resolved && gap < last && last < resolved) {
        kappa_(a, b) *= 2;
      }
      grew = grew || kappa_(a, b) != before;
    }
  }
  return grew;
}

}  // namespace ergon
