#include "runtime/contact/barrier_probe.h"

#include <string_view>

#include "runtime/system.h"

namespace ergon {

namespace {

// One pair of points per gap, on the x axis.
System points_apart(const Kernel& kernel, double dhat, const std::vector<double>& gaps, Eigen::Matrix3Xd& x) {
  std::vector<int> stencils;
  std::vector<size_t> inside;
  x.resize(3, 2 * static_cast<int>(gaps.size()));
  for (size_t i = 0; i < gaps.size(); ++i) {
    const int p = 2 * static_cast<int>(i);
    x.col(p) = Eigen::Vector3d(gaps[i], 0, 0);
    x.col(p + 1).setZero();
    if (gaps[i] < dhat) stencils.insert(stencils.end(), {p, p + 1});
  }
  System system(static_cast<int>(x.cols()));
  StencilData rest;
  for (int i = 0; i < kernel->n_inputs; ++i) {
    if (kernel->inputs[i].role == ERGON_REST) rest[kernel->inputs[i].name].assign(stencils.size() / 2, 0.0);
  }
  Potential potential = Potential::on_used_points("barrier", kernel, stencils, x, {{"dhat", {dhat}}}, rest);
  for (int i = 0; i < kernel->n_inputs; ++i) {
    if (kernel->inputs[i].role != ERGON_LAG) continue;
    const std::string_view lag = kernel->inputs[i].name;
    potential.set_lag(std::string(lag), {lag == "kappa" ? 1.0 : 0.0});
  }
  system.add(std::move(potential));
  return system;
}

}  // namespace

BarrierAt BarrierProbe::at(double gap) const {
  if (!(gap < dhat_)) return {};
  Eigen::Matrix3Xd x, gradient;
  System system = points_apart(kernel_, dhat_, {gap}, x);
  BlockMatrix matrix;
  BarrierAt out;
  out.value = system.hessian(x, Projection::none, gradient, matrix).value;
  out.slope = gradient(0, 0);
  out.curvature = matrix.values().front();
  return out;
}

std::vector<BarrierAt> BarrierProbe::at(const std::vector<double>& gaps) const {
  std::vector<BarrierAt> out(gaps.size());
  if (gaps.empty()) return out;
  Eigen::Matrix3Xd x, gradient;
  System system = points_apart(kernel_, dhat_, gaps, x);
  system.gradient(x, gradient);
  for (size_t i = 0; i < gaps.size(); ++i) out[i].slope = gradient(0, 2 * static_cast<int>(i));
  return out;
}

}  // namespace ergon
