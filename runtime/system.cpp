#include "runtime/system.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "runtime/system_data.h"

namespace ergon {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Stencil points below which starting the threads costs more than they save.
constexpr long kWorthThreads = 8192;

// Runs f(chunk) for all chunks of a term, colour by colour. Called by all threads of a team.
template <class F>
void over_colours(const SystemTerm& term, F f) {
  for (size_t colour = 0; colour + 1 < term.colour_start.size(); ++colour) {
#pragma omp for schedule(dynamic, 1)
    for (int c = term.colour_start[colour]; c < term.colour_start[colour + 1]; ++c) {
      f(term.chunks[static_cast<size_t>(c)]);
    }
  }
}

}  // namespace

System::System(int vertices) : impl(std::make_shared<Impl>()) {
  impl->vertices = vertices;
  set_fixed(std::vector<char>(static_cast<size_t>(vertices), 0));
  impl->x.resize(4 * static_cast<size_t>(vertices), 0.0);
  impl->gradient.resize(4 * static_cast<size_t>(vertices), 0.0);
  impl->taken.resize(static_cast<size_t>(vertices), 0);
}

int System::vertices() const { return impl->vertices; }
int System::free_vertices() const { return impl->numbers.free; }
int System::block_of(int vertex) const { return impl->numbers.block_of[static_cast<size_t>(vertex)]; }
bool System::moves(int vertex) const { return impl->numbers.number[static_cast<size_t>(vertex)] >= 0; }
Potential& System::potential(int index) { return impl->terms[impl->first_terms[static_cast<size_t>(index)]].potential; }
int System::potential_count() const { return static_cast<int>(impl->first_terms.size()); }

void System::set_fixed(const std::vector<char>& fixed) {
  if (fixed.size() != static_cast<size_t>(impl->vertices)) {
    throw std::invalid_argument("set_fixed: one entry per vertex is needed");
  }
  impl->fixed = fixed;
  impl->number_vertices();
}

int System::add(Potential potential) {
  const std::shared_ptr<Potential::Impl> curvature = potential.impl->curvature;
  impl->first_terms.push_back(impl->terms.size());
  impl->add_term(std::move(potential), true, curvature == nullptr);
  if (curvature) impl->add_term(Potential{curvature}, false, true);
  return potential_count() - 1;
}

void System::Impl::add_term(Potential potential, bool gives_gradient, bool gives_hessian) {
  terms.emplace_back(std::move(potential));
  SystemTerm& term = terms.back();
  term.gives_gradient = gives_gradient;
  term.gives_hessian = gives_hessian;
  const int width = term.data().lanes;
  term.operations = term.data().single() ? &lanes::single_lane_operations(width) : &lanes::lane_operations(width);
  find_configuration(term);
  term.check(vertices);
}

void System::Impl::prepare(bool coloured) {
  if (rooms.size() < static_cast<size_t>(omp_get_max_threads())) {
    rooms.resize(static_cast<size_t>(omp_get_max_threads()));
    for (SystemRoom& room : rooms) room.place.resize(static_cast<size_t>(vertices));
  }
  for (SystemTerm& term : terms) {
    term.data().prepare();
    term.check(vertices);
    if (coloured) term.colour(rooms, taken, numbers.lead);
    term.stencils = term.data().view();
    term.stencils.slots = term.slots.data();
    term.stencils.turned = term.turned.data();
  }
}

bool System::Impl::worth_threads() const {
  long work = 0;
  for (const SystemTerm& term : terms) work += static_cast<long>(term.stencils.count) * term.stencils.points;
  return work > kWorthThreads;
}

void System::Impl::load_positions(const Eigen::Matrix3Xd& positions) {
  if (positions.cols() != vertices) throw std::invalid_argument("System: one position per vertex is needed");
  const double* from = positions.data();
  if (std::any_of(terms.begin(), terms.end(), [](const SystemTerm& t) { return t.configuration < 0; })) {
#pragma omp parallel for schedule(static) if (vertices > kWorthThreads)
    for (int v = 0; v < vertices; ++v) {
      for (ptrdiff_t c = 0; c < 3; ++c) x[static_cast<size_t>(4L * v + c)] = from[3L * v + c];
    }
  }
  for (RestConfiguration& configuration : configurations) {
    const double* X = configuration.X.data();
    double* moved = configuration.displacement.data();
#pragma omp parallel for schedule(static) if (vertices > kWorthThreads)
    for (int v = 0; v < vertices; ++v) {
      for (ptrdiff_t c = 0; c < 3; ++c) moved[4L * v + c] = from[3L * v + c] - X[3L * v + c];
    }
  }
}

const double* System::Impl::points_of(const SystemTerm& term) const {
  if (term.configuration < 0) return x.data();
  return configurations[static_cast<size_t>(term.configuration)].displacement.data();
}

void System::Impl::find_configuration(SystemTerm& term) {
  const Potential::Impl& d = term.data();
  if (d.rest.cols() == 0) return;
  const auto first = static_cast<size_t>(d.first_vertex), count = static_cast<size_t>(d.rest.cols());
  if (first + count > static_cast<size_t>(vertices)) throw std::invalid_argument("add: the mesh exceeds the system");
  const auto agrees = [&](const RestConfiguration& c) {
    for (size_t v = 0; v < count; ++v) {
      const double* kept = c.X.data() + 3 * (first + v);
      if (c.known[first + v] && !std::equal(kept, kept + 3, d.rest.data() + 3 * v)) return false;
    }
    return true;
  };
  const auto found = std::find_if(configurations.begin(), configurations.end(), agrees);
  term.configuration = static_cast<int>(found - configurations.begin());
  if (found == configurations.end()) {
    const auto all = static_cast<size_t>(vertices);
    configurations.push_back(
        {std::vector<char>(all, 0), Eigen::Matrix3Xd::Zero(3, vertices), AlignedVector<double>(4 * all, 0.0)});
  }
  RestConfiguration& c = configurations[static_cast<size_t>(term.configuration)];
  for (size_t v = 0; v < count; ++v) {
    c.known[first + v] = 1;
    std::copy_n(d.rest.data() + 3 * v, 3, c.X.data() + 3 * (first + v));
  }
}

Evaluation System::Impl::sum(bool margins, bool hessians) const {
  Evaluation evaluation;
  evaluation.require = kInfinity;
  for (const SystemTerm& term : terms) {
    double value = 0, require = kInfinity;
    for (const lanes::ChunkResult& chunk : term.results) {
      value += chunk.value;
      require = std::min(require, chunk.require);
      evaluation.indefinite += hessians ? chunk.indefinite : 0;
    }
    if (!term.gives_gradient) continue;
    evaluation.value += value;
    evaluation.by_potential.push_back(value);
    if (margins && require < evaluation.require) {
      evaluation.require = require;
      if (!(require > 0)) evaluation.violated = term.potential.name();
    }
  }
  return evaluation;
}

Evaluation System::value(const Eigen::Matrix3Xd& x) {
  Impl& d = *impl;
  d.prepare(false);
  d.load_positions(x);
#pragma omp parallel if (d.worth_threads())
  for (SystemTerm& term : d.terms) {
    if (!term.gives_gradient) continue;
#pragma omp for schedule(dynamic, 1) nowait
    for (size_t chunk = 0; chunk < term.results.size(); ++chunk) {
      const lanes::BlockRange range = term.range(static_cast<int>(chunk));
      term.operations->value(term.stencils, range, d.points_of(term), &term.results[chunk]);
    }
  }
  Evaluation evaluation = d.sum(true);
  evaluation.value += damping(x, nullptr) + coupled_inertia(x, nullptr);
  return evaluation;
}

Evaluation System::gradient(const Eigen::Matrix3Xd& x, Eigen::Matrix3Xd& gradient) {
  impl->sum_gradients(x, gradient, [](size_t) { return true; });
  Evaluation evaluation = impl->sum(false);
  evaluation.value += damping(x, &gradient) + coupled_inertia(x, &gradient);
  guide(gradient);
  return evaluation;
}

void System::gradient_of(const std::vector<int>& potentials, const Eigen::Matrix3Xd& x, Eigen::Matrix3Xd& gradient) {
  std::vector<char> wanted(impl->terms.size(), 0);
  for (const int i : potentials) wanted[impl->first_terms[static_cast<size_t>(i)]] = 1;
  impl->sum_gradients(x, gradient, [&](size_t term) { return wanted[term] != 0; });
}

template <class F>
void System::Impl::sum_gradients(const Eigen::Matrix3Xd& x, Eigen::Matrix3Xd& sum, F wanted) {
  prepare(true);
  load_positions(x);
  sum.resize(3, vertices);
#pragma omp parallel if (worth_threads())
  {
#pragma omp for schedule(static)
    for (size_t i = 0; i < gradient.size(); ++i) gradient[i] = 0;
    for (size_t t = 0; t < terms.size(); ++t) {
      SystemTerm& term = terms[t];
      if (!term.gives_gradient || !wanted(t)) continue;
      over_colours(term, [&](int chunk) {
        term.operations->gradient(term.stencils, term.range(chunk), points_of(term), gradient.data(),
                                  &term.results[static_cast<size_t>(chunk)]);
      });
    }
#pragma omp for schedule(static)
    for (int v = 0; v < vertices; ++v) {
      for (int c = 0; c < 3; ++c) sum(c, v) = gradient[4 * static_cast<size_t>(v) + static_cast<size_t>(c)];
    }
  }
  numbers.carriers.collect(sum);
}

Evaluation System::hessian(const Eigen::Matrix3Xd& x, Projection projection, Eigen::Matrix3Xd& gradient,
                           BlockMatrix& matrix) {
  Impl& d = *impl;
  d.prepare(true);
  d.load_positions(x);
  d.update_pattern();
  if (matrix.pattern_id() != d.pattern->id) matrix.set_pattern(d.pattern);
  d.update_base(projection);
  d.update_first();
  gradient.resize(3, d.vertices);
#pragma omp parallel if (d.worth_threads())
  {
    SystemRoom& room = d.rooms[static_cast<size_t>(omp_get_thread_num())];
#pragma omp for schedule(static) nowait
    for (size_t i = 0; i < d.gradient.size(); ++i) d.gradient[i] = 0;
    d.start_matrix(matrix);
    for (SystemTerm& term : d.terms) {
      over_colours(term, [&](int chunk) {
        lanes::ChunkResult* result = &term.results[static_cast<size_t>(chunk)];
        if (term.assembled()) {
          d.add_chunk(term, chunk, projection, room, term.gives_gradient ? d.gradient.data() : nullptr,
                      matrix.values().data(), result);
        } else if (term.gives_gradient) {
          term.operations->gradient(term.stencils, term.range(chunk), d.points_of(term), d.gradient.data(), result);
        }
      });
    }
#pragma omp for schedule(static)
    for (int v = 0; v < d.vertices; ++v) {
      for (int c = 0; c < 3; ++c) gradient(c, v) = d.gradient[4 * static_cast<size_t>(v) + static_cast<size_t>(c)];
    }
  }
  d.numbers.carriers.collect(gradient);
  Evaluation evaluation = d.sum(false, true);
  evaluation.value += damping(x, &gradient) + coupled_inertia(x, &gradient);
  d.damp_matrix(matrix);
  guide(gradient);
  d.guide_matrix(matrix);
  for (const SystemTerm& term : d.terms) {
    if (term.constant()) evaluation.indefinite += term.indefinite;
  }
  return evaluation;
}

std::vector<std::string> System::skipped() const {
  std::vector<std::string> lines;
  if (!coupled_mass().empty()) lines.emplace_back("consistent mass: Hessian is constant, assembled once");
  for (const SystemTerm& term : impl->terms) {
    if (!term.gives_gradient) continue;
    const std::string& name = term.potential.name();
    const ErgonKernel& kernel = term.kernel();
    if (term.potential.stencil_count() == 0) {
      lines.push_back(name + ": no stencils, not evaluated");
    } else if (kernel.zero_hessian) {
      lines.push_back(name + ": Hessian is zero, not assembled");
    } else if (kernel.constant_hessian) {
      lines.push_back(name + ": Hessian is constant, assembled once");
    } else if (kernel.psd_hessian) {
      lines.push_back(name + ": Hessian is positive semi-definite, not projected");
    } else if (kernel.projected != nullptr || (kernel.single != nullptr && kernel.single->projected != nullptr)) {
      lines.push_back(name + ": Hessian is projected in closed form, not decomposed");
    } else if (kernel.principal != nullptr || (kernel.single != nullptr && kernel.single->principal != nullptr)) {
      lines.push_back(name + ": Hessian is projected in the frame of the singular values, not decomposed");
    }
  }
  return lines;
}

}  // namespace ergon
