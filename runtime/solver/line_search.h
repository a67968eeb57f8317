#pragma once
// Back-tracking along a Newton step. It establishes that an accepted state is inside the domain of every potential and
// has a lower energy, or, where rounding hides the change of energy, a slope that shows the decrease.
// Source: Nocedal, Wright 2006, Numerical Optimization, backtracking; Hager, Zhang 2005, SIAM J. Optim. 16(1):
// approximate Wolfe condition.

#include <Eigen/Core>
#include <string>

#include "runtime/contact/contact.h"
#include "runtime/system.h"

namespace ergon {

// How far energy and gradient at x are from exact, measured by moving x by a few roundings of its coordinates.
struct Rounding {
  double energy = 0;    // J
  double gradient = 0;  // N, largest component over free vertices
};
Rounding measure_rounding(System& system, const Eigen::Matrix3Xd& x, const Evaluation& at_x,
                          const Eigen::Matrix3Xd& gradient);

struct LineSearchInput {
  const Eigen::Matrix3Xd& x;
  const Eigen::Matrix3Xd& direction;
  const Evaluation& at_x;
  const Eigen::Matrix3Xd& gradient;
  double slope = 0;           // J, gradient . direction
  double first_fraction = 1;  // tried first
  double sufficient_decrease = 1e-4;
  int max_halvings = 60;
  bool near_limit = false;  // the direction is so short that rounding may hide the decrease
};

struct LineSearchResult {
  bool found = false;
  bool at_rounding = false;  // not found, and rounding hides any decrease that is left
  double fraction = 0;
  int halvings = 0;
  std::string rejected_by;  // why the last trial was rejected
  Eigen::Matrix3Xd x;       // the accepted state and its energy
  Evaluation evaluation;
};

// `result` is passed in so that its arrays are reused. `contact_seconds` takes the time of active sets.
void line_search(System& system, Contact* contact, const LineSearchInput& input, LineSearchResult& result,
                 double& contact_seconds);

// What a state is outside of, by its System::value; empty when it is inside the domain of every potential.
std::string unusable(const Evaluation& evaluation);

}  // namespace ergon
