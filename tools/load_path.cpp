#include "tools/load_path.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace ergon {
namespace {

// Component (row, column) of an F of three rows, column by column.
constexpr int at(int row, int column) { return 3 * column + row; }

struct Prescribed {
  int component;
  double start, direction;  // start + direction*stretch
};

LoadPath path(const std::string& name, int columns, const std::vector<Prescribed>& prescribed, std::vector<int> free,
              std::vector<std::pair<int, double>> measured, double rest = 1) {
  LoadPath out{name,
               Eigen::VectorXd::Zero(3 * columns),
               Eigen::VectorXd::Zero(3 * columns),
               std::move(free),
               std::move(measured),
               rest};
  for (const Prescribed& p : prescribed) {
    out.start[p.component] = p.start;
    out.direction[p.component] = p.direction;
  }
  return out;
}

std::vector<LoadPath> solid_paths() {
  const std::vector<int> across = {at(0, 2), at(1, 2), at(2, 2)};
  return {path("uniaxial", 3, {{at(0, 0), 0, 1}}, {at(0, 1), at(1, 1), at(0, 2), at(1, 2), at(2, 2)}, {{at(0, 0), 1}}),
          path("equibiaxial", 3, {{at(0, 0), 0, 1}, {at(1, 1), 0, 1}}, across, {{at(0, 0), 0.5}, {at(1, 1), 0.5}}),
          path("pure_shear", 3, {{at(0, 0), 0, 1}, {at(1, 1), 1, 0}}, across, {{at(0, 0), 1}}),
          path("simple_shear", 3, {{at(0, 0), 1, 0}, {at(1, 1), 1, 0}, {at(2, 2), 1, 0}, {at(0, 1), 0, 1}}, {},
               {{at(0, 1), 1}}, 0),
          path("volumetric", 3, {{at(0, 0), 0, 1}, {at(1, 1), 0, 1}, {at(2, 2), 0, 1}}, {},
               {{at(0, 0), 1.0 / 3}, {at(1, 1), 1.0 / 3}, {at(2, 2), 1.0 / 3}})};
}

std::vector<LoadPath> membrane_paths() {
  return {path("uniaxial", 2, {{at(0, 0), 0, 1}}, {at(0, 1), at(1, 1)}, {{at(0, 0), 1}}),
          path("equibiaxial", 2, {{at(0, 0), 0, 1}, {at(1, 1), 0, 1}}, {}, {{at(0, 0), 0.5}, {at(1, 1), 0.5}}),
          path("pure_shear", 2, {{at(0, 0), 0, 1}, {at(1, 1), 1, 0}}, {}, {{at(0, 0), 1}}),
          path("simple_shear", 2, {{at(0, 0), 1, 0}, {at(1, 1), 1, 0}, {at(0, 1), 0, 1}}, {}, {{at(0, 1), 1}}, 0)};
}

Eigen::VectorXd undeformed_F(const LoadPath& path) {
  Eigen::VectorXd F = Eigen::VectorXd::Zero(path.start.size());
  for (int i = 0; i < F.size() / 3; ++i) F[at(i, i)] = 1;
  return F;
}

double measure(const LoadPath& path, const Eigen::VectorXd& by_F) {
  double sum = 0;
  for (const auto& [component, weight] : path.measured) sum += weight * by_F[component];
  return sum;
}

// Stress, its slope and its derivatives by the data, with the free components following.
LoadState measured_state(const LawPoint& law, const LoadPath& path, const Eigen::VectorXd& F, bool with_data) {
  const LawState state = with_data ? law.with_data(F) : law.at(F);
  const Eigen::Index f = static_cast<Eigen::Index>(path.free.size()), n = F.size(), all = state.hessian.cols();
  // How F changes with the stretch (first column) and with the data.
  Eigen::MatrixXd change = Eigen::MatrixXd::Zero(n, 1 + all - n);
  change.col(0) = path.direction;
  for (const int component : path.free) change(component, 0) = 0;
  Eigen::MatrixXd force = state.hessian.topLeftCorner(n, n) * change;
  force.rightCols(all - n) += state.hessian.topRightCorner(n, all - n);
  if (f > 0) {
    const Eigen::MatrixXd solved =
        state.hessian(path.free, path.free).partialPivLu().solve(force(path.free, Eigen::all));
    for (Eigen::Index i = 0; i < f; ++i) change.row(path.free[static_cast<size_t>(i)]) -= solved.row(i);
    force = state.hessian.topLeftCorner(n, n) * change;
    force.rightCols(all - n) += state.hessian.topRightCorner(n, all - n);
  }
  LoadState out{F, measure(path, state.gradient), state.value, measure(path, force.col(0)), Eigen::VectorXd::Zero(all)};
  for (Eigen::Index k = n; k < all; ++k) out.by_data[k] = measure(path, force.col(1 + k - n));
  return out;
}

}  // namespace

const std::vector<LoadPath>& load_paths(const std::string& geometry) {
  static const std::vector<LoadPath> solid = solid_paths(), membrane = membrane_paths(),
                                     line = {path("uniaxial", 1, {{0, 0, 1}}, {}, {{0, 1}})};
  return geometry == "solid" ? solid : geometry == "membrane" ? membrane : line;
}

std::optional<LoadState> equilibrium(const LawPoint& law, const LoadPath& path, double stretch, Eigen::VectorXd from,
                                     bool with_data) {
  constexpr int most_iterations = 60;
  const Eigen::VectorXd prescribed = path.start + stretch * path.direction;
  Eigen::VectorXd F = prescribed;
  for (const int component : path.free) F[component] = from[component];
  LawState state = law.at(F);
  if (!state.defined) return std::nullopt;
  for (int i = 0; i < most_iterations && !path.free.empty(); ++i) {
    const Eigen::VectorXd stress = state.gradient(path.free);
    const Eigen::MatrixXd stiffness = state.hessian(path.free, path.free);
    const Eigen::VectorXd step = -stiffness.partialPivLu().solve(stress);
    if (!step.allFinite()) return std::nullopt;
    // Newton's step, or as much of it as the law is defined on and lessens the stress.
    double part = 1;
    Eigen::VectorXd trial = F;
    LawState next;
    for (; part > 1e-6; part /= 2) {
      trial(path.free) = F(path.free) + part * step;
      next = law.at(trial);
      if (next.defined && next.gradient(path.free).norm() < stress.norm()) break;
    }
    // Either the step is nothing, or the stress is what rounding of the stiffest part makes of 0.
    const double rounding =
        64 * std::numeric_limits<double>::epsilon() * state.hessian.cwiseAbs().maxCoeff() * F.norm();
    const bool at_the_end = step.norm() <= 1e-11 * F.norm() || stress.norm() <= rounding;
    if (part > 1e-6) {
      F = trial;
      state = next;
    } else if (!at_the_end) {
      return std::nullopt;
    }
    if (at_the_end) break;
    if (i + 1 == most_iterations) return std::nullopt;
  }
  return measured_state(law, path, F, with_data);
}

std::vector<std::optional<LoadState>> along(const LawPoint& law, const LoadPath& path,
                                            const std::vector<double>& stretches, bool with_data) {
  constexpr double largest_step = 0.05;
  std::vector<std::optional<LoadState>> out(stretches.size());
  std::vector<size_t> order(stretches.size());
  std::iota(order.begin(), order.end(), size_t{0});
  for (const double side : {1.0, -1.0}) {
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return side * stretches[a] < side * stretches[b]; });
    Eigen::VectorXd F = undeformed_F(path);
    double reached = path.rest;
    for (const size_t i : order) {
      const double wanted = stretches[i];
      if (side * (wanted - path.rest) < 0 || (side < 0 && wanted == path.rest)) continue;
      const int steps =
          path.free.empty() ? 1 : std::max(1, static_cast<int>(std::ceil(std::fabs(wanted - reached) / largest_step)));
      std::optional<LoadState> state;
      for (int k = 1; k <= steps; ++k) {
        const double stretch = k == steps ? wanted : reached + (wanted - reached) * k / steps;
        state = equilibrium(law, path, stretch, F, with_data && k == steps);
        if (!state) break;
        F = state->F;
      }
      if (!state) break;
      reached = wanted;
      out[i] = std::move(state);
    }
  }
  return out;
}

}  // namespace ergon
