// Prescribed motion: vertices without degrees of freedom go to where they are to be, and the free ones follow by Newton
// steps for the motion that is left, each as far as contact lets it. No energy is compared in these, since the motion
// does work. Where contact stops one, the free vertices first give way with the others held: a motion that only went on
// would bring gaps down to a tenth each time, without end.

#include <fmt/format.h>

#include <cmath>

#include "runtime/solver/largest.h"
#include "runtime/solver/newton.h"
#include "runtime/solver/stopwatch.h"

namespace ergon {

namespace {

constexpr double difference = 1e-4;  // of a gap, or of the way left, that the motion is tried by
constexpr int max_halvings = 40;
constexpr double given_way = 0.5;     // largest change of gaps by a Newton step that shows them near their balance
constexpr int most_relaxations = 20;  // Newton steps between two parts of the motion

struct Left {
  double length = 0;  // m
  int vertex = -1;
};

Left set_way(const Prescribed& prescribed, const Eigen::Matrix3Xd& x, Eigen::Matrix3Xd& way) {
  way.setZero(3, x.cols());
  Left left;
  for (const int v : *prescribed.vertices) {
    way.col(v) = prescribed.goal->col(v) - x.col(v);
    const double length = way.col(v).norm();
    if (!(length <= left.length)) left = {length, v};
  }
  return left;
}

}  // namespace

// Adds to the gradient what the prescribed motion will change of it: the Hessian's columns of those vertices, which are
// not in the matrix, times their way, by a difference along it.
void Newton::add_pull(System& system, const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& way, double rate) {
  const double part = difference / std::max(1.0, rate);
  moved_ = x + part * way;
  system.gradient(moved_, moved_gradient_);
  moved_gradient_ -= gradient_;
  gradient_ += moved_gradient_ / part;
}

// Newton steps with what is prescribed held where it is, until gaps are near their balance.
bool Newton::relax(System& system, Eigen::Matrix3Xd& x, const NewtonOptions& options, Contact* contact,
                   NewtonResult& result) {
  for (int i = 0; i < most_relaxations && result.iterations < options.max_iterations; ++i) {
    evaluate_value(system, x, contact, result);
    const Progress progress = iterate(system, x, options, contact, result);
    if (!progress.found) return result.at_rounding;
    ++result.follow_iterations;
    contact->adapt(x);
    if (trial_.fraction == 1 && progress.gap_change <= given_way) return true;
  }
  return true;
}

bool Newton::follow(System& system, Eigen::Matrix3Xd& x, const NewtonOptions& options, Contact* contact,
                    NewtonResult& result) {
  Eigen::Matrix3Xd way;
  while (true) {
    const Left left = set_way(options.prescribed, x, way);
    if (left.length == 0) return true;
    if (result.iterations == options.max_iterations) {
      result.reason = fmt::format(
          "in {} Newton iterations the prescribed motion does not arrive: vertex {} is {:.3g} m from where it is to "
          "be; "
          "take shorter steps of time, or let the motion leave room for what it presses on",
          result.iterations, left.vertex, left.length);
      result.worst_vertex = left.vertex;
      return false;
    }
    blend_ = 1;
    evaluate_value(system, x, contact, result);
    evaluate_hessian(system, x, options, result);
    double rate = 0;
    if (contact) {
      const Stopwatch watch(result.seconds.contact);
      rate = contact->gap_change(x, way);
    }
    add_pull(system, x, way, rate);
    find_direction(system, x, options, result);
    if (!result.reason.empty()) return false;
    direction_ += way;
    if (result.iterations == 0) result.first_step_speed = largest_motion(system, direction_).value / options.dt;

    double fraction = 1;
    if (contact) {
      const Stopwatch watch(result.seconds.contact);
      fraction = contact->largest_step(x, direction_);
    }
    for (int halvings = 0;; ++halvings) {
      moved_ = x + fraction * direction_;
      if (fraction == 1) {
        for (const int v : *options.prescribed.vertices) moved_.col(v) = options.prescribed.goal->col(v);
      }
      evaluate_value(system, moved_, contact, result);
      if (unusable(result.evaluation).empty()) break;
      if (halvings == max_halvings) {
        result.reason = fmt::format(
            "the prescribed motion leaves {} after {} halvings; vertex {} is {:.3g} m from "
            "where it is to be",
            unusable(result.evaluation), halvings, left.vertex, left.length);
        return false;
      }
      fraction /= 2;
    }
    x.swap(moved_);
    ++result.iterations;
    ++result.follow_iterations;
    if (fraction < 1 && contact && !relax(system, x, options, contact, result)) return false;
  }
}

}  // namespace ergon
