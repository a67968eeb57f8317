#include "tools/accuracy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "codegen/parts.h"
#include "runtime/aligned.h"
#include "runtime/lanes/lanes.h"
#include "tools/accuracy_states.h"
#include "tools/installation.h"

namespace ergon {
namespace {

constexpr int digits = 50;

// Value, gradient over all coordinates of the dofs, full Hessian: what is compared.
using Results = std::array<std::vector<double>, 3>;

double norm(const std::vector<double>& v) {
  double largest = 0;
  for (const double x : v) largest = std::isnan(x) ? x : std::max(largest, std::abs(x));
  if (!(largest > 0)) return largest;
  double sum = 0;
  for (const double x : v) sum += (x / largest) * (x / largest);
  return largest * std::sqrt(sum);
}

// |a - b|/|b|
double relative_error(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> difference(a.size());
  for (size_t i = 0; i < a.size(); ++i) difference[i] = a[i] - b[i];
  const double error = norm(difference);
  return error == 0 ? 0 : std::isnan(error) ? std::numeric_limits<double>::infinity() : error / norm(b);
}

// One state in all lanes of a kernel.
class Evaluation {
 public:
  Evaluation(const ErgonKernel& kernel, const AccuracyState& state) : k_(kernel) {
    if (k_.single != nullptr)
      evaluate<float>(*k_.single, state);
    else
      evaluate<double>(k_, state);
  }

  Results result;

 private:
  template <class Real, class Entries>
  void evaluate(const Entries& entries, const AccuracyState& state) {
    const auto width = static_cast<size_t>(k_.lanes);
    AlignedVector<double> params(static_cast<size_t>(k_.params) + 1), raw(static_cast<size_t>(k_.raw) * width + 8);
    AlignedVector<Real> u(static_cast<size_t>(k_.uniforms) + 1), e(static_cast<size_t>(k_.elements) * width + 16);
    for (int i = 0; i < k_.n_inputs; ++i) {
      const ErgonInput& input = k_.inputs[i];
      const std::vector<double>& values = state.inputs.at(input.name);
      for (size_t c = 0; c < values.size(); ++c) {
        const size_t at = static_cast<size_t>(input.offset) + c;
        if (input.role == ERGON_PARAM)
          params[at] = values[c];
        else
          std::fill_n(raw.begin() + static_cast<long>(at * width), width, values[c]);
      }
    }
    entries.prepare_uniforms(params.data(), u.data());
    entries.prepare_elements(raw.data(), u.data(), e.data());

    const std::vector<double> points = kernel_points(state, k_.displacement != 0);
    const auto n = static_cast<size_t>(k_.density ? k_.q_vectors + 1 : k_.points);
    const auto m = static_cast<size_t>(3 * k_.q_vectors), packed = m * (m + 1) / 2;
    AlignedVector<Real> q(m * width), value(width), gradient(m * width), hessian(packed * width);
    for (size_t r = 0; r < m; ++r) {
      double sum = 0;
      for (size_t p = 0; p < n; ++p) sum += weight(r / 3, p) * points[3 * p + r % 3];
      std::fill_n(q.begin() + static_cast<long>(r * width), width, static_cast<Real>(sum));
    }
    AlignedVector<Real> margin(width);
    const auto& operations =
        k_.single != nullptr ? lanes::single_lane_operations(k_.lanes) : lanes::lane_operations(k_.lanes);
    operations.evaluate_at(k_, q.data(), e.data(), u.data(), value.data(), margin.data(), gradient.data(),
                           hessian.data());
    result[0] = {value[0]};
    std::vector<double> whole(packed, 0);
    const std::vector<Entry> entries_in_order = hessian_entries(k_);
    for (size_t i = 0; i < entries_in_order.size(); ++i) {
      const auto row = static_cast<size_t>(entries_in_order[i].row),
                 column = static_cast<size_t>(entries_in_order[i].column);
      whole[row * (row + 1) / 2 + column] = hessian[i * width];
    }
    auto h = [&](size_t a, size_t b) { return whole[std::max(a, b) * (std::max(a, b) + 1) / 2 + std::min(a, b)]; };
    const size_t dofs = k_.density ? m : 3 * n;
    for (size_t i = 0; i < dofs; ++i) {
      double sum = 0;
      for (size_t r = 0; r < m; ++r) sum += chain(r, i) * gradient[r * width];
      result[1].push_back(sum);
    }
    for (size_t i = 0; i < dofs; ++i)
      for (size_t j = 0; j < dofs; ++j) {
        double sum = 0;
        for (size_t r = i % 3; r < m; r += 3)
          for (size_t s = j % 3; s < m; s += 3) sum += chain(r, i) * h(r, s) * chain(s, j);
        result[2].push_back(sum);
      }
  }

  // Of the point in the 3-vector of q; the gradients of a simplex of the coordinate axes for a density.
  double weight(size_t vector, size_t point) const {
    if (k_.density) return point == 0 ? -1 : point == vector + 1 ? 1 : 0;
    return k_.weights[vector * static_cast<size_t>(k_.points) + point];
  }
  // dq/d(dof)
  double chain(size_t row, size_t dof) const {
    if (k_.density) return row == dof ? 1 : 0;
    return row % 3 == dof % 3 ? weight(row / 3, dof / 3) : 0;
  }

  const ErgonKernel& k_;
};

struct Exact {
  Exact(const Energy& energy, const std::string& case_name, const ExactInputs& inputs) {
    const ReferenceValue at = evaluate_reference_at(energy, case_name, inputs, digits);
    result[0] = {at.value}, result[1] = at.gradient, result[2] = at.hessian;
  }
  Results result;
};

Ulps summary(std::vector<double> errors) {
  std::sort(errors.begin(), errors.end());
  return {errors[(errors.size() - 1) / 2], errors.back()};
}

class Measurement {
 public:
  Measurement(const Energy& energy, const std::string& case_name, const AccuracyOptions& asked)
      : energy_(energy), case_name_(case_name), unit_(asked.single ? 0x1p-24 : 0x1p-53) {
    CompileOptions options = compile_options(case_name, asked.lanes);
    options.single = asked.single;
    emitted_ = compile(energy, options);
    options.stable = false;
    naive_ = compile(energy, options);
  }

  void add(const AccuracyState& state, std::mt19937_64& random) {
    const bool displacement = emitted_.table->displacement != 0;
    const Exact exact(energy_, case_name_, exact_inputs(energy_, state, displacement, {}));
    const std::array<double, 3> condition = condition_of(state, exact, random);
    const Evaluation naive(*naive_.table, state), emitted(*emitted_.table, state);
    for (size_t i = 0; i < 3; ++i) {
      naive_errors_[i].push_back(relative_error(naive.result[i], exact.result[i]) / unit_);
      emitted_errors_[i].push_back(relative_error(emitted.result[i], exact.result[i]) / unit_);
      out_.condition[i] = std::max(out_.condition[i], condition[i]);
      out_.excess[i] = std::max(out_.excess[i], emitted_errors_[i].back() / (1 + condition[i]));
    }
    ++out_.states;
  }

  // Largest relative change per relative change of all inputs at once, each up or down at random. Steps are small
  // enough for the change to be linear: near contact a gap is far smaller than what steps of a fixed size would do to
  // it.
  std::array<double, 3> condition_of(const AccuracyState& state, const Exact& exact, std::mt19937_64& random) const {
    std::array<double, 3> out{};
    for (int sample = 0; sample < 8; ++sample) {
      std::vector<double> signs(input_count(state));
      for (double& sign : signs) sign = random() % 2 == 0 ? 1 : -1;
      for (double step = 1e-7; step > 1e-24; step *= 1e-3) {
        std::vector<double> relative = signs;
        for (double& r : relative) r *= step;
        const Exact near(energy_, case_name_,
                         exact_inputs(energy_, state, emitted_.table->displacement != 0, relative));
        bool linear = true;
        std::array<double, 3> change{};
        for (size_t i = 0; i < 3; ++i) {
          change[i] = relative_error(near.result[i], exact.result[i]);
          linear = linear && change[i] < 1e-3;
        }
        if (!linear) continue;
        for (size_t i = 0; i < 3; ++i) out[i] = std::max(out[i], change[i] / step);
        break;
      }
    }
    return out;
  }

  // What was measured since the last call.
  Accuracy take(double strain) {
    out_.strain = strain;
    for (size_t i = 0; i < 3 && out_.states > 0; ++i) {
      out_.naive[i] = summary(std::exchange(naive_errors_[i], {}));
      out_.emitted[i] = summary(std::exchange(emitted_errors_[i], {}));
    }
    return std::exchange(out_, {});
  }

 private:
  const Energy& energy_;
  const std::string& case_name_;
  double unit_;
  CompiledKernel emitted_, naive_;
  Accuracy out_;
  std::vector<double> naive_errors_[3], emitted_errors_[3];
};

}  // namespace

std::vector<Accuracy> measure_accuracy(const Energy& energy, const std::string& case_name,
                                       const AccuracyOptions& options) {
  Measurement measurement(energy, case_name, options);
  std::mt19937_64 random(1);
  std::vector<Accuracy> out;
  const int first = static_cast<int>(std::lround(std::log10(options.smallest)));
  const int last = static_cast<int>(std::lround(std::log10(options.largest)));
  for (int decade = first; decade <= last; ++decade) {
    const double strain = std::pow(10.0, decade);
    for (int i = 0; i < options.directions; ++i)
      if (const auto state = accuracy_state(energy, case_name, strain, random)) measurement.add(*state, random);
    const Accuracy at = measurement.take(strain);
    if (at.states > 0) out.push_back(at);
  }
  return out;
}

}  // namespace ergon
