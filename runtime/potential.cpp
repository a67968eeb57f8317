#include "runtime/potential.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "runtime/error.h"
#include "runtime/nearest.h"
#include "runtime/potential_data.h"

namespace ergon {
namespace {

// Enough chunks to keep many cores busy, each large enough for its vertices to be used many times.
constexpr int kChunks = 192;
constexpr int kSmallestChunk = 64;  // stencils
constexpr int kLargestChunk = 512;
constexpr int kChunkPairs = 7680;  // of points of a stencil: the sums of a chunk stay in the second-level cache

int size_of(const ErgonInput& input) { return input.rows * input.cols; }

std::string values_text(size_t n) { return fmt::format("{} value{}", n, n == 1 ? "" : "s"); }

}  // namespace

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
  lanes::lane_operations(lanes);
  params.resize(static_cast<size_t>(kernel->params));
  uniforms.resize(static_cast<size_t>(kernel->uniforms));
  lag_set.assign(static_cast<size_t>(kernel->n_inputs), 0);
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

void Potential::Impl::cut() {
  const int largest = std::clamp(kChunkPairs / (points * (points + 1) / 2), 2 * lanes, kLargestChunk);
  chunk = std::clamp(count / kChunks, std::min(kSmallestChunk, largest), largest) / lanes;
}

void Potential::Impl::order_vertices(const std::vector<int>& given) {
  const auto width = static_cast<size_t>(lanes), n = static_cast<size_t>(points);
  vertices.resize(static_cast<size_t>(blocks()) * n * width);
  for (int block = 0; block < blocks(); ++block) {
    for (size_t l = 0; l < width; ++l) {
      const auto stencil = static_cast<size_t>(stencil_in(block, static_cast<int>(l)));
      for (size_t a = 0; a < n; ++a) {
        vertices[(static_cast<size_t>(block) * n + a) * width + l] = given[stencil * n + a];
      }
    }
  }
}

void Potential::Impl::allocate_raw() {
  const auto width = static_cast<size_t>(blocks()) * static_cast<size_t>(lanes);
  raw.resize(width * static_cast<size_t>(kernel->raw));
  elements.resize(width * static_cast<size_t>(kernel->elements));
  raw_changed = true;
}

void Potential::Impl::write_raw(const ErgonInput& target, const std::vector<double>& values, const char* kind) {
  const auto size = static_cast<size_t>(size_of(target)), all = size * static_cast<size_t>(count);
  if (values.size() != size && values.size() != all) {
    fail(fmt::format("{} '{}' of {} takes {} for all stencils or {} for {}, got {}", kind, target.name, kernel->energy,
                     values_text(size), values_text(all), count, values.size()));
  }
  const size_t step = values.size() == all ? size : 0;
  const auto width = static_cast<size_t>(lanes), rows = static_cast<size_t>(kernel->raw);
  for (int block = 0; block < blocks(); ++block) {
    double* out = raw.data() + (static_cast<size_t>(block) * rows + static_cast<size_t>(target.offset)) * width;
    for (size_t l = 0; l < width; ++l) {
      const double* value = values.data() + step * static_cast<size_t>(stencil_in(block, static_cast<int>(l)));
      for (size_t c = 0; c < size; ++c) out[c * width + l] = value[c];
    }
  }
  raw_changed = true;
}

void Potential::Impl::give_rest(const Eigen::Matrix3Xd& X, const std::map<std::string, std::vector<double>>& rest) {
  for (const auto& [given, value] : rest) {
    const ErgonInput& target = input(given, ERGON_REST, "rest");
    const size_t expected = static_cast<size_t>(size_of(target)) * static_cast<size_t>(count);
    if (value.size() != expected) {
      fail(fmt::format("rest '{}' of {} takes {} for {} stencils, got {}", given, kernel->energy, values_text(expected),
                       count, value.size()));
    }
    write_raw(target, value, "rest");
  }
  for (int i = 0; i < kernel->n_inputs; ++i) {
    const ErgonInput& target = kernel->inputs[i];
    if (target.role != ERGON_REST || rest.count(target.name) != 0) continue;
    int point = -1;
    for (int a = 0; a < kernel->points && kernel->point_names != nullptr; ++a) {
      std::string capital = kernel->point_names[a];
      capital[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(capital[0])));
      if (capital == target.name && size_of(target) == 3) point = a;
    }
    if (point < 0) {
      fail(fmt::format("rest '{}' of {} is missing; give {} per stencil", target.name, kernel->energy,
                       values_text(static_cast<size_t>(size_of(target)))));
    }
    const auto width = static_cast<size_t>(lanes);
    for (size_t block = 0; block < static_cast<size_t>(blocks()); ++block) {
      const int* vertex = &vertices[(block * static_cast<size_t>(points) + static_cast<size_t>(point)) * width];
      double* out = &raw[(block * static_cast<size_t>(kernel->raw) + static_cast<size_t>(target.offset)) * width];
      for (size_t l = 0; l < width; ++l) {
        for (int c = 0; c < 3; ++c) out[static_cast<size_t>(c) * width + l] = X(c, vertex[l]);
      }
    }
  }
}

void Potential::Impl::prepare() {
  if (params_changed) {
    if (kernel->uniforms > 0) kernel->prepare_uniforms(params.data(), uniforms.data());
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
  for (size_t block = 0; block < static_cast<size_t>(blocks()); ++block) {
    kernel->prepare_elements(raw.data() + block * in, uniforms.data(), elements.data() + block * out);
  }
}

lanes::Stencils Potential::Impl::view() const {
  const auto or_null = [](const auto& values) { return values.empty() ? nullptr : values.data(); };
  return {kernel.table,        chunk,           count,          points,
          quadrature,          vertices.data(), or_null(table), or_null(axis),
          or_null(axis_nodes), weights.data(),  volumes.data(), elements.data(),
          uniforms.data(),     nullptr,         nullptr};
}

Potential Potential::on_stencils(std::string name, Kernel kernel, std::vector<int> stencils, const Eigen::Matrix3Xd& X,
                                 const Parameters& params, const std::map<std::string, std::vector<double>>& rest) {
  Potential potential{std::make_shared<Impl>()};
  Impl& d = *potential.impl;
  d.bind(std::move(name), std::move(kernel));
  if (d.kernel->density) d.fail(fmt::format("{} is a density: it needs a mesh, not stencils", d.kernel->energy));
  d.points = d.kernel->points;
  d.check_params(params);
  d.give_params(params);
  potential.set_stencils(std::move(stencils), X, rest);
  return potential;
}

void Potential::set_stencils(std::vector<int> stencils, const Eigen::Matrix3Xd& X,
                             const std::map<std::string, std::vector<double>>& rest) {
  Impl& d = *impl;
  if (d.kernel->density) throw std::logic_error("set_stencils: a density keeps the cells of its mesh");
  if (stencils.size() % static_cast<size_t>(d.points) != 0) {
    d.fail(fmt::format("{} vertices do not make whole stencils of {} points", stencils.size(), d.points));
  }
  for (size_t i = 0; i < stencils.size(); ++i) {
    if (stencils[i] < 0 || stencils[i] >= X.cols()) {
      d.fail(fmt::format("stencil {} names vertex {}; vertices are 0 to {}", i / static_cast<size_t>(d.points),
                         stencils[i], X.cols() - 1));
    }
    const size_t first = i - i % static_cast<size_t>(d.points);
    for (size_t k = first; k < i; ++k) {
      if (stencils[k] != stencils[i]) continue;
      d.fail(fmt::format("stencil {} names vertex {} twice", i / static_cast<size_t>(d.points), stencils[i]));
    }
  }
  d.stencils = std::move(stencils);
  d.count = static_cast<int>(d.stencils.size()) / d.points;
  d.cut();
  d.order_vertices(d.stencils);
  d.allocate_raw();
  std::fill(d.lag_set.begin(), d.lag_set.end(), char{0});
  d.give_rest(X, rest);
  ++d.stencil_version;
}

void Potential::set_lag(const std::string& lag, const std::vector<double>& values) {
  const ErgonInput& target = impl->input(lag, ERGON_LAG, "lag");
  impl->write_raw(target, values, "lag");
  impl->lag_set[static_cast<size_t>(&target - impl->kernel->inputs)] = 1;
  ++impl->lag_version;
}

void Potential::set_param(const std::string& param, const std::vector<double>& values) {
  impl->give_params({{param, values}});
}

const std::string& Potential::name() const { return impl->name; }
const ErgonKernel& Potential::kernel() const { return *impl->kernel.table; }
int Potential::stencil_count() const { return impl->count; }
int Potential::points_per_stencil() const { return impl->points; }
int Potential::quadrature_points() const { return impl->quadrature; }
const std::vector<int>& Potential::stencils() const { return impl->stencils; }

}  // namespace ergon
