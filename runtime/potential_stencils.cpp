// Lists of stencils and the data of each, brought into the order of lanes.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "runtime/potential_data.h"

namespace ergon {
namespace {

// Enough chunks to keep many cores busy, each large enough for its vertices to be used many times.
constexpr int kChunks = 192;
constexpr int kSmallestChunk = 64;  // stencils
constexpr int kLargestChunk = 512;
constexpr int kChunkPairs = 7680;  // of points of a stencil: the sums of a chunk stay in the second-level cache

// Weights of a stencil that add to no more than this of their magnitudes add to zero.
constexpr double kRounding = 1e-14;

}  // namespace

void Potential::Impl::cut() {
  const int largest = std::clamp(kChunkPairs / (points * (points + 1) / 2), 2 * lanes, kLargestChunk);
  chunk = std::clamp(count / kChunks, std::min(kSmallestChunk, largest), largest) / lanes;
  lane_stencil.resize(static_cast<size_t>(blocks() * lanes));
  for (int block = 0, i = 0; block < blocks(); ++block) {
    const int first = block / chunk * chunk, n = std::min(chunk, blocks() - first);
    const int last = std::min((first + n) * lanes, count) - 1;
    for (int l = 0; l < lanes; ++l, ++i) {
      const int place = std::min(first * lanes + l * n + block - first, last);
      lane_stencil[static_cast<size_t>(i)] = order.empty() ? place : order[static_cast<size_t>(place)];
    }
  }
}

// Stencils that share vertices stand near each other: by their smallest vertex, in the order given where that is equal.
void Potential::Impl::order_stencils() {
  const auto n = static_cast<size_t>(listed);
  order.clear();
  keys.resize(static_cast<size_t>(count));
  int largest = 0;
  bool sorted = true;
  for (size_t s = 0; s < keys.size(); ++s) {
    int key = stencils[s * n + static_cast<size_t>(used[0])];
    for (const int place : used) key = std::min(key, stencils[s * n + static_cast<size_t>(place)]);
    sorted = sorted && (s == 0 || keys[s - 1] <= key);
    keys[s] = key;
    largest = std::max(largest, key);
  }
  if (sorted) return;
  start.assign(static_cast<size_t>(largest) + 2, 0);
  for (const int key : keys) ++start[static_cast<size_t>(key) + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  order.resize(keys.size());
  for (size_t s = 0; s < keys.size(); ++s) {
    order[static_cast<size_t>(start[static_cast<size_t>(keys[s])]++)] = static_cast<int>(s);
  }
}

void Potential::Impl::order_vertices(const std::vector<int>& given, int step, const std::vector<int>& chosen) {
  const auto width = static_cast<size_t>(lanes), n = static_cast<size_t>(points);
  vertices.resize(lane_stencil.size() * n);
  int* out = vertices.data();
  for (size_t lane = 0; lane < lane_stencil.size(); lane += width, out += n * width) {
    for (size_t l = 0; l < width; ++l) {
      const int* stencil = given.data() + static_cast<ptrdiff_t>(lane_stencil[lane + l]) * step;
      for (size_t a = 0; a < n; ++a) out[a * width + l] = stencil[chosen[a]];
    }
  }
}

void Potential::Impl::allocate_raw() {
  const size_t places = lane_stencil.size() * static_cast<size_t>(quadrature);
  raw.resize(places * static_cast<size_t>(kernel->raw));
  const size_t kept = places * static_cast<size_t>(kernel->elements);
  single() ? single_elements.resize(kept) : elements.resize(kept);
  raw_changed = true;
}

void Potential::Impl::write_raw(const ErgonInput& target, const std::vector<double>& values, const char* kind) {
  const auto size = static_cast<size_t>(size_of(target)), all = size * static_cast<size_t>(count);
  const auto points = static_cast<size_t>(quadrature);
  if (values.size() != size && values.size() != all && values.size() != all * points) {
    fail(fmt::format("{} '{}' of {} takes {} for all stencils or {} for {}{}, got {}", kind, target.name,
                     kernel->energy, values_text(size), values_text(all), count,
                     points == 1 ? "" : fmt::format(" or {} for their points of quadrature", values_text(all * points)),
                     values.size()));
  }
  const size_t step = values.size() == size ? 0 : values.size() == all ? size : size * points;
  const size_t within = values.size() == all * points && points > 1 ? size : 0;  // from point to point
  const auto width = static_cast<size_t>(lanes), rows = static_cast<size_t>(kernel->raw);
  double* out = raw.data() + static_cast<size_t>(target.offset) * width;
  for (size_t lane = 0; lane < lane_stencil.size(); lane += width) {
    for (size_t p = 0; p < points; ++p, out += rows * width) {
      for (size_t c = 0; c < size; ++c) {
        for (size_t l = 0; l < width; ++l) {
          out[c * width + l] = values[step * static_cast<size_t>(lane_stencil[lane + l]) + within * p + c];
        }
      }
    }
  }
  raw_changed = true;
}

void Potential::Impl::give_rest(const Eigen::Matrix3Xd& X, const StencilData& rest) {
  for (const auto& [given, value] : rest) {
    const ErgonInput& target = input(given, ERGON_REST, "rest");
    const size_t expected = static_cast<size_t>(size_of(target)) * static_cast<size_t>(count);
    if (value.size() != expected && value.size() != expected * static_cast<size_t>(quadrature)) {
      fail(fmt::format("rest '{}' of {} takes {} for {} stencils, got {}", given, kernel->energy, values_text(expected),
                       count, value.size()));
    }
    write_raw(target, value, "rest");
  }
  for (int i = 0; i < kernel->n_inputs; ++i) {
    const ErgonInput& target = kernel->inputs[i];
    if (target.role != ERGON_REST || rest.count(target.name) != 0) continue;
    int place = -1;
    for (size_t a = 0; a < names.size() && kernel->point_names != nullptr && size_of(target) == 3; ++a) {
      const char* point = kernel->point_names[names[a]];
      if (std::toupper(static_cast<unsigned char>(point[0])) != target.name[0]) continue;
      if (std::string_view(point + 1) == target.name + 1) place = static_cast<int>(a);
    }
    if (place < 0) {
      fail(fmt::format("rest '{}' of {} is missing; give {} per stencil", target.name, kernel->energy,
                       values_text(static_cast<size_t>(size_of(target)))));
    }
    const auto width = static_cast<size_t>(lanes);
    double* out = raw.data() + static_cast<size_t>(target.offset) * width;
    for (size_t lane = 0; lane < lane_stencil.size(); lane += width, out += static_cast<size_t>(kernel->raw) * width) {
      for (size_t l = 0; l < width; ++l) {
        const int* stencil = stencils.data() + static_cast<ptrdiff_t>(lane_stencil[lane + l]) * listed;
        for (int c = 0; c < 3; ++c) out[static_cast<size_t>(c) * width + l] = X(c, stencil[place]);
      }
    }
  }
}

void Potential::Impl::list_points(bool all) {
  for (int a = 0; a < kernel->points; ++a) {
    bool weighs = false;
    for (int k = 0; k < kernel->q_vectors; ++k) weighs = weighs || kernel->weights[k * kernel->points + a] != 0;
    if (weighs) used.push_back(all ? a : static_cast<int>(used.size()));
    if (weighs || all) names.push_back(a);
  }
  listed = static_cast<int>(names.size());
  points = static_cast<int>(used.size());
  for (int k = 0; k < kernel->q_vectors; ++k) {
    for (const int place : used) {
      weights.push_back(kernel->weights[k * kernel->points + names[static_cast<size_t>(place)]]);
    }
  }
}

void Potential::Impl::take_list(const std::vector<int>& given, int vertex_count) {
  const auto n = static_cast<size_t>(listed);
  if (given.size() % n != 0) {
    fail(fmt::format("{} vertices do not make whole stencils of {} points", given.size(), n));
  }
  for (size_t s = 0; s * n < given.size(); ++s) {
    const int* stencil = given.data() + s * n;
    for (size_t a = 0; a < n; ++a) {
      if (stencil[a] < 0 || (vertex_count >= 0 && stencil[a] >= vertex_count)) {
        fail(fmt::format("stencil {} names vertex {}; vertices are 0 to {}", s, stencil[a],
                         vertex_count < 0 ? "the system's last" : std::to_string(vertex_count - 1)));
      }
      for (size_t b = 0; b < a; ++b) {
        if (stencil[b] == stencil[a]) fail(fmt::format("stencil {} names vertex {} twice", s, stencil[a]));
      }
    }
  }
  stencils.assign(given.begin(), given.end());
  count = static_cast<int>(stencils.size() / n);
  order_stencils();
  cut();
  order_vertices(stencils, listed, used);
  allocate_raw();
  std::fill(lag_set.begin(), lag_set.end(), char{0});
  ++stencil_version;
}

void Potential::Impl::take_weights(const std::vector<double>& given) {
  const auto width = static_cast<size_t>(lanes), n = static_cast<size_t>(points);
  const auto vectors = static_cast<size_t>(kernel->q_vectors);
  weights.resize(lane_stencil.size() * vectors * (n + 1));
  double* out = weights.data();
  for (size_t lane = 0; lane < lane_stencil.size(); lane += width, out += vectors * (n + 1) * width) {
    for (size_t l = 0; l < width; ++l) {
      const double* from = given.data() + static_cast<size_t>(lane_stencil[lane + l]) * vectors * n;
      double* to = out + l;
      for (size_t k = 0; k < vectors; ++k, from += n, to += (n + 1) * width) {
        double sum = 0, size = 0;
        for (size_t a = 0; a < n; ++a) {
          to[a * width] = from[a];
          sum += from[a];
          size += std::abs(from[a]);
        }
        to[n * width] = std::abs(sum) > kRounding * size ? sum : 0;
      }
    }
  }
}

Potential Potential::on_stencils(std::string name, Kernel kernel, const std::vector<int>& stencils,
                                 const Eigen::Matrix3Xd& X, const Parameters& params, const StencilData& rest) {
  Potential potential{std::make_shared<Impl>()};
  if (kernel.curvature)
    potential.impl->curvature = on_stencils(name, *kernel.curvature, stencils, X, params, rest).impl;
  potential.impl->bind_stencils(std::move(name), std::move(kernel), params);
  potential.impl->list_points(true);
  potential.set_stencils(stencils, X, rest);
  return potential;
}

Potential Potential::on_used_points(std::string name, Kernel kernel, const std::vector<int>& stencils,
                                    const Eigen::Matrix3Xd& X, const Parameters& params, const StencilData& rest) {
  Potential potential{std::make_shared<Impl>()};
  if (kernel.curvature)
    potential.impl->curvature = on_used_points(name, *kernel.curvature, stencils, X, params, rest).impl;
  potential.impl->bind_stencils(std::move(name), std::move(kernel), params);
  potential.impl->list_points(false);
  potential.set_stencils(stencils, X, rest);
  return potential;
}

Potential Potential::on_combinations(std::string name, Kernel kernel, int points, const Parameters& params) {
  Potential potential{std::make_shared<Impl>()};
  Impl& d = *potential.impl;
  if (kernel.curvature) d.curvature = on_combinations(name, *kernel.curvature, points, params).impl;
  d.bind_stencils(std::move(name), std::move(kernel), params);
  if (points < 1 || points > lanes::kMaxCombined) {
    d.fail(fmt::format("combinations of {} points; 1 to {} can be evaluated", points, lanes::kMaxCombined));
  }
  if (d.kernel->q_vectors > lanes::kMaxCombinedVectors) {
    d.fail(fmt::format("combinations for {} vectors of q; at most {} can be evaluated", d.kernel->q_vectors,
                       lanes::kMaxCombinedVectors));
  }
  d.combined = true;
  d.points = d.listed = points;
  d.used.resize(static_cast<size_t>(points));
  std::iota(d.used.begin(), d.used.end(), 0);
  d.take_list({}, -1);
  return potential;
}

void Potential::set_stencils(const std::vector<int>& stencils, const Eigen::Matrix3Xd& X, const StencilData& rest) {
  if (impl->kernel->density) throw std::logic_error("set_stencils: a density keeps the cells of its mesh");
  if (impl->combined) throw std::logic_error("set_stencils: combinations need their weights; use set_combinations");
  impl->take_list(stencils, static_cast<int>(X.cols()));
  impl->give_rest(X, rest);
  if (impl->curvature) Potential{impl->curvature}.set_stencils(stencils, X, rest);
}

void Potential::set_combinations(const std::vector<int>& stencils, const std::vector<double>& weights,
                                 const StencilData& rest) {
  if (!impl->combined) throw std::logic_error("set_combinations: the weights are those of the kernel");
  const size_t vectors = static_cast<size_t>(impl->kernel->q_vectors);
  if (weights.size() != stencils.size() * vectors) {
    impl->fail(fmt::format("combinations of {} vertices and {} vectors in q take {} weights, got {}", stencils.size(),
                           vectors, stencils.size() * vectors, weights.size()));
  }
  impl->take_list(stencils, -1);
  impl->take_weights(weights);
  impl->give_rest({}, rest);
  if (impl->curvature) Potential{impl->curvature}.set_combinations(stencils, weights, rest);
}

void Potential::set_rest(const std::string& rest, const std::vector<double>& values) {
  impl->write_raw(impl->input(rest, ERGON_REST, "rest"), values, "rest");
  ++impl->param_version;
  if (impl->curvature) Potential{impl->curvature}.set_rest(rest, values);
}

void Potential::set_lag(const std::string& lag, const std::vector<double>& values) {
  const ErgonInput& target = impl->input(lag, ERGON_LAG, "lag");
  impl->write_raw(target, values, "lag");
  impl->lag_set[static_cast<size_t>(&target - impl->kernel->inputs)] = 1;
  ++impl->lag_version;
  if (impl->curvature) Potential{impl->curvature}.set_lag(lag, values);
}

}  // namespace ergon
