#include "runtime/solver/integrator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "runtime/error.h"

namespace ergon {

namespace {

constexpr size_t start = 1;  // index of the moment at the start of the step

// Stage of a method for first-order systems: y = sum of kept_j*y_j + dt*(sum of slopes_j*y_j' + h*y'), for x and v
// alike.
Stage first_order(double time, double h, const std::vector<double>& kept, const std::vector<double>& slopes) {
  Stage stage{time, h * h, h, Combination(kept.size()), Combination(kept.size())};
  for (size_t j = 0; j < kept.size(); ++j) {
    stage.xhat[j] = {kept[j], slopes[j] + h * kept[j], h * slopes[j]};
    stage.vhat[j] = {0, kept[j], slopes[j]};
  }
  return stage;
}

Integrator implicit_euler(double) { return {.order = 1, .stages = {first_order(1, 1, {0, 1}, {0, 0})}}; }

Integrator bdf2(double ratio) {
  const double w = ratio, d = 1 + 2 * w;
  const Stage stage = first_order(1, (1 + w) / d, {-w * w / d, (1 + w) * (1 + w) / d}, {0, 0});
  return {.order = 2, .two_step = true, .stages = {stage}};
}

// Of its stages the second has the first one's slope, (v1 - v)/(gamma*dt) for v.
Integrator sdirk2(double) {
  const double gamma = 1 - std::sqrt(0.5);
  return {.order = 2,
          .stages = {first_order(gamma, gamma, {0, 1}, {0, 0}), first_order(1, gamma, {0, 1, 0}, {0, 0, 1 - gamma})}};
}

Integrator tr_bdf2(double) {
  const double gamma = 2 - std::sqrt(2.0), half = gamma / 2, all = gamma * (2 - gamma);
  return {.order = 2,
          .needs_acceleration = true,
          .stages = {first_order(gamma, half, {0, 1}, {0, half}),
                     first_order(1, half, {0, -(1 - gamma) * (1 - gamma) / all, 1 / all}, {0, 0, 0})}};
}

// y1 = y0 + 2*(y_m - y0).
Integrator midpoint(double) {
  return {.order = 2,
          .stages = {first_order(0.5, 0.5, {0, 1}, {0, 0})},
          .end_x = {{}, {-1, 0, 0}, {2, 0, 0}},
          .end_v = {{}, {0, -1, 0}, {0, 2, 0}},
          .end_a = {{}, {}, {0, 0, 1}}};
}

Integrator newmark(double) {
  return {.order = 2, .needs_acceleration = true, .stages = {first_order(1, 0.5, {0, 1}, {0, 0.5})}};
}

// The stage's acceleration is (1 - m)*a1 + m*a0 and its position (1 - f)*x1 + f*x0, with x1, v1 by Newmark's formulas.
Integrator generalised_alpha(double) {
  const double radius = 0.8, m = (2 * radius - 1) / (radius + 1), f = radius / (radius + 1);
  const double gamma = 0.5 - m + f, beta = (1 - m + f) * (1 - m + f) / 4;
  const double k = (1 - f) / (1 - m);  // of the stage's acceleration in (1 - f)*a1
  Stage stage{1 - f, k * beta, k * gamma, Combination(2), Combination(2)};
  stage.xhat[start] = {1, 1 - f, (1 - f) * (0.5 - beta) - k * m * beta};
  stage.vhat[start] = {0, 1, (1 - f) * (1 - gamma) - k * m * gamma};
  const double a1 = 1 / (1 - m), a0 = -m / (1 - m);  // of stage and start in the acceleration at the end
  return {.order = 2,
          .needs_acceleration = true,
          .stages = {stage},
          .end_x = {{}, {1, 1, 0.5 - beta + beta * a0}, {0, 0, beta * a1}},
          .end_v = {{}, {0, 1, 1 - gamma + gamma * a0}, {0, 0, gamma * a1}},
          .end_a = {{}, {0, 0, a0}, {0, 0, a1}}};
}

Integrator quasi_static(double) {
  return {.order = 1, .has_inertia = false, .stages = {first_order(1, 1, {0, 1}, {0, 0})}};
}

using Maker = Integrator (*)(double ratio);
const std::pair<const char*, Maker> makers[] = {{"implicit_euler", implicit_euler},
                                                {"bdf2", bdf2},
                                                {"sdirk2", sdirk2},
                                                {"tr_bdf2", tr_bdf2},
                                                {"midpoint", midpoint},
                                                {"newmark", newmark},
                                                {"generalised_alpha", generalised_alpha},
                                                {"quasi_static", quasi_static}};

template <class Term>
Eigen::Matrix3Xd sum_of(const Combination& weights, const std::vector<Moment>& moments, Term term) {
  Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, moments[start].x.cols());
  for (size_t j = 0; j < weights.size(); ++j) term(weights[j], moments[j], sum);
  return sum;
}

// A moment without a field has no weight on it.
void add_times(double weight, const Eigen::Matrix3Xd& field, Eigen::Matrix3Xd& sum) {
  if (weight != 0) sum += weight * field;
}

}  // namespace

Combination xlag_of(const Stage& stage) {
  const double part = stage.inertia / stage.rate;
  Combination out = stage.xhat;
  for (size_t j = 0; j < out.size(); ++j) {
    out[j].v -= part * stage.vhat[j].v;
    out[j].a -= part * stage.vhat[j].a;
  }
  return out;
}

std::vector<std::string> integrator_names() {
  std::vector<std::string> names;
  for (const auto& [name, make] : makers) names.emplace_back(name);
  return names;
}

Integrator integrator_named(const std::string& name, double ratio) {
  for (const auto& [known, make] : makers)
    if (name == known) return make(ratio);
  throw InputError(fmt::format("there is no integrator '{}'; there are {}", name, fmt::join(integrator_names(), ", ")));
}

// By the velocities of a motion whose accelerations are 0 but for one.
std::vector<double> slope_weights(const Integrator& integrator) {
  if (integrator.stages.size() < 2) return {};
  std::vector<double> out;
  for (size_t accelerated = 0; accelerated < integrator.stages.size() + 2; ++accelerated) {
    const auto a = [&](size_t j) { return Eigen::Matrix3Xd::Constant(3, 1, j == accelerated ? 1 : 0); };
    const Eigen::Matrix3Xd none = Eigen::Matrix3Xd::Zero(3, 1);
    std::vector<Moment> moments = {{none, none, a(0)}, {none, none, a(1)}};
    for (const Stage& stage : integrator.stages) {
      Eigen::Matrix3Xd v = velocity(stage.vhat, moments, 1) + stage.rate * a(moments.size());
      moments.push_back({none, std::move(v), a(moments.size())});
    }
    out.push_back(moments.back().v(0));
  }
  return out;
}

double error_constant(const Integrator& integrator, double ratio) {
  const int degree = integrator.order + 1;
  const auto motion = [&](double t) {
    const auto power = [t](int n) { return n < 0 ? 0 : n == 0 ? 1 : std::pow(t, n) / std::tgamma(n + 1.0); };
    Moment at{Eigen::Matrix3Xd::Zero(3, 1), Eigen::Matrix3Xd::Zero(3, 1), Eigen::Matrix3Xd::Zero(3, 1)};
    at.x(0) = power(degree);
    at.v(0) = power(degree - 1);
    at.a(0) = power(degree - 2);
    return at;
  };
  std::vector<Moment> moments = {motion(-1 / ratio), motion(0)};
  for (const Stage& stage : integrator.stages) {
    Moment end = motion(stage.time);  // of which the acceleration is right
    end.x = position(stage.xhat, moments, 1) + stage.inertia * end.a;
    end.v = velocity(stage.vhat, moments, 1) + stage.rate * end.a;
    moments.push_back(std::move(end));
  }
  const double x = integrator.end_x.empty() ? moments.back().x(0) : position(integrator.end_x, moments, 1)(0);
  return std::abs(x - motion(1).x(0));
}

Eigen::Matrix3Xd position(const Combination& weights, const std::vector<Moment>& moments, double dt) {
  return sum_of(weights, moments, [dt](const Weights& w, const Moment& moment, Eigen::Matrix3Xd& sum) {
    add_times(w.x, moment.x, sum);
    add_times(w.v * dt, moment.v, sum);
    add_times(w.a * dt * dt, moment.a, sum);
  });
}

Eigen::Matrix3Xd velocity(const Combination& weights, const std::vector<Moment>& moments, double dt) {
  return sum_of(weights, moments, [dt](const Weights& w, const Moment& moment, Eigen::Matrix3Xd& sum) {
    add_times(w.v, moment.v, sum);
    add_times(w.a * dt, moment.a, sum);
  });
}

Eigen::Matrix3Xd acceleration(const Combination& weights, const std::vector<Moment>& moments) {
  return sum_of(weights, moments,
                [](const Weights& w, const Moment& moment, Eigen::Matrix3Xd& sum) { add_times(w.a, moment.a, sum); });
}

}  // namespace ergon
