#include "runtime/solver/line_search.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include "runtime/solver/stopwatch.h"

namespace ergon {

namespace {

// A trial whose slope has fallen to this part of the first one has come near the minimum along the line.
constexpr double approximate_wolfe = 0.8;

double free_dot(const System& system, const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b) {
  double sum = 0;
  for (int v = 0; v < system.vertices(); ++v) {
    if (system.block_of(v) >= 0) sum += a.col(v).dot(b.col(v));
  }
  return sum;
}

}  // namespace

std::string unusable(System& system, const Evaluation& evaluation) {
  if (evaluation.require <= 0) return "the domain of " + evaluation.violated;
  if (std::isfinite(evaluation.value)) return "";
  for (size_t i = 0; i < evaluation.by_potential.size(); ++i) {
    if (!std::isfinite(evaluation.by_potential[i])) {
      return "a finite energy of " + system.potential(static_cast<int>(i)).name();
    }
  }
  return "a finite energy";
}

Rounding measure_rounding(System& system, const Eigen::Matrix3Xd& x, const Evaluation& at_x,
                          const Eigen::Matrix3Xd& gradient) {
  Eigen::Matrix3Xd moved = x;
  std::uint32_t random = 1;
  for (int v = 0; v < system.vertices(); ++v) {
    if (system.block_of(v) < 0) continue;
    for (int c = 0; c < 3; ++c) {
      random = 1664525 * random + 1013904223;  // Numerical Recipes' generator: which way to move
      moved(c, v) *= 1 + (random >> 31 ? 4 : -4) * std::numeric_limits<double>::epsilon();
    }
  }
  Eigen::Matrix3Xd moved_gradient(3, x.cols());
  const Evaluation at_moved = system.gradient(moved, moved_gradient);
  double magnitude = 0;
  for (double value : at_x.by_potential) magnitude += std::abs(value);
  Rounding rounding;
  rounding.energy = 8 * std::abs(at_moved.value - at_x.value - free_dot(system, gradient, moved - x)) +
                    8 * std::numeric_limits<double>::epsilon() * magnitude;
  for (int v = 0; v < system.vertices(); ++v) {
    if (system.block_of(v) < 0) continue;
    rounding.gradient = std::max(rounding.gradient, (moved_gradient.col(v) - gradient.col(v)).cwiseAbs().maxCoeff());
  }
  return rounding;
}

void line_search(System& system, Contact* contact, const LineSearchInput& input, LineSearchResult& result,
                 double& contact_seconds) {
  result.found = result.at_rounding = false;
  result.fraction = input.first_fraction;
  result.halvings = 0;
  bool measured = false;
  Rounding rounding;
  while (true) {
    result.x = input.x + result.fraction * input.direction;
    if (contact) {
      const Stopwatch watch(contact_seconds);
      contact->set_active(result.x);
    }
    result.evaluation = system.gradient(result.x, result.gradient);
    const double predicted = result.fraction * input.slope;
    result.rejected_by = unusable(system, result.evaluation);
    if (result.rejected_by.empty()) {
      result.rejected_by = "the energy, which does not fall";
      const double change = result.evaluation.value - input.at_x.value;
      if (change <= input.sufficient_decrease * predicted) {
        result.found = true;
        return;
      }
      if (input.near_limit) {
        if (!measured) {
          if (contact) contact->set_active(input.x);
          rounding = measure_rounding(system, input.x, input.at_x, input.gradient);
          if (contact) contact->set_active(result.x);
          measured = true;
        }
        const double slope = free_dot(system, result.gradient, input.direction);
        if (change <= rounding.energy && std::abs(slope) <= approximate_wolfe * std::abs(input.slope)) {
          result.found = true;
          return;
        }
      }
    }
    if (measured && -predicted < rounding.energy) {
      result.at_rounding = true;
      return;
    }
    if (result.halvings == input.max_halvings) return;
    ++result.halvings;
    result.fraction /= 2;
  }
}

}  // namespace ergon
