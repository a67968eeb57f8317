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
  q_hessians.resize(packed * static_cast<size_t>(d.blocks()));
  const AlignedVector<double> q(rows * width, 0.0);
  AlignedVector<double> value(width), gradient(rows * width), hessian(packed);
  bool changed = rebuilt;
  for (size_t block = 0; block < static_cast<size_t>(d.blocks()); ++block) {
    k.hessian(q.data(), d.elements.data() + block * elements, d.uniforms.data(), value.data(), gradient.data(),
              hessian.data());
    double* kept = q_hessians.data() + block * packed;
    if (std::memcmp(kept, hessian.data(), packed * sizeof(double)) == 0) continue;
    std::copy(hessian.begin(), hessian.end(), kept);
    changed = true;
  }
  return changed;
}

void System::Impl::update_base(Projection projection, BlockMatrix& matrix) {
  bool changed = !base_known;
  for (SystemTerm& term : terms) {
    if (term.constant() && !term.kernel().psd_hessian && projection != base_projection) changed = true;
    if (term.constant() && term.constant_changed()) changed = true;
  }
  if (!changed) return;
  base_known = true;
  base_projection = projection;
  base_row.clear();
  base_values.clear();
  base_start.assign(static_cast<size_t>(matrix.block_rows()) + 1, 0);
  if (std::none_of(terms.begin(), terms.end(), [](const SystemTerm& t) { return t.constant(); })) return;

  matrix.set_zero();
  for (SystemTerm& term : terms) {
    if (!term.constant()) continue;
    term.indefinite = 0;
    for (int chunk = 0; chunk < static_cast<int>(term.results.size()); ++chunk) {
      lanes::ChunkResult result{};
      term.operations->hessian(term.stencils, term.range(chunk), term.blocks(chunk), points_of(term),
                               static_cast<int>(projection), rooms[0].view(), nullptr, matrix.values().data(), &result);
      term.indefinite += result.indefinite;
    }
  }
  for (int j = 0; j < matrix.block_rows(); ++j) {
    const int stride = matrix.column_stride(j);
    const double* column = matrix.values().data() + matrix.column_start()[3 * static_cast<size_t>(j)];
    for (int row = 0; row < stride; row += 3) {
      double block[9];
      for (int c = 0; c < 3; ++c) std::copy_n(column + c * stride + row, 3, block + 3 * c);
      if (std::all_of(block, block + 9, [](double v) { return v == 0; })) continue;
      base_row.push_back(row);
      base_values.insert(base_values.end(), block, block + 9);
    }
    base_start[static_cast<size_t>(j) + 1] = static_cast<int>(base_row.size());
  }
}

void System::Impl::update_first() {
  const auto each_base_block = [&](auto f) {
    for (int j = 0; j < pattern.block_rows(); ++j) {
      const int diagonal = pattern.index_of(j, j);  // the column's first
      for (int k = base_start[static_cast<size_t>(j)]; k < base_start[static_cast<size_t>(j) + 1]; ++k) {
        f(static_cast<size_t>(k), diagonal + base_row[static_cast<size_t>(k)] / 3);
      }
    }
  };
  bool known = first_known && first_base.size() == base_row.size();
  each_base_block([&](size_t k, int index) { known = known && first_base[k] == index; });
  if (known) return;
  first_known = true;
  first_base.resize(base_row.size());
  each_base_block([&](size_t k, int index) { first_base[k] = index; });
  std::vector<char> written(pattern.blocks(), 0);
  for (const int index : first_base) written[static_cast<size_t>(index)] = 1;
  for (SystemTerm& term : terms) {
    if (!term.assembled()) continue;
    for (const int chunk : term.chunks) {  // those of one colour share no block
      for (int i = term.block_start[static_cast<size_t>(chunk)]; i < term.block_start[static_cast<size_t>(chunk) + 1];
           ++i) {
        char& before = written[static_cast<size_t>(term.block_index[static_cast<size_t>(i)])];
        int& stride = term.block_stride[static_cast<size_t>(i)];
        stride = before != 0 ? std::abs(stride) : -std::abs(stride);
        before = 1;
      }
    }
  }
  cleared_column.clear();
  cleared_row.clear();
  for (int j = 0; j < pattern.block_rows(); ++j) {
    const auto first = static_cast<size_t>(pattern.index_of(j, j));
    for (int row = 0; row < pattern.column_stride(j); row += 3) {
      if (written[first + static_cast<size_t>(row) / 3] != 0) continue;
      cleared_column.push_back(j);
      cleared_row.push_back(row);
    }
  }
}

void System::Impl::start_matrix(BlockMatrix& matrix) const {
  double* values = matrix.values().data();
  const int* start = matrix.column_start().data();
#pragma omp for schedule(static) nowait
  for (size_t k = 0; k < cleared_row.size(); ++k) {
    double* place = values + start[3 * cleared_column[k]] + cleared_row[k];
    const int stride = matrix.column_stride(cleared_column[k]);
    for (int c = 0; c < 3; ++c) std::fill_n(place + c * stride, 3, 0.0);
  }
#pragma omp for schedule(static)
  for (int j = 0; j < matrix.block_rows(); ++j) {
    double* column = values + start[3 * j];
    const int stride = matrix.column_stride(j);
    for (int k = base_start[static_cast<size_t>(j)]; k < base_start[static_cast<size_t>(j) + 1]; ++k) {
      const double* block = base_values.data() + 9 * static_cast<size_t>(k);
      double* place = column + base_row[static_cast<size_t>(k)];
      for (int c = 0; c < 3; ++c) std::copy_n(block + 3 * c, 3, place + c * stride);
    }
  }
}

}  // namespace ergon
