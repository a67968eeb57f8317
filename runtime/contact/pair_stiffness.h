#pragma once
// How stiff the barrier between each pair of objects is: chosen from what the surfaces resist with, and changed only
// between solves or by steps that grow. It establishes one stiffness per pair, so that the energy stays continuous
// where the nearest parts of two surfaces change.

#include <Eigen/Core>
#include <vector>

#include "runtime/contact/barrier_probe.h"

namespace ergon {

// What a surface resists the motion of one of its vertices with, means over those that move, N/m: the diagonal of the
// system's Hessian, and of this the mass over dt^2. +inf where no vertex moves. Where stencils have weights (areas), a
// stiffness is per unit of these.
struct SurfaceResistance {
  double hessian = 0;
  double inertia = 0;
  double weight = 1;  // mean, of the stencils that its points make
};

class PairStiffness {
 public:
  // fixed: in the unit of the barrier's kappa; 0: chosen. Throws InputError for a fixed one of a barrier whose force at
  // contact is finite, since such a barrier keeps nothing apart.
  PairStiffness(BarrierProbe probe, double dhat, int objects, double fixed);

  bool fixed() const { return fixed_; }
  // Whether begin_step needs to be told the resistance.
  bool needs_resistance() const { return !fixed_ && (!infinite_ || !(kappa_(0, 0) > 0)); }
  const Eigen::MatrixXd& values() const { return kappa_; }  // per pair of objects, symmetric
  double operator()(int a, int b) const { return kappa_(a, b); }

  // Before a step that starts with these smallest gaps (m; per pair, symmetric, +inf without any). weight: N, of all
  // that moves. A barrier that is infinite at contact gets, once, the larger of two: that at which it is, at a tenth of
  // dhat, as stiff as the softer surface; and that at which one stencil bears the weight there. Pairs that come to rest
  // much closer get stiffer from step to step.
  // A barrier that is finite there gets, anew for each step, the softer surface's resistance with its inertia times
  // (dhat/gap)^2: Ando 2024, A Cubic Barrier with Elasticity-Inclusive Dynamic Stiffness, TOG 43(6), Eq. 4, with
  // dhat/dt as unit of speed.
  void begin_step(const std::vector<SurfaceResistance>& resistance, double weight, const Eigen::MatrixXd& gaps);

  // After an iterate with these smallest gaps, of which those below `resolved` (m) are near rounding. True when a
  // stiffness grew.
  bool adapt(const Eigen::MatrixXd& gaps, double resolved);

 private:
  double of_finite(Eigen::Index a, Eigen::Index b, double gap) const;

  BarrierProbe probe_;
  double dhat_;
  bool fixed_, infinite_;
  std::vector<SurfaceResistance> resistance_;
  Eigen::MatrixXd kappa_;
  Eigen::MatrixXd last_gap_;  // m, smallest at the last adapt
};

}  // namespace ergon
