#include "runtime/solver/newton.h"

#include <fmt/format.h>

#include <cmath>

#include "runtime/solver/largest.h"
#include "runtime/solver/stopwatch.h"

namespace ergon {

namespace {

constexpr double largest_gap_change = 0.1;   // of the last Newton step, as a fraction of each active gap
constexpr double model_error = 0.05;         // of the change of energy that a Newton step predicts
constexpr double same_factor_margin = 0.5;   // of the tolerance, for a step solved with the factor of the one before
constexpr double near_limit = 1e3;           // tolerances: a step below this may be the last but one
constexpr double rounding_gradients = 4;     // a gradient of so many times its rounding counts as zero
constexpr double first_shift = 1e-8;         // of the mean diagonal
constexpr double neutral_curvature = 1e-13;  // of the mean diagonal: what rounding makes of a factor's zero pivots
constexpr double shift_growth = 10;
constexpr int max_shifts = 20;
constexpr double first_blend = 1.0 / 16;  // of projected Hessians, where those as they are do not serve
constexpr double blend_growth = 4;        // from iterate to iterate
constexpr double blend_decay = 2;
constexpr double bold_fraction = 0.1;  // of a Newton step: less says that its Hessian was too soft

double lowered(double blend) { return blend / blend_decay < first_blend ? 0 : blend / blend_decay; }

// Any component of the next Newton step p = -H^-1 g is at most this, in m, because H >= diag(curvature):
// |p_i| <= sqrt(H^-1_ii) sqrt(g' H^-1 g).
double step_bound(const System& system, const Eigen::Matrix3Xd& gradient, const Eigen::VectorXd& curvature) {
  double sum = 0, least = std::numeric_limits<double>::infinity();
  for (int v = 0; v < system.vertices(); ++v) {
    if (!system.moves(v)) continue;
    if (system.block_of(v) >= 0) sum += gradient.col(v).squaredNorm() / curvature[v];
    least = std::min(least, curvature[v]);
  }
  return sum == 0 ? 0 : std::sqrt(sum / least);
}

double mean_diagonal(const BlockMatrix& matrix) {
  double sum = 0;
  for (int column = 0; column < matrix.rows(); ++column) {
    const int entry = matrix.column_start()[static_cast<size_t>(column)] + column % 3;  // the diagonal block is first
    sum += std::abs(matrix.values()[static_cast<size_t>(entry)]);
  }
  return sum / std::max(1, matrix.rows());
}

}  // namespace

NewtonResult Newton::minimise(System& system, Eigen::Matrix3Xd& x, const NewtonOptions& options, Contact* contact) {
  NewtonResult result;
  blend_ = 1;
  if (options.prescribed.vertices && !follow(system, x, options, contact, result)) return result;
  blend_ = options.on_demand ? 0 : 1;
  evaluate_value(system, x, contact, result);
  if (const std::string outside = unusable(result.evaluation); !outside.empty()) {
    result.reason = "the state at the start is outside " + outside;
    return result;
  }
  evaluate_gradient(system, x, result);
  if (certainly_converged(system, options, result)) return result;

  while (true) {
    if (result.iterations == options.max_iterations) {
      const Largest worst = largest_motion(system, direction_);
      result.reason = fmt::format(
          "{} Newton iterations did not reach the tolerance of {:.3g} m/s: the last step is {:.3g} m/s at vertex {}",
          result.iterations, options.tolerance, result.step_speed, worst.vertex);
      result.worst_vertex = worst.vertex;
      return result;
    }

    const Progress progress = iterate(system, x, options, contact, result);
    if (!progress.found) return result;
    if (contact && contact->adapt(x)) {
      evaluate_value(system, x, contact, result);
      continue;
    }
    if (progress.is_last) {
      evaluate_gradient(system, x, result);
      result.converged = true;
      return result;
    }
    if (progress.is_near || progress.is_quadratic) {
      evaluate_gradient(system, x, result);
      if (certainly_converged(system, options, result)) return result;
      if (progress.is_quadratic && finishes_with_same_factor(system, x, options, contact, result)) return result;
    }
  }
}

// One step from x, whose energy is known.
Newton::Progress Newton::iterate(System& system, Eigen::Matrix3Xd& x, const NewtonOptions& options, Contact* contact,
                                 NewtonResult& result) {
  if (contact) contact->begin_hessian(x);
  evaluate_hessian(system, x, options, result);
  const double slope = find_direction(system, x, options, result);
  if (contact) contact->end_hessian();
  if (!result.reason.empty()) return {};
  if (contact) contact->judge_step(x, direction_);
  result.step_speed = largest_motion(system, direction_).value / options.dt;
  if (result.iterations == 0) result.first_step_speed = result.step_speed;

  const double used = blend_;
  const Progress progress = take_step(system, x, slope, options, contact, result);
  if (!progress.found) return progress;
  ++result.iterations;
  if (options.on_demand) {
    const bool bold = trial_.fraction < bold_fraction;
    blend_ = bold ? std::min(1.0, std::max(first_blend, blend_growth * blend_)) : lowered(blend_);
  }
  result.projected_iterations += used > 0 && options.projection != Projection::none;
  return progress;
}

// Moves x along direction_ as far as contact and energy let it.
Newton::Progress Newton::take_step(System& system, Eigen::Matrix3Xd& x, double slope, const NewtonOptions& options,
                                   Contact* contact, NewtonResult& result) {
  Progress progress;
  double fraction = 1;
  if (contact) {
    const Stopwatch watch(result.seconds.contact);
    fraction = contact->largest_step(x, direction_);
    progress.gap_change = contact->gap_change(x, direction_);
  }
  progress.is_near = result.step_speed <= near_limit * options.tolerance;
  progress.is_last = result.step_speed <= options.tolerance && progress.gap_change <= largest_gap_change;
  if (!(fraction > 0) && !progress.is_last) {
    refuse_standstill(system, x, *contact, result);
    return progress;
  }

  const LineSearchInput input{.x = x,
                              .direction = direction_,
                              .at_x = result.evaluation,
                              .gradient = gradient_,
                              .slope = slope,
                              .first_fraction = fraction,
                              .sufficient_decrease = options.sufficient_decrease,
                              .max_halvings = options.max_halvings,
                              .near_limit = progress.is_near};
  const double contact_before = result.seconds.contact;
  {
    const Stopwatch watch(result.seconds.line_search);
    line_search(system, contact, input, trial_, result.seconds.contact);
  }
  result.seconds.line_search -= result.seconds.contact - contact_before;
  result.halvings += trial_.halvings;
  progress.found = trial_.found;
  if (!trial_.found) {
    give_up_line_search(system, x, contact, progress.is_last, result);
    return progress;
  }
  const double change = trial_.evaluation.value - result.evaluation.value;
  progress.is_quadratic = trial_.fraction == 1 && std::abs(change - slope / 2) <= model_error * std::abs(slope);
  result.smallest_fraction = std::min(result.smallest_fraction, trial_.fraction);
  x.swap(trial_.x);
  result.evaluation = trial_.evaluation;
  return progress;
}

// Where the last step came out as its quadratic model foretold, the factor that it was solved with gives the next step
// nearly as a new one would: well enough to tell that it is the last, and to take it.
bool Newton::finishes_with_same_factor(System& system, Eigen::Matrix3Xd& x, const NewtonOptions& options,
                                       Contact* contact, NewtonResult& result) {
  const std::optional<double> slope = solve_direction(system, result);
  if (!slope) return false;
  const double speed = largest_motion(system, direction_).value / options.dt;
  if (speed > same_factor_margin * options.tolerance) return false;
  if (contact) {
    const Stopwatch watch(result.seconds.contact);
    if (contact->gap_change(x, direction_) > largest_gap_change) return false;
  }
  result.step_speed = speed;
  result.converged = take_step(system, x, *slope, options, contact, result).found || result.at_rounding;
  if (!result.converged) {
    result.reason.clear();  // a new Hessian may do better
    return false;
  }
  ++result.reused_factors;
  evaluate_gradient(system, x, result);
  return true;
}

void Newton::evaluate_hessian(System& system, const Eigen::Matrix3Xd& x, const NewtonOptions& options,
                              NewtonResult& result) {
  const Stopwatch watch(result.seconds.evaluate);
  if (blend_ < 1) {
    result.evaluation = system.hessian(x, Projection::none, gradient_, as_it_is_);
    matrix_ = as_it_is_;
  }
  if (blend_ > 0) {
    result.evaluation = system.hessian(x, options.projection, gradient_, blend_ < 1 ? projected_ : matrix_);
    if (blend_ < 1) blend(blend_);
    result.indefinite += result.evaluation.indefinite;
  }
  result.residual = largest_free_component(system, gradient_).value;
}

// matrix_ = as_it_is_ + part*(projected_ - as_it_is_).
void Newton::blend(double part) {
  const std::vector<double>&a = as_it_is_.values(), &b = projected_.values();
  std::vector<double>& out = matrix_.values();
  for (size_t i = 0; i < out.size(); ++i) out[i] = a[i] + part * (b[i] - a[i]);
}

void Newton::evaluate_value(System& system, const Eigen::Matrix3Xd& x, Contact* contact, NewtonResult& result) {
  if (contact) {
    const Stopwatch watch(result.seconds.contact);
    contact->set_active(x);
  }
  const Stopwatch watch(result.seconds.evaluate);
  result.evaluation = system.value(x);
}

void Newton::evaluate_gradient(System& system, const Eigen::Matrix3Xd& x, NewtonResult& result) {
  const Stopwatch watch(result.seconds.evaluate);
  system.gradient(x, gradient_);
  result.residual = largest_free_component(system, gradient_).value;
}

bool Newton::is_minimum(System& system, const Eigen::Matrix3Xd& x) {
  system.hessian(x, Projection::none, gradient_, matrix_);
  return !solver_.factor(matrix_, neutral_curvature * mean_diagonal(matrix_));
}

// The gradient alone may show that the next step is below the tolerance.
bool Newton::certainly_converged(const System& system, const NewtonOptions& options, NewtonResult& result) const {
  if (options.curvature.size() == 0 || blend_ < 1 || options.projection == Projection::none) return false;
  const double bound = step_bound(system, gradient_, options.curvature) / options.dt;
  if (!(bound <= options.tolerance)) return false;
  result.step_speed = bound;
  result.converged = true;
  return true;
}

// Solves H p = -g with the present factor; g . p, or nothing where p does not descend.
std::optional<double> Newton::solve_direction(System& system, NewtonResult& result) {
  const Stopwatch watch(result.seconds.solve);
  right_side_.resize(matrix_.rows());
  for (int v = 0; v < system.vertices(); ++v) {
    if (const int block = system.block_of(v); block >= 0) right_side_.segment<3>(3 * block) = -gradient_.col(v);
  }
  solver_.solve(right_side_, step_);
  const double slope = -right_side_.dot(step_);
  if (!step_.allFinite() || slope > 0) return std::nullopt;
  direction_.setZero(3, system.vertices());
  for (int v = 0; v < system.vertices(); ++v) {
    if (const int block = system.block_of(v); block >= 0) direction_.col(v) = step_.segment<3>(3 * block);
  }
  system.carriers().place(direction_);
  return slope;
}

// Factors H and solves; where H has no factor or the step does not descend, with H projected if that was left for when
// it is needed, then with a diagonal that grows. Returns g . p.
double Newton::find_direction(System& system, const Eigen::Matrix3Xd& x, const NewtonOptions& options,
                              NewtonResult& result) {
  std::optional<int> failed;
  double shift = 0, tried = 0;
  for (int attempt = 0; attempt <= max_shifts && std::isfinite(shift); ++attempt) {
    {
      const Stopwatch watch(result.seconds.factor);
      failed = solver_.factor(matrix_, shift);
      ++result.factorisations;
      result.factor_flops += solver_.factor_flops();
    }
    if (!failed) {
      if (const std::optional<double> slope = solve_direction(system, result)) return *slope;
    }
    if (blend_ < 1) {
      if (blend_ == 0) {
        const Stopwatch watch(result.seconds.evaluate);
        result.indefinite += system.hessian(x, options.projection, gradient_, projected_).indefinite;
      }
      blend_ = std::min(1.0, std::max(first_blend, blend_growth * blend_));
      blend(blend_);
      continue;
    }
    ++result.shifts;
    tried = shift;
    shift = shift == 0 ? first_shift * mean_diagonal(matrix_) : shift_growth * shift;
    if (shift == 0) break;
  }
  result.reason = "the Hessian is not finite or gives no direction of descent";
  for (int v = 0; v < system.vertices() && failed; ++v) {
    if (system.block_of(v) != *failed / 3) continue;
    result.reason = fmt::format(
        "the Hessian has no positive pivot at vertex {}, even with {:.3g} N/m added to its diagonal", v, tried);
    result.worst_vertex = v;
  }
  return 0;
}

// A pair of parts cannot be shown to stay apart on any part of the step.
void Newton::refuse_standstill(const System& system, const Eigen::Matrix3Xd& x, Contact& contact,
                               NewtonResult& result) const {
  const Largest worst = largest_free_component(system, direction_);
  result.worst_vertex = worst.vertex;
  result.reason = fmt::format(
      "contact allows no part of a Newton step of {:.3g} m/s at vertex {}: the smallest gap is {:.3g} m, which "
      "positions "
      "hardly resolve; move the scene nearer to the origin, or raise the stiffness of contact",
      result.step_speed, worst.vertex, contact.status(x).smallest_gap);
}

// The line search found no better state: at the limit of rounding that is the end, anywhere else a failure.
void Newton::give_up_line_search(System& system, const Eigen::Matrix3Xd& x, Contact* contact, bool is_last,
                                 NewtonResult& result) {
  if (contact) contact->set_active(x);
  const Largest worst = largest_motion(system, direction_);
  if (trial_.at_rounding) {
    const Rounding rounding = measure_rounding(system, x, result.evaluation, gradient_);
    result.at_rounding = is_last || result.residual <= rounding_gradients * rounding.gradient;
    result.converged = result.at_rounding;
    if (result.converged) return;
  }
  result.reason = fmt::format(
      "no state along the Newton step is accepted after {} halvings, for {}; the step is {:.3g} m/s at vertex {}",
      trial_.halvings, trial_.rejected_by, result.step_speed, worst.vertex);
  result.worst_vertex = worst.vertex;
}

}  // namespace ergon
