#include "runtime/solver/constraints.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "runtime/error.h"
#include "runtime/solver/lags.h"

namespace ergon {
namespace {

constexpr const char* shift_name = "constraint_shift";
constexpr const char* hardening_name = "constraint_hardening";
constexpr double enough = 0.25;  // to which c has to fall from solve to solve
constexpr double harder = 10;    // by what it is multiplied where it did not

size_t sites_of(const Potential& potential) {
  return static_cast<size_t>(potential.stencil_count()) * static_cast<size_t>(potential.quadrature_points());
}

size_t components_of(const Potential& potential) {
  const ErgonKernel& kernel = potential.kernel();
  for (int i = 0; i < kernel.n_inputs; ++i)
    if (std::string_view(kernel.inputs[i].name) == shift_name)
      return static_cast<size_t>(kernel.inputs[i].rows * kernel.inputs[i].cols);
  return 0;
}

// c of every stencil, components adjacent.
std::vector<double> values_of(const Potential& potential, const StencilData& lags, const Eigen::Matrix3Xd& x) {
  std::vector<double> c = potential.renewed(x).at(shift_name);
  const std::vector<double>& shift = lags.at(shift_name);
  for (size_t i = 0; i < c.size(); ++i) c[i] -= shift[i];
  return c;
}

std::vector<double> sizes_of(const std::vector<double>& c, size_t sites) {
  const size_t components = c.size() / std::max<size_t>(sites, 1);
  std::vector<double> out(sites, 0.0);
  for (size_t i = 0; i < c.size(); ++i) out[i / components] = std::hypot(out[i / components], c[i]);
  return out;
}

}  // namespace

Constraints::Constraints(System& system, std::vector<Constraint> constraints) {
  for (Constraint& one : constraints) {
    const Potential& potential = system.potential(one.potential);
    if (!(one.tolerance > 0) || !std::isfinite(one.tolerance))
      throw InputError(fmt::format("the tolerance of the constraint of {} is {:g} {}; it must be above 0",
                                   potential.name(), one.tolerance, one.unit));
    if (!has_lag(potential.kernel(), shift_name))
      throw InputError(fmt::format(
          "{} has no constraint that could be kept to a tolerance: its energy is not augmented", potential.name()));
    all_.push_back({std::move(one), {}, {}});
  }
}

void Constraints::start(System& system, const std::vector<StencilData>& internal) {
  for (Kept& kept : all_) {
    const Potential& potential = system.potential(kept.constraint.potential);
    const size_t sites = sites_of(potential);
    kept.size.clear();
    if (internal.empty()) {
      kept.lags[shift_name].assign(sites * components_of(potential), 0.0);
      kept.lags[hardening_name].assign(sites, 0.0);
      continue;
    }
    const StencilData& known = internal.at(static_cast<size_t>(kept.constraint.potential));
    for (const char* name : {shift_name, hardening_name}) kept.lags[name] = known.at(name);
  }
}

Violation Constraints::violation(System& system, const Eigen::Matrix3Xd& x) const {
  Violation worst;
  for (size_t k = 0; k < all_.size(); ++k) {
    const Kept& kept = all_[k];
    const Potential& potential = system.potential(kept.constraint.potential);
    const std::vector<double> sizes = sizes_of(values_of(potential, kept.lags, x), sites_of(potential));
    for (size_t i = 0; i < sizes.size(); ++i) {
      const double excess = sizes[i] / kept.constraint.tolerance;
      if (excess <= worst.excess) continue;
      const size_t stencil = i / static_cast<size_t>(potential.quadrature_points());
      worst = {static_cast<int>(k), static_cast<int>(stencil), sizes[i], excess};
    }
  }
  return worst;
}

double Constraints::tighten(System& system, const Eigen::Matrix3Xd& x) {
  const PotentialValues before = system.value(x).by_potential;
  for (Kept& kept : all_) {
    Potential& potential = system.potential(kept.constraint.potential);
    const std::vector<double> c = values_of(potential, kept.lags, x);
    const std::vector<double> sizes = sizes_of(c, sites_of(potential));
    std::vector<double>& shift = kept.lags[shift_name];
    std::vector<double>& hardening = kept.lags[hardening_name];
    const size_t components = components_of(potential);
    for (size_t i = 0; i < sizes.size(); ++i) {
      const bool slow = !kept.size.empty() && sizes[i] > kept.constraint.tolerance && sizes[i] > enough * kept.size[i];
      if (slow) hardening[i] = harder * (1 + hardening[i]) - 1;
      for (size_t k = i * components; k < (i + 1) * components; ++k) shift[k] = (shift[k] + c[k]) / (slow ? harder : 1);
    }
    kept.size = sizes;
    for (const auto& [name, values] : kept.lags) potential.set_lag(name, values);
  }
  const PotentialValues after = system.value(x).by_potential;
  double change = 0;
  for (const Kept& kept : all_) {
    const auto at = static_cast<size_t>(kept.constraint.potential);
    change += after[at] - before[at];
  }
  return change;
}

void Constraints::keep(int potential, StencilData& internal) const {
  for (const Kept& kept : all_) {
    if (kept.constraint.potential != potential) continue;
    for (const auto& [name, values] : kept.lags) internal[name] = values;
  }
}

std::string Constraints::describe(System& system, const Violation& violation) const {
  const Constraint& constraint = all_[static_cast<size_t>(violation.constraint)].constraint;
  const Potential& potential = system.potential(constraint.potential);
  const auto points = static_cast<size_t>(potential.points_per_stencil());
  const int* first = potential.stencils().data() + static_cast<size_t>(violation.stencil) * points;
  const std::string unit = constraint.unit.empty() || constraint.unit == "1" ? "" : " " + constraint.unit;
  return fmt::format(
      "the constraint of {} in stencil {} (vert{} {}) is off by {:.3g}{}, above its tolerance of {:.3g}{}",
      potential.name(), violation.stencil, points == 1 ? "ex" : "ices", fmt::join(first, first + points, ", "),
      violation.value, unit, constraint.tolerance, unit);
}

}  // namespace ergon
