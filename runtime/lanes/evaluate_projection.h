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
  void add(Scalar* packed, unsigned lanes) {
    if (lanes != 0) waiting_[size_++] = {packed, lanes};
  }

  bool full() const { return size_ == kCapacity; }

  // Projects all that wait, in place.
  void run() {
    sort_by_lanes();
    int first = 0, last = size_ - 1;
    while (first <= last) {
      full_[0].take(waiting_, first, last);
      if (first <= last) {
        full_[1].take(waiting_, first, last);
        project_lanes<N>(full_[0].matrix, full_[0].lanes(), full_[1].matrix, full_[1].lanes(), mode_);
        full_[1].give_back(changed_);
      } else {
        project_lanes<N>(full_[0].matrix, mode_, full_[0].lanes());
      }
      full_[0].give_back(changed_);
    }
    size_ = 0;
  }

  // Matrices that projection changed so far.
  long changed() const { return changed_; }

 private:
  static constexpr int kPacked = N * (N + 1) / 2;
  struct Waiting {
    Scalar* packed;
    unsigned lanes;
  };

  // The matrices of one block and, in its free lanes, some of others.
  struct Full {
    alignas(64) Scalar matrix[kPacked * kWidth];
    Waiting base;
    unsigned lent;
    Scalar* borrower[kWidth];

    unsigned lanes() const { return base.lanes | lent; }

    // Takes the matrices from both ends of those that wait: a whole block from the first, single lanes from the last.
    void take(Waiting* waiting, int& first, int& last) {
      base = waiting[first++];
      for (int e = 0; e < kPacked; ++e) store(matrix + e * kWidth, load(base.packed + e * kWidth));
      lent = 0;
      for (int l = 0; l < kWidth && first <= last; ++l) {
        if ((base.lanes >> l & 1) != 0) continue;
        Waiting& other = waiting[last];
        borrower[l] = other.packed + __builtin_ctz(other.lanes);
        for (int e = 0; e < kPacked; ++e) matrix[e * kWidth + l] = borrower[l][e * kWidth];
        lent |= 1u << l;
        other.lanes &= other.lanes - 1;
        if (other.lanes == 0) --last;
      }
    }

    // Writes the projected matrices where they came from and counts those that differ. Raising an eigenvalue raises the
    // trace, so some diagonal entry.
    void give_back(long& changed) const {
      unsigned raised = 0;
      for (int i = 0; i < N; ++i) {
        const int e = i * (i + 3) / 2 * kWidth;
        const Real before = load(base.packed + e), after = load(matrix + e);
        raised |= bits(less(before, after)) | bits(less(after, before));
      }
      changed += __builtin_popcount(raised & base.lanes);
      const Mask own = from_bits(base.lanes);
      for (int e = 0; e < kPacked; ++e) {
        Scalar* entry = base.packed + e * kWidth;
        store(entry, select(own, load(matrix + e * kWidth), load(entry)));
      }
      for (unsigned rest = lent; rest != 0; rest &= rest - 1) {
        const int l = __builtin_ctz(rest);
        bool differs = false;
        for (int i = 0; i < N; ++i) {
          const int e = i * (i + 3) / 2 * kWidth;
          differs |= matrix[e + l] != borrower[l][e];
        }
        changed += differs;
        for (int e = 0; e < kPacked; ++e) borrower[l][e * kWidth] = matrix[e * kWidth + l];
      }
    }
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

  Full full_[2];
  Waiting waiting_[kCapacity];
  int size_ = 0;
  long changed_ = 0;
  Negative mode_;
};

}  // namespace
}  // namespace ergon::lanes
