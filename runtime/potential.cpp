#include "runtime/potential.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "runtime/error.h"
#include "runtime/nearest.h"
#include "runtime/potential_data.h"

namespace ergon {

std::string values_text(size_t count) { return fmt::format("{} value{}", count, count == 1 ? "" : "s"); }

void Potential::Impl::fail(const std::string& what) const {
  throw InputError(fmt::format("potential '{}': {}", name, what));
}

void Potential::Impl::bind(std::string potential_name, Kernel bound) {
  name = std::move(potential_name);
  kernel = std::move(bound);
  if (kernel->abi != ERGON_KERNEL_ABI) {
    fail(fmt::format("the kernel of {} has ABI {}, expected {}; compile it again", kernel->energy, kernel->abi,
                     ERGON_KERNEL_ABI));
  }
  if (kernel->q_vectors < 1 || kernel->q_vectors > lanes::kMaxVectors || kernel->points > lanes::kMaxPoints) {
    fail(fmt::format("{} has {} points and {} vectors in q; at most {} and {} can be evaluated", kernel->energy,
                     kernel->points, kernel->q_vectors, lanes::kMaxPoints, lanes::kMaxVectors));
  }
  lanes = kernel->lanes;
  single() ? lanes::single_lane_operations(lanes) : lanes::lane_operations(lanes);
  params.resize(static_cast<size_t>(kernel->params));
  (single() ? single_uniforms.resize(static_cast<size_t>(kernel->uniforms))
            : uniforms.resize(static_cast<size_t>(kernel->uniforms)));
  lag_set.assign(static_cast<size_t>(kernel->n_inputs), 0);
}

void Potential::Impl::bind_stencils(std::string potential_name, Kernel bound, const Parameters& values) {
  bind(std::move(potential_name), std::move(bound));
  if (kernel->density) fail(fmt::format("{} is a density: it needs a mesh, not stencils", kernel->energy));
  check_params(values);
  give_params(values);
}

const ErgonInput& Potential::Impl::input(const std::string& wanted, int role, const char* kind) const {
  std::vector<std::string> known;
  for (int i = 0; i < kernel->n_inputs; ++i) {
    const ErgonInput& candidate = kernel->inputs[i];
    if (candidate.role != role) continue;
    if (wanted == candidate.name) return candidate;
    known.push_back(candidate.name);
  }
  const std::string nearest = nearest_of(wanted, known);
  std::string remedy;
  if (!nearest.empty()) {
    remedy = fmt::format("; did you mean '{}'?", nearest);
  } else if (known.empty()) {
    remedy = fmt::format("; {} has none", kernel->energy);
  } else {
    remedy = fmt::format("; {} has {}", kernel->energy, fmt::join(known, ", "));
  }
  fail(fmt::format("'{}' is not a {} of {}{}", wanted, kind, kernel->energy, remedy));
}

void Potential::Impl::check_params(const Parameters& values) const {
  for (int i = 0; i < kernel->n_inputs; ++i) {
    const ErgonInput& needed = kernel->inputs[i];
    if (needed.role == ERGON_PARAM && values.count(needed.name) == 0) {
      fail(fmt::format("param '{}' of {} is missing; give {}", needed.name, kernel->energy,
                       values_text(static_cast<size_t>(size_of(needed)))));
    }
  }
}

void Potential::Impl::give_params(const Parameters& values) {
  for (const auto& [given, value] : values) {
    const ErgonInput& target = input(given, ERGON_PARAM, "param");
    if (value.size() != static_cast<size_t>(size_of(target))) {
      fail(fmt::format("param '{}' of {} takes {}, got {}", given, kernel->energy,
                       values_text(static_cast<size_t>(size_of(target))), value.size()));
    }
    for (const double v : value) {
      if (!std::isfinite(v)) fail(fmt::format("param '{}' of {} is {}, not a finite number", given, kernel->energy, v));
    }
    std::copy(value.begin(), value.end(), params.begin() + target.offset);
  }
  params_changed = true;
  ++param_version;
}

void Potential::Impl::prepare() {
  if (params_changed) {
    if (single()) {
      kernel->single->prepare_uniforms(params.data(), single_uniforms.data());
    } else if (kernel->uniforms > 0) {
      kernel->prepare_uniforms(params.data(), uniforms.data());
    }
    raw_changed = true;
    params_changed = false;
  }
  if (!raw_changed || count == 0) return;
  for (int i = 0; i < kernel->n_inputs; ++i) {
    if (kernel->inputs[i].role == ERGON_LAG && lag_set[static_cast<size_t>(i)] == 0) {
      throw std::logic_error(
          fmt::format("potential '{}': lag '{}' of {} was never set", name, kernel->inputs[i].name, kernel->energy));
    }
  }
  raw_changed = false;
  if (kernel->elements == 0) return;
  const auto width = static_cast<size_t>(lanes);
  const size_t in = static_cast<size_t>(kernel->raw) * width, out = static_cast<size_t>(kernel->elements) * width;
#pragma omp parallel for schedule(static) if (count > 4096)
  for (size_t place = 0; place < static_cast<size_t>(blocks() * quadrature); ++place) {
    if (single()) {
      kernel->single->prepare_elements(raw.data() + place * in, single_uniforms.data(),
                                       single_elements.data() + place * out);
    } else {
      kernel->prepare_elements(raw.data() + place * in, uniforms.data(), elements.data() + place * out);
    }
  }
}

lanes::Stencils Potential::Impl::view() const {
  const auto or_null = [](const auto& values) { return values.empty() ? nullptr : values.data(); };
  return {kernel.table,
          chunk,
          count,
          points,
          quadrature,
          vertices.data(),
          or_null(table),
          or_null(axis),
          or_null(axis_nodes),
          weights.data(),
          or_null(frames),
          volumes.data(),
          elements.data(),
          uniforms.data(),
          nullptr,
          nullptr,
          combined,
          single_elements.data(),
          single_uniforms.data()};
}

void Potential::set_param(const std::string& param, const std::vector<double>& values) {
  impl->give_params({{param, values}});
  if (impl->curvature) impl->curvature->give_params({{param, values}});
}

void Potential::follow(const std::string& name, TimedValues values) {
  impl->timed.insert_or_assign(name, std::move(values));
}

void Potential::set_time(double time) {
  for (const auto& timed : impl->timed) {
    const std::string& name = timed.first;
    const auto is_it = [&](const ErgonInput& input) { return name == input.name && input.role == ERGON_PARAM; };
    const ErgonInput* inputs = impl->kernel->inputs;
    const bool uniform = std::any_of(inputs, inputs + impl->kernel->n_inputs, is_it);
    uniform ? set_param(name, timed.second(time)) : set_rest(name, timed.second(time));
  }
}

bool Potential::follows_time() const { return !impl->timed.empty(); }

const std::string& Potential::name() const { return impl->name; }
const ErgonKernel& Potential::kernel() const { return *impl->kernel.table; }
int Potential::stencil_count() const { return impl->count; }
int Potential::points_per_stencil() const { return impl->listed; }
int Potential::quadrature_points() const { return impl->quadrature; }
const std::vector<int>& Potential::stencils() const { return impl->stencils; }

}  // namespace ergon
