#include "tools/fit.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "runtime/error.h"
#include "symbolic/analyse.h"
#include "tools/law_point.h"
#include "tools/load_path.h"

namespace ergon {
namespace {

using Data = std::map<std::string, std::vector<double>>;
using Eigen::Index;
using Eigen::VectorXd;

// A param, or a combination of params, whose doubling changes the stress by less than this part of it is undetermined.
constexpr double undetermined = 1e-3;
constexpr int starts = 24, refined = 5, most_iterations = 200;

const LoadPath& path_named(const Energy& density, const std::string& mode) {
  const auto& paths = load_paths(density.geometry);
  return *std::find_if(paths.begin(), paths.end(), [&](const LoadPath& path) { return path.name == mode; });
}

// Component i of the halton sequence of a base: in (0, 1), evenly spread.
double halton(int i, int base) {
  double result = 0, part = 1;
  for (++i; i > 0; i /= base) {
    part /= base;
    result += part * (i % base);
  }
  return result;
}

struct StressSample {
  VectorXd stress;
  Eigen::MatrixXd by_params;
  std::vector<VectorXd> F;
};

// The stress of the law at all points as a function of the params that are looked for.
class StressModel {
 public:
  StressModel(const Energy& density, const std::vector<StressPoint>& points, const Data& given)
      : density_(density), points_(points), given_(given) {
    Index offset = 0;
    for (const Symbol& symbol : density.symbols) {
      if (symbol.role == Role::param && !given.contains(symbol.name)) {
        if (!symbol.shape.scalar())
          throw InputError(fmt::format("a fit looks for numbers; give the {} '{}' with --set {}=VALUES",
                                       to_string(symbol.shape), symbol.name, symbol.name));
        wanted.push_back(&symbol);
        offsets_.push_back(offset);
      } else if (symbol.role != Role::param && symbol.role != Role::dof && !given.contains(symbol.name)) {
        throw InputError(fmt::format("the fit needs the {} data '{}'; give it with --set {}=VALUE",
                                     symbol.role == Role::rest ? "rest" : "lag", symbol.name, symbol.name));
      }
      offset += symbol.shape.size();
    }
  }

  Data data_at(const VectorXd& p) const {
    Data data = given_;
    for (size_t i = 0; i < wanted.size(); ++i) data[wanted[i]->name] = {p[static_cast<Index>(i)]};
    return data;
  }

  // `from`: states nearby, one for each point, or none. Nothing where the law is not defined at a point.
  std::optional<StressSample> at(const VectorXd& p, const std::vector<VectorXd>& from) const {
    const LawPoint law(density_, density_.cases.empty() ? "" : density_.cases.front(), data_at(p));
    const auto n = static_cast<Index>(points_.size()), m = static_cast<Index>(wanted.size());
    StressSample out{VectorXd(n), Eigen::MatrixXd(n, m), {}};
    for (Index i = 0; i < n; ++i) {
      const StressPoint& point = points_[static_cast<size_t>(i)];
      const LoadPath& path = path_named(density_, point.mode);
      const VectorXd near = from.empty() ? without_change_of_volume(path, point.stretch) : from[static_cast<size_t>(i)];
      std::optional<LoadState> state = equilibrium(law, path, point.stretch, near, true);
      if (!state) state = along(law, path, {point.stretch}, true)[0];
      if (!state) return std::nullopt;
      out.stress[i] = state->stress;
      for (Index k = 0; k < m; ++k) out.by_params(i, k) = state->by_data[offsets_[static_cast<size_t>(k)]];
      out.F.push_back(state->F);
    }
    if (!out.stress.allFinite() || !out.by_params.allFinite()) return std::nullopt;
    return out;
  }

  std::vector<const Symbol*> wanted;

 private:
  // The free stretches of an incompressible body.
  static VectorXd without_change_of_volume(const LoadPath& path, double stretch) {
    VectorXd F = path.start + stretch * path.direction;
    const auto columns = F.size() / 3;
    double product = 1;
    int free = 0;
    for (Index i = 0; i < columns; ++i) {
      const bool is_free = std::find(path.free.begin(), path.free.end(), 4 * i) != path.free.end();
      free += is_free ? 1 : 0;
      if (!is_free) product *= F[4 * i];
    }
    for (Index i = 0; i < columns; ++i)
      if (std::find(path.free.begin(), path.free.end(), 4 * i) != path.free.end())
        F[4 * i] = columns == 3 ? std::pow(product, -1.0 / free) : 1;
    return F;
  }

  const Energy& density_;
  const std::vector<StressPoint>& points_;
  const Data& given_;
  std::vector<Index> offsets_;  // of the wanted params among the components of all symbols
};

VectorXd measured(const std::vector<StressPoint>& points) {
  VectorXd y(static_cast<Index>(points.size()));
  for (size_t i = 0; i < points.size(); ++i) y[static_cast<Index>(i)] = points[i].stress;
  return y;
}

// Stress over strain of what is measured; of changes of volume only where there is nothing else.
double stiffness_of(const std::vector<StressPoint>& points) {
  const bool all =
      std::all_of(points.begin(), points.end(), [](const auto& point) { return point.mode == "volumetric"; });
  double up = 0, down = 0;
  for (const StressPoint& point : points) {
    if (point.mode == "volumetric" && !all) continue;
    const double strain = point.stretch - (point.mode == "simple_shear" ? 0 : 1);
    up += point.stress * strain;
    down += strain * strain;
  }
  return down > 0 && up != 0 ? std::fabs(up) / down : 1;
}

// Params of the order of what is measured: moduli about its stiffness, numbers of either small or large size.
VectorXd start_number(int start, const std::vector<const Symbol*>& wanted, const Unit& stress, double stiffness) {
  constexpr int bases[] = {2, 3, 5, 7, 11, 13, 17, 19};
  VectorXd p(static_cast<Index>(wanted.size()));
  for (size_t i = 0; i < wanted.size(); ++i) {
    const Symbol& symbol = *wanted[i];
    const double u = halton(start, bases[i % 8]);
    const Range& range = symbol.range;
    const bool is_stress = symbol.unit == stress;
    double value = is_stress ? stiffness * std::pow(10.0, 4 * u - 2) : std::pow(10.0, 3 * u - 0.5);
    if (range == Range{}) value = is_stress ? (2 * u - 1) * stiffness : 12 * u - 6;
    if (std::isfinite(range.lower) && !is_stress) value += range.lower;
    if (std::isfinite(range.lower) && std::isfinite(range.upper) && !range.contains(value))
      value = range.lower + (range.upper - range.lower) * (0.05 + 0.9 * u);
    if (!range.contains(value))
      value = std::isfinite(range.upper) ? range.upper - std::fabs(value) : range.lower + value;
    p[static_cast<Index>(i)] = value;
  }
  return p;
}

class LevenbergMarquardt {
 public:
  LevenbergMarquardt(const StressModel& model, const VectorXd& y) : model_(&model), y_(&y) {}

  VectorXd p;
  StressSample sample;
  double cost = std::numeric_limits<double>::infinity();
  int iterations = 0;
  bool converged = false;

  bool begin(const VectorXd& start) {
    std::optional<StressSample> found = model_->at(start, {});
    if (!found) return false;
    p = start;
    sample = std::move(*found);
    cost = (sample.stress - *y_).squaredNorm();
    return true;
  }

  void run(int most) {
    double damping = 1e-2;
    for (; iterations < most && !converged; ++iterations) {
      const VectorXd gradient = sample.by_params.transpose() * (sample.stress - *y_);
      Eigen::MatrixXd normal = sample.by_params.transpose() * sample.by_params;
      const std::vector<int> free = free_params(gradient);
      if (free.empty()) converged = true;
      bool accepted = false;
      while (!accepted && !converged) {
        Eigen::MatrixXd damped = normal(free, free);
        damped.diagonal() *= 1 + damping;
        damped.diagonal().array() += 1e-30 * (1 + normal.diagonal().maxCoeff());
        const VectorXd step = -damped.ldlt().solve(gradient(free));
        VectorXd trial = p;
        trial(free) += step;
        keep_in_range(trial);
        const double moved = ((trial - p).cwiseAbs().array() / (p.cwiseAbs().array() + 1e-30)).maxCoeff();
        std::optional<StressSample> next = model_->at(trial, sample.F);
        const double next_cost = next ? (next->stress - *y_).squaredNorm() : std::numeric_limits<double>::infinity();
        accepted = next_cost < cost;
        if (accepted) {
          converged = moved < 1e-11 || cost - next_cost < 1e-15 * cost;
          p = trial;
          sample = std::move(*next);
          cost = next_cost;
          damping = std::max(damping / 8, 1e-14);
        } else {
          converged = moved < 1e-13 || damping > 1e12;
          damping *= 4;
        }
      }
    }
  }

  bool at_bound(Index i) const {
    const Range& range = model_->wanted[static_cast<size_t>(i)]->range;
    return p[i] == range.lower || p[i] == range.upper;
  }

 private:
  // Those that are not held at a closed end of their range by the residual.
  std::vector<int> free_params(const VectorXd& gradient) const {
    std::vector<int> free;
    for (Index i = 0; i < p.size(); ++i) {
      const Range& range = model_->wanted[static_cast<size_t>(i)]->range;
      const bool held = (p[i] == range.lower && gradient[i] > 0) || (p[i] == range.upper && gradient[i] < 0);
      if (!held) free.push_back(static_cast<int>(i));
    }
    return free;
  }

  // A closed end is reached, towards an open one nine tenths of the way are gone.
  void keep_in_range(VectorXd& trial) const {
    for (Index i = 0; i < p.size(); ++i) {
      const Range& range = model_->wanted[static_cast<size_t>(i)]->range;
      if (range.contains(trial[i])) continue;
      const double end = trial[i] <= range.lower ? range.lower : range.upper;
      trial[i] = range.contains(end) ? end : p[i] + 0.9 * (end - p[i]);
    }
  }

  const StressModel* model_;
  const VectorXd* y_;
};

// The size of all stress over that of its test, so that tests of small stress tell as much as others.
VectorXd weights_of(const std::vector<StressPoint>& points, const VectorXd& y) {
  std::map<std::string, double> squares;
  for (const StressPoint& point : points) squares[point.mode] += point.stress * point.stress;
  VectorXd weight(y.size());
  for (Index i = 0; i < y.size(); ++i) {
    const double size = std::sqrt(squares[points[static_cast<size_t>(i)].mode]);
    weight[i] = size > 0 ? y.norm() / size : 1;
  }
  return weight;
}

// Standard deviations, and what the data does not tell, from the singular values of how doubling the params changes the
// stress.
void judge(const LevenbergMarquardt& fit, const VectorXd& y, const VectorXd& weight, double stiffness,
           std::vector<FittedParam>& params) {
  const Index n = y.size(), m = fit.p.size();
  VectorXd scale(m);
  for (Index i = 0; i < m; ++i) scale[i] = fit.p[i] != 0 ? std::fabs(fit.p[i]) : stiffness;
  const Eigen::MatrixXd change = fit.sample.by_params * scale.asDiagonal() / y.norm();
  const Eigen::JacobiSVD<Eigen::MatrixXd> of_tests(weight.asDiagonal() * change, Eigen::ComputeThinV);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(change, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const double noise = n > m ? std::sqrt(fit.cost / static_cast<double>(n - m)) / y.norm() : 0;
  for (Index i = 0; i < m; ++i) {
    double variance = 0;
    FittedParam& param = params[static_cast<size_t>(i)];
    for (Index k = 0; k < m; ++k) {
      const double part = svd.matrixV()(i, k), size = svd.singularValues()[k];
      const bool nothing = of_tests.singularValues()[k] < undetermined;
      if (nothing && std::fabs(of_tests.matrixV()(i, k)) > 0.1) param.determined = false;
      variance += std::pow(noise * part / size, 2);
    }
    param.error = std::sqrt(variance) * scale[i];
    if (!(param.error <= scale[i])) param.determined = false;
  }
}

}  // namespace

Fit fit_params(const Energy& density, const std::vector<StressPoint>& points, const Data& given) {
  const StressModel model(density, points, given);
  const size_t count = model.wanted.size();
  if (count == 0) throw InputError(fmt::format("{} has no param left to find", density.name));
  if (points.size() < count)
    throw InputError(fmt::format("{} points of stress do not determine {} params", points.size(), count));
  const VectorXd y = measured(points);
  const double stiffness = stiffness_of(points);

  std::vector<LevenbergMarquardt> fits;
  for (int i = 0; i < starts; ++i) {
    LevenbergMarquardt fit(model, y);
    if (fit.begin(start_number(i, model.wanted, value_unit(density), stiffness))) fits.push_back(std::move(fit));
  }
  if (fits.empty())
    throw InputError(
        fmt::format("{} is not defined at the measured stretches for any of {} starts of the params; give "
                    "some of them with --set",
                    density.name, starts));
  const auto cheaper = [](const LevenbergMarquardt& a, const LevenbergMarquardt& b) { return a.cost < b.cost; };
  std::stable_sort(fits.begin(), fits.end(), cheaper);
  if (fits.size() > refined) fits.erase(fits.begin() + refined, fits.end());
  for (LevenbergMarquardt& fit : fits) fit.run(most_iterations / 4);
  LevenbergMarquardt& best = *std::min_element(fits.begin(), fits.end(), cheaper);
  best.run(most_iterations);

  Fit out;
  for (size_t i = 0; i < count; ++i) {
    const auto k = static_cast<Index>(i);
    out.params.push_back({model.wanted[i]->name, best.p[k], 0, true, best.at_bound(k)});
  }
  judge(best, y, weights_of(points, y), stiffness, out.params);
  out.data = model.data_at(best.p);
  out.stress.assign(best.sample.stress.data(), best.sample.stress.data() + best.sample.stress.size());
  out.rms = std::sqrt(best.cost / static_cast<double>(points.size()));
  out.relative = std::sqrt(best.cost) / y.norm();
  out.iterations = best.iterations;
  out.converged = best.converged;
  return out;
}

double derivative_error(const Energy& density, const std::vector<StressPoint>& points, const Data& data) {
  Data given = data;
  for (const Symbol* param : density.with_role(Role::param))
    if (param->shape.scalar()) given.erase(param->name);
  const StressModel model(density, points, given);
  VectorXd p(static_cast<Index>(model.wanted.size()));
  for (size_t i = 0; i < model.wanted.size(); ++i) p[static_cast<Index>(i)] = data.at(model.wanted[i]->name)[0];
  const auto sample = model.at(p, {});
  if (!sample) return std::numeric_limits<double>::infinity();
  double worst = 0;
  for (Index k = 0; k < p.size(); ++k) {
    const double step = 1e-5 * (p[k] == 0 ? 1 : std::fabs(p[k]));
    VectorXd up = p, down = p;
    up[k] += step;
    down[k] -= step;
    const auto above = model.at(up, sample->F), below = model.at(down, sample->F);
    if (!above || !below) return std::numeric_limits<double>::infinity();
    const VectorXd difference = (above->stress - below->stress) / (2 * step) - sample->by_params.col(k);
    worst = std::max(worst, difference.cwiseAbs().maxCoeff() / sample->by_params.col(k).cwiseAbs().maxCoeff());
  }
  return worst;
}

}  // namespace ergon
