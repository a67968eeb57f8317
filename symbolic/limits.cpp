#include "symbolic/limits.h"

#include <cln/dfloat.h>

#include <algorithm>
#include <cmath>

#include "symbolic/elaborate.h"
#include "symbolic/stretches.h"

namespace ergon {
namespace {

constexpr double smallest_jump =
    1e-6;  // relative to what jumps: below it lies the smoothing of a kink by a small number

struct Side {
  bool allowed = false;  // within ranges, and conditions hold
  bool defined = false;
  std::vector<double> parts[3];  // value, gradient, Hessian
  double margin = 0;             // of the boundary that is asked for
};

bool within(const Range& range, const Rational& x) {
  if (std::isfinite(range.lower)) {
    const Rational lower = cln::rational(cln::cl_DF(range.lower));
    if (range.lower_open ? x <= lower : x < lower) return false;
  }
  if (std::isfinite(range.upper)) {
    const Rational upper = cln::rational(cln::cl_DF(range.upper));
    if (range.upper_open ? x >= upper : x > upper) return false;
  }
  return true;
}

bool within_ranges(const Energy& energy, const ExactInputs& inputs) {
  for (const Symbol& symbol : energy.symbols)
    for (const Rational& x : inputs.at(symbol.name))
      if (symbol.role != Role::dof && !within(symbol.range, x)) return false;
  return true;
}

void collect(const std::vector<ClnNumber>& from, Side& side, int part) {
  for (const ClnNumber& x : from) {
    side.defined = side.defined && x.defined;
    side.parts[part].push_back(to_double(x));
  }
}

using Variables = JetAlgebra<ClnAlgebra>::Variables;

Side side_at(const Energy& energy, const std::string& case_name, const ExactInputs& inputs,
             Variables variables = Variables::dofs, const CriticalTarget* boundary = nullptr) {
  Side side;
  if (!within_ranges(energy, inputs)) return side;
  ClnAlgebra numbers(inputs, digits_for_derivatives(energy, critical_digits));
  JetAlgebra<ClnAlgebra> jets(energy, numbers, JetAlgebra<ClnAlgebra>::Order::second, variables);
  const Elaborated<Jet<ClnNumber>> result = elaborate(energy, case_name, jets);
  side.allowed = true;
  for (const auto* margins : {&result.active, &result.require}) {
    for (const Jet<ClnNumber>& margin : *margins)
      side.allowed = side.allowed && margin.value.defined && cln::plusp(margin.value.value);
  }
  if (boundary != nullptr) {
    const auto& margins = boundary->kind == CriticalTarget::Kind::active ? result.active : result.require;
    side.margin = to_double(margins[boundary->condition].value);
  }
  side.defined = true;
  collect({result.value.value}, side, 0);
  collect(result.value.gradient, side, 1);
  collect(result.value.hessian, side, 2);
  return side;
}

ExactInputs moved(const Energy& energy, ExactInputs inputs, const std::vector<Rational>& direction, bool dofs,
                  const Rational& by) {
  size_t k = 0;
  for (const Symbol& symbol : energy.symbols)
    for (Rational& x : inputs.at(symbol.name))
      if ((symbol.role == Role::dof) == dofs) x = x + by * direction[k++];
  return inputs;
}

std::vector<Rational> random_direction(const Energy& energy, bool dofs, StateSampler& sampler) {
  std::vector<Rational> direction;
  for (const Symbol& symbol : energy.symbols)
    for (int i = 0; i < symbol.shape.size(); ++i)
      if ((symbol.role == Role::dof) == dofs) direction.push_back(sampler.fraction(16, 16) + Rational(1) / 64);
  return direction;
}

size_t largest(const std::vector<double>& x) {
  size_t at = 0;
  for (size_t i = 1; i < x.size(); ++i)
    if (std::fabs(x[i]) > std::fabs(x[at])) at = i;
  return at;
}

double size_of(const std::vector<double>& x) { return x.empty() ? 0 : std::fabs(x[largest(x)]); }

std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> r(std::max(a.size(), b.size()), 0.0);
  for (size_t i = 0; i < r.size(); ++i) r[i] = (i < b.size() ? b[i] : 0) - (i < a.size() ? a[i] : 0);
  return r;
}

bool grows(double far, double near) { return near > 1.5 * far && near > 0; }

// far[0], near[0] on one side and far[1], near[1] on the other.
Limit compare(const Side (&far)[2], const Side (&near)[2], const ExactInputs (&states)[2]) {
  constexpr Effect growth[] = {Effect::value_grows, Effect::gradient_grows, Effect::curvature_grows};
  constexpr Effect jump[] = {Effect::value_jumps, Effect::gradient_jumps, Effect::curvature_jumps};
  const bool use[] = {far[0].allowed && near[0].allowed, far[1].allowed && near[1].allowed};
  for (int s = 0; s < 2; ++s)
    if (use[s] && !(far[s].defined && near[s].defined)) return {Effect::undefined, 0, 0, 0, states[s]};
  for (int part = 0; part < 3; ++part) {
    for (int s = 0; s < 2; ++s) {
      const auto &a = far[s].parts[part], &b = near[s].parts[part];
      if (!use[s] || !grows(size_of(a), size_of(b))) continue;
      const size_t i = largest(b);
      return {growth[part], i, i < a.size() ? a[i] : 0, b[i], states[s]};
    }
    if (!use[0] || !use[1]) continue;
    const auto jump_near = difference(near[0].parts[part], near[1].parts[part]);
    const double scale = std::max(size_of(near[0].parts[part]), size_of(near[1].parts[part]));
    const double remains = size_of(difference(far[0].parts[part], far[1].parts[part]));
    if (!(size_of(jump_near) > smallest_jump * scale) || !(size_of(jump_near) > 0.5 * remains)) continue;
    const size_t i = largest(jump_near);
    auto at = [&](int s) { return i < near[s].parts[part].size() ? near[s].parts[part][i] : 0; };
    return {jump[part], i, at(0), at(1), states[1]};
  }
  return {};
}

Rational power_of_ten(int exponent) { return cln::expt(Rational(10), cln::cl_I(exponent)); }

}  // namespace

Limit limit_at(const Energy& energy, const std::string& case_name, const ExactInputs& state, bool dofs) {
  StateSampler sampler;
  Limit worst;
  for (int i = 0; i < 2; ++i) {
    const std::vector<Rational> direction = random_direction(energy, dofs, sampler);
    Limit found;
    // Values alone cost a tenth, and where they jump or grow nobody asks for more.
    for (const Variables variables : {Variables::none, Variables::dofs}) {
      Side far[2], near[2];
      ExactInputs states[2];
      for (int s = 0; s < 2; ++s) {
        const Rational sign(s == 0 ? -1 : 1);
        states[s] = moved(energy, state, direction, dofs, sign * power_of_ten(-12));
        far[s] = side_at(energy, case_name, states[s], variables);
        near[s] =
            side_at(energy, case_name, moved(energy, state, direction, dofs, sign * power_of_ten(-26)), variables);
      }
      found = compare(far, near, states);
      if (found.effect != Effect::none) break;
    }
    if (found.effect > worst.effect) worst = std::move(found);
  }
  return worst;
}

Limit limit_at_boundary(const Energy& energy, const std::string& case_name, const ExactInputs& state,
                        const CriticalTarget& boundary) {
  StateSampler sampler;
  const bool active = boundary.kind == CriticalTarget::Kind::active;
  constexpr Effect effects[] = {Effect::value_jumps, Effect::gradient_jumps, Effect::curvature_jumps};
  for (int i = 0; i < 4; ++i) {
    const std::vector<Rational> direction = random_direction(energy, true, sampler);
    const Rational sign(i % 2 == 0 ? 1 : -1);
    const ExactInputs nearby = moved(energy, state, direction, true, sign * power_of_ten(-12));
    const Side far = side_at(energy, case_name, nearby, Variables::dofs, &boundary);
    if (!far.allowed || !(far.margin > 0)) continue;
    const Side near = side_at(energy, case_name, moved(energy, state, direction, true, sign * power_of_ten(-26)),
                              Variables::dofs, &boundary);
    if (!near.allowed || !near.defined || !far.defined) continue;
    if (!active) {
      const double value = near.parts[0][0];
      if (value < 0 && grows(std::fabs(far.parts[0][0]), std::fabs(value)))
        return {Effect::value_grows, 0, value, value, nearby};
      continue;
    }
    for (int part = 0; part < 3; ++part) {
      const double size = size_of(near.parts[part]);
      if (!(size > 0.5 * size_of(far.parts[part])) || !(size > 0)) continue;
      const size_t k = largest(near.parts[part]);
      return {effects[part], k, 0, near.parts[part][k], nearby};
    }
  }
  return {};
}

}  // namespace ergon
