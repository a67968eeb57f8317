#pragma once
// From q-Hessians to the matrix: projects those of a batch that are indefinite, then chains each to its points and adds
// the 3x3 blocks where they belong. Included only by files in runtime/lanes.

#include "runtime/lanes/evaluate_shape.h"
#include "runtime/lanes/projection.h"

namespace ergon::lanes {
namespace {

// Gathers single indefinite matrices from many blocks until there is one for each lane: decomposing a full vector
// costs no more than decomposing one.
template <int N>
class ProjectionQueue {
 public:
  explicit ProjectionQueue(Negative mode) : mode_(mode) {}

  // Bit l of `lanes`: the matrix in lane l of `packed` waits for projection.
  void add(double* packed, unsigned lanes) {
    for (; lanes != 0; lanes &= lanes - 1) {
      source_[waiting_] = packed + __builtin_ctz(lanes);
      for (int e = 0; e < kPacked; ++e) matrix_[e * kWidth + waiting_] = source_[waiting_][e * kWidth];
      if (++waiting_ == kWidth) flush();
    }
  }

  // Projects what waits and writes it back.
  void flush() {
    if (waiting_ == 0) return;
    project_lanes<N>(matrix_, mode_, (1u << waiting_) - 1);
    for (int l = 0; l < waiting_; ++l) {
      bool changed = false;
      for (int e = 0; e < kPacked; ++e) {
        const double entry = matrix_[e * kWidth + l];
        changed |= entry != source_[l][e * kWidth];
        source_[l][e * kWidth] = entry;
      }
      changed_ += changed;
    }
    waiting_ = 0;
  }

  long changed() const { return changed_; }

 private:
  static constexpr int kPacked = N * (N + 1) / 2;
  alignas(64) double matrix_[kPacked * kWidth] = {};
  double* source_[kWidth];
  Negative mode_;
  int waiting_ = 0;
  long changed_ = 0;
};

// sum_l w_lb H_kl for one point b, 3x3 blocks column by column.
template <class S>
inline void half_chain(const Weights<S>& w, int b, const double* packed, Real (*half)[9]) {
  for (int k = 0; k < S::kVectors; ++k) {
    for (int e = 0; e < 9; ++e) half[k][e] = splat(0);
    for (int l = 0; l < S::kVectors; ++l) {
      if (w.zero(l, b)) continue;
      for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) {
          const int i = 3 * k + r, j = 3 * l + c;
          const int entry = i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i;
          half[k][3 * c + r] += w.at(l, b) * load(packed + entry * kWidth);
        }
      }
    }
  }
}

// block += sum_k w_ka half_k.
template <class S>
inline void other_half(const Weights<S>& w, int a, const Real (*half)[9], Real* block) {
  for (int k = 0; k < S::kVectors; ++k) {
    if (w.zero(k, a)) continue;
    for (int e = 0; e < 9; ++e) block[e] += w.at(k, a) * half[k][e];
  }
}

// Adds the block of points (a, b <= a) of all lanes to the matrix.
template <class S>
inline void scatter_pair(const Stencils& s, int block_index, int count, int a, int b, Real* block, double* values) {
  const int n = S::points(s);
  const int* slots = s.slots + (static_cast<long>(block_index) * (n * (n + 1) / 2) + a * (a + 1) / 2 + b) * kWidth;
  const int* strides = s.strides + static_cast<long>(block_index) * n * kWidth;
  if (a == b) return scatter_block<true>(values, slots, strides + a * kWidth, count, block);
  if constexpr (S::kDensity) return scatter_block<false>(values, slots, strides + b * kWidth, count, block);
  const unsigned turned = transpose_where_needed(block, slots);
  int column[kWidth];
  for (int l = 0; l < kWidth; ++l) column[l] = strides[((turned >> l & 1) != 0 ? a : b) * kWidth + l];
  scatter_block<false>(values, slots, column, count, block);
}

// The element matrix of one block of stencils, from its q-Hessians [quadrature][packed] to the matrix. `element` is
// room for [pairs][9] vectors.
template <class S>
inline void chain_hessian(const Stencils& s, int block_index, int count, const double* packed, double* element,
                          double* values) {
  const int n = S::points(s);
  const int last = S::kDensity ? n - 1 : n;  // a density's last diagonal block is minus the sum of those beside it
  Real half[S::kVectors][9];
  if (S::kPoints == 0) {
    for (long e = 0; e < 9L * kWidth * (n * (n + 1) / 2); ++e) element[e] = 0;
  }
  for (int p = 0; p < s.quadrature; ++p, packed += S::kPacked * kWidth) {
    const Weights<S> w(s, block_index, p);
    Real corner[9] = {};
    for (int b = 0; b < last; ++b) {
      half_chain<S>(w, b, packed, half);
      for (auto& part : half) {
        for (Real& entry : part) entry = w.times_volume(entry);
      }
      for (int a = b; a < n; ++a) {
        Real block[9] = {};
        other_half<S>(w, a, half, block);
        if (S::kPoints != 0) {
          if (S::kDensity && a == n - 1) {
            for (int e = 0; e < 9; ++e) corner[e] -= block[e];
          }
          scatter_pair<S>(s, block_index, count, a, b, block, values);
        } else {
          double* sum = element + 9L * kWidth * (a * (a + 1) / 2 + b);
          for (int e = 0; e < 9; ++e) store(sum + e * kWidth, load(sum + e * kWidth) + block[e]);
        }
      }
    }
    if (S::kPoints != 0 && S::kDensity) scatter_pair<S>(s, block_index, count, n - 1, n - 1, corner, values);
  }
  if (S::kPoints != 0) return;
  Real corner[9] = {};
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b <= a; ++b) {
      const double* sum = element + 9L * kWidth * (a * (a + 1) / 2 + b);
      Real block[9];
      for (int e = 0; e < 9; ++e) block[e] = load(sum + e * kWidth);
      if (S::kDensity && a == n - 1) {
        if (b == a) {
          scatter_pair<S>(s, block_index, count, a, b, corner, values);
          continue;
        }
        for (int e = 0; e < 9; ++e) corner[e] -= block[e];
      }
      scatter_pair<S>(s, block_index, count, a, b, block, values);
    }
  }
}

}  // namespace
}  // namespace ergon::lanes
