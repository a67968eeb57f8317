// The part of the matrix that stays: Hessians that do not depend on the positions are evaluated, projected and
// assembled once. The rule for doing it again is exact: the stencils, a param, the pattern or the projection changed,
// or a lag was set and the q-Hessians that follow from it are not bit by bit what they were.

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "runtime/system_data.h"

namespace ergon {

bool SystemTerm::constant_changed() {
  const Potential::Impl& d = data();
  const ErgonKernel& k = kernel();
  const auto is_lag = [](const ErgonInput& input) { return input.role == ERGON_LAG; };
  const bool lagged = std::any_of(k.inputs, k.inputs + k.n_inputs, is_lag);
  const bool rebuilt = based_stencils != d.stencil_version || based_params != d.param_version;
  const bool set = based_lags != d.lag_version;
  based_stencils = d.stencil_version;
  based_params = d.param_version;
  based_lags = d.lag_version;
  if (!lagged || !(rebuilt || set)) return rebuilt;

  const size_t width = static_cast<size_t>(d.lanes), rows = 3 * static_cast<size_t>(k.q_vectors);
  const size_t packed = rows * (rows + 1) / 2 * width, elements = static_cast<size_t>(k.elements) * width;
  const auto places = static_cast<size_t>(d.blocks() * d.quadrature);
  q_hessians.resize(packed * places);
  const AlignedVector<double> q(rows * width, 0.0);
  AlignedVector<double> value(width), gradient(rows * width), hessian(packed);
  bool changed = rebuilt;
  for (size_t place = 0; place < places; ++place) {
    k.hessian(q.data(), d.elements.data() + place * elements, d.uniforms.data(), value.data(), gradient.data(),
              hessian.data());
    double* kept = q_hessians.data() + place * packed;
    if (std::memcmp(kept, hessian.data(), packed * sizeof(double)) == 0) continue;
    std::copy(hessian.begin(), hessian.end(), kept);
    changed = true;
  }
  return changed;
}

void System::Impl::update_base(Projection projection) {
  bool changed = !base_known;
  for (SystemTerm& term : terms) {
    if (term.constant() && !term.kernel().psd_hessian && projection != base_projection) changed = true;
    if (term.constant() && term.constant_changed()) changed = true;
  }
  changed = coupled.rescaled() || changed;
  if (!changed) return;
  base_known = true;
  base_projection = projection;
  base.set_zero();
  for (SystemTerm& term : terms) {
    if (!term.constant()) continue;
    term.indefinite = 0;
    for (int chunk = 0; chunk < static_cast<int>(term.results.size()); ++chunk) {
      lanes::ChunkResult result{};
      add_chunk(term, chunk, projection, rooms[0], nullptr, base.values().data(), &result);
      term.indefinite += result.indefinite;
    }
  }
  coupled.assemble(base);
}

void System::Impl::start_matrix(BlockMatrix& matrix) const {
  double* values = matrix.values().data();
#pragma omp for schedule(static) nowait
  for (size_t k = 0; k < cleared_index.size(); ++k) {
    double* place = values + pattern->start_of(cleared_index[k], cleared_column[k]);
    const int stride = pattern->column_stride(cleared_column[k]);
    for (int c = 0; c < 3; ++c) std::fill_n(place + c * stride, 3, 0.0);
  }
#pragma omp for schedule(static)
  for (size_t k = 0; k < base_index.size(); ++k) {
    const int j = base_column[k];
    const double* block = base.values().data() + base.start_of(static_cast<int>(k), j);
    double* place = values + pattern->start_of(base_index[k], j);
    const int from = base.column_stride(j), to = pattern->column_stride(j);
    for (int c = 0; c < 3; ++c) std::copy_n(block + c * from, 3, place + c * to);
  }
}

}  // namespace ergon
