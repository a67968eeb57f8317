#pragma once
// A barrier law as a function of the gap alone, read off its kernel between two points, so that contact knows the
// forces of any law without its formula.

#include <vector>

#include "runtime/potential.h"

namespace ergon {

struct BarrierAt {
  double value = 0;      // per unit of stiffness, J
  double slope = 0;      // N, negative where the barrier repels
  double curvature = 0;  // N/m
};

class BarrierProbe {
 public:
  // `point_point`: the law's kernel between two points, with the param dhat (m) and the lag kappa.
  BarrierProbe(Kernel point_point, double dhat) : kernel_(std::move(point_point)), dhat_(dhat) {}

  // At kappa = 1; zero at and beyond dhat.
  BarrierAt at(double gap) const;
  // Values and slopes only, one per gap.
  std::vector<BarrierAt> at(const std::vector<double>& gaps) const;

 private:
  Kernel kernel_;
  double dhat_;  // m
};

}  // namespace ergon
