#include "codegen/intervals.h"

#include <algorithm>
#include <cmath>

namespace ergon {
namespace {

constexpr double kInfinity = __builtin_inf();

// 0*infinity is 0: an end at infinity is never reached.
double times(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }

Interval multiply(const Interval& a, const Interval& b) {
  const double ends[] = {times(a.low, b.low), times(a.low, b.high), times(a.high, b.low), times(a.high, b.high)};
  return {*std::min_element(ends, ends + 4), *std::max_element(ends, ends + 4)};
}

Interval reciprocal(const Interval& a) {
  if (a.low < 0 && a.high > 0) return {};
  return {a.high == 0 ? -kInfinity : 1 / a.high, a.low == 0 ? kInfinity : 1 / a.low};
}

Interval power(const Interval& base, int num, int den) {
  if (num < 0) return reciprocal(power(base, -num, den));
  const auto raised = [&](double x) { return std::pow(x, static_cast<double>(num) / den); };
  // A root asks for a base that is not negative.
  if (den > 1) return {raised(std::max(base.low, 0.0)), raised(std::max(base.high, 0.0))};
  if (num % 2 != 0 || base.low >= 0) return {raised(base.low), raised(base.high)};
  const double ends[] = {raised(base.low), raised(base.high)};
  const double low = base.high <= 0 ? ends[1] : 0;
  return {low, std::max(ends[0], ends[1])};
}

Interval of_input(const Module& module, const Node& n) {
  if (n.source != Source::param && n.source != Source::raw) return {};
  const Energy& energy = *module.energy;
  for (size_t i = 0; i < energy.symbols.size(); ++i) {
    const Symbol& s = energy.symbols[i];
    const bool matches = s.role != Role::dof && (s.role == Role::param) == (n.source == Source::param);
    const int first = module.offsets[i];
    if (matches && n.index >= first && n.index < first + s.shape.size()) return {s.range.lower, s.range.upper};
  }
  return {};
}

Interval of_call(const Node& n, const std::vector<Interval>& known) {
  const auto argument = [&](size_t k) { return known[static_cast<size_t>(n.arguments[k])]; };
  switch (n.call) {
    case Call::exp:
      return {std::exp(argument(0).low), std::exp(argument(0).high)};
    case Call::sin:
    case Call::cos:
      return {-1, 1};
    case Call::abs: {
      const Interval a = argument(0);
      const double least = a.low > 0 ? a.low : a.high < 0 ? -a.high : 0;
      return {least, std::max(std::abs(a.low), std::abs(a.high))};
    }
    case Call::min:
      return {std::min(argument(0).low, argument(1).low), std::min(argument(0).high, argument(1).high)};
    case Call::max:
      return {std::max(argument(0).low, argument(1).low), std::max(argument(0).high, argument(1).high)};
    case Call::select:
      return {std::min(argument(1).low, argument(2).low), std::max(argument(1).high, argument(2).high)};
    case Call::keep:
      return argument(0);
    default:
      return {};
  }
}

}  // namespace

std::vector<Interval> find_intervals(const Module& module) {
  const Graph& g = module.graph;
  std::vector<Interval> known;
  for (NodeId id = 0; id < g.size(); ++id) {
    const Node& n = g[id];
    const auto of = [&](NodeId operand) { return known[static_cast<size_t>(operand)]; };
    Interval found;
    switch (n.kind) {
      case Node::Kind::constant:
        found = {n.constant, n.constant};
        break;
      case Node::Kind::input:
        found = of_input(module, n);
        break;
      case Node::Kind::sum:
        found = {n.constant, n.constant};
        for (const Term& t : n.terms) {
          const Interval term = multiply({t.coefficient, t.coefficient}, of(t.node));
          found = {found.low + term.low, found.high + term.high};
        }
        break;
      case Node::Kind::product:
        found = {1, 1};
        for (const Factor& f : n.factors) found = multiply(found, power(of(f.base), f.num, f.den));
        break;
      case Node::Kind::call:
        found = of_call(n, known);
        break;
    }
    known.push_back(found);
  }
  return known;
}

}  // namespace ergon
