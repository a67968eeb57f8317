#include "runtime/solver/line_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "runtime/solver/stopwatch.h"

namespace ergon {

namespace {

// A trial whose slope has fallen to this part of the first one has come near the minimum along the line.
constexpr double approximate_wolfe = 0.8;

// Changes of energy below this part of the energy's terms are worth a measurement of rounding.
constexpr double suspicious_change = 1e-8;

double magnitude_of(const Evaluation& evaluation) {
  double sum = 0, rest = evaluation.value;
  for (const double value : evaluation.by_potential) {
    sum += std::abs(value);
    rest -= value;
  }
  return sum + std::abs(rest);
}

double free_dot(const System& system, const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b) {
  double sum = 0;
  for (int v = 0; v < system.vertices(); ++v) {
    if (system.block_of(v) >= 0) sum += a.col(v).dot(b.col(v));
  }
  return sum;
}

}  // namespace

std::string unusable(const Evaluation& evaluation) {
  return evaluation.require > 0 ? "" : "the domain of " + evaluation.violated;
}

Rounding measure_rounding(System& system, const Eigen::Matrix3Xd& x, const Evaluation& at_x,
                          const Eigen::Matrix3Xd& gradient) {
  constexpr int samples = 4;  // of the energy, which is one number: one alone may fall where its errors cancel
  Rounding rounding;
  std::uint32_t random = 1;
  for (int sample = 0; sample < samples; ++sample) {
    Eigen::Matrix3Xd moved = x;
    for (int v = 0; v < system.vertices(); ++v) {
      if (system.block_of(v) < 0) continue;
      for (int c = 0; c < 3; ++c) {
        random = 1664525 * random + 1013904223;  // Numerical Recipes' generator: which way to move
        moved(c, v) *= 1 + (random >> 31 ? 4 : -4) * std::numeric_limits<double>::epsilon();
      }
    }
    system.carriers().place(moved);
    const double error = system.value(moved).value - at_x.value - free_dot(system, gradient, moved - x);
    rounding.energy = std::max(rounding.energy, 8 * std::abs(error));
    if (sample > 0) continue;
    Eigen::Matrix3Xd moved_gradient(3, x.cols());
    system.gradient(moved, moved_gradient);
    for (int v = 0; v < system.vertices(); ++v) {
      if (system.block_of(v) < 0) continue;
      rounding.gradient = std::max(rounding.gradient, (moved_gradient.col(v) - gradient.col(v)).cwiseAbs().maxCoeff());
    }
  }
  rounding.energy += 8 * std::numeric_limits<double>::epsilon() * magnitude_of(at_x);
  return rounding;
}

void line_search(System& system, Contact* contact, const LineSearchInput& input, LineSearchResult& result,
                 double& contact_seconds) {
  result.found = result.at_rounding = false;
  result.fraction = input.first_fraction;
  result.halvings = 0;
  bool measured = false;
  Rounding rounding;
  Eigen::Matrix3Xd gradient;
  while (true) {
    result.x = input.x + result.fraction * input.direction;
    if (contact) {
      const Stopwatch watch(contact_seconds);
      contact->set_active(result.x);
    }
    result.evaluation = system.value(result.x);
    const double predicted = result.fraction * input.slope;
    result.rejected_by = unusable(result.evaluation);
    if (result.rejected_by.empty()) {
      result.rejected_by = "the energy, which does not fall";
      const double change = result.evaluation.value - input.at_x.value;
      if (change <= input.sufficient_decrease * predicted) {
        result.found = true;
        return;
      }
      if (input.near_limit || std::abs(change) <= suspicious_change * magnitude_of(input.at_x)) {
        if (!measured) {
          if (contact) contact->set_active(input.x);
          rounding = measure_rounding(system, input.x, input.at_x, input.gradient);
          if (contact) contact->set_active(result.x);
          measured = true;
        }
        if (change <= rounding.energy) {
          system.gradient(result.x, gradient);
          const double slope = free_dot(system, gradient, input.direction);
          if (std::abs(slope) <= approximate_wolfe * std::abs(input.slope)) {
            result.found = true;
            return;
          }
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
