#pragma once
// Projects the indefinite matrices of many blocks. Decomposing one lane costs as much as decomposing all, so lanes of a
// block that need nothing are lent to matrices of other blocks. Included only by files in runtime/lanes.

#include "runtime/lanes/projection.h"

namespace ergon::lanes {
namespace {

template <int N>
class ProjectionBatch {
 public:
  static constexpr int kCapacity = 256;

  explicit ProjectionBatch(Negative mode) : mode_(mode) {}

  // Bit l of `lanes`: the matrix in lane l of `packed` is to be projected by the next run(). At most kCapacity calls
  // between two runs.
  void add(double* packed, unsigned lanes) {
    if (lanes != 0) waiting_[size_++] = {packed, lanes};
  }

  // Projects all that wait, in place.
  void run() {
    sort_by_lanes();
    int first = 0, last = size_ - 1;
    while (first <= last) {
      const Waiting base = waiting_[first++];
      for (int e = 0; e < kPacked; ++e) store(matrix_ + e * kWidth, load(base.packed + e * kWidth));
      unsigned lent = 0;
      double* borrower[kWidth];
      for (int l = 0; l < kWidth && first <= last; ++l) {
        if ((base.lanes >> l & 1) != 0) continue;
        Waiting& other = waiting_[last];
        borrower[l] = other.packed + __builtin_ctz(other.lanes);
        for (int e = 0; e < kPacked; ++e) matrix_[e * kWidth + l] = borrower[l][e * kWidth];
        lent |= 1u << l;
        other.lanes &= other.lanes - 1;
        if (other.lanes == 0) --last;
      }
      project_lanes<N>(matrix_, mode_, base.lanes | lent);
      count_changes(base.packed, base.lanes);
      const Mask own = from_bits(base.lanes);
      for (int e = 0; e < kPacked; ++e) {
        double* entry = base.packed + e * kWidth;
        store(entry, select(own, load(matrix_ + e * kWidth), load(entry)));
      }
      for (; lent != 0; lent &= lent - 1) {
        const int l = __builtin_ctz(lent);
        count_change(borrower[l], l);
        for (int e = 0; e < kPacked; ++e) borrower[l][e * kWidth] = matrix_[e * kWidth + l];
      }
    }
    size_ = 0;
  }

  // Matrices that projection changed so far.
  long changed() const { return changed_; }

 private:
  static constexpr int kPacked = N * (N + 1) / 2;
  struct Waiting {
    double* packed;
    unsigned lanes;
  };

  // Most lanes first; equal numbers keep their order.
  void sort_by_lanes() {
    int start[kWidth + 2] = {};
    for (int i = 0; i < size_; ++i) ++start[kWidth + 1 - __builtin_popcount(waiting_[i].lanes)];
    for (int k = 1; k <= kWidth + 1; ++k) start[k] += start[k - 1];
    Waiting sorted[kCapacity];
    for (int i = 0; i < size_; ++i) sorted[start[kWidth - __builtin_popcount(waiting_[i].lanes)]++] = waiting_[i];
    for (int i = 0; i < size_; ++i) waiting_[i] = sorted[i];
  }

  // Raising an eigenvalue raises the trace, so some diagonal entry.
  void count_changes(const double* packed, unsigned lanes) {
    unsigned changed = 0;
    for (int i = 0; i < N; ++i) {
      const int e = i * (i + 3) / 2 * kWidth;
      const Real before = load(packed + e), after = load(matrix_ + e);
      changed |= bits(less(before, after)) | bits(less(after, before));
    }
    changed_ += __builtin_popcount(changed & lanes);
  }
  void count_change(const double* source, int lane) {
    bool changed = false;
    for (int i = 0; i < N; ++i) changed |= matrix_[i * (i + 3) / 2 * kWidth + lane] != source[i * (i + 3) / 2 * kWidth];
    changed_ += changed;
  }

  alignas(64) double matrix_[kPacked * kWidth];
  Waiting waiting_[kCapacity];
  int size_ = 0;
  long changed_ = 0;
  Negative mode_;
};

}  // namespace
}  // namespace ergon::lanes
