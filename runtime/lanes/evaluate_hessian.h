#pragma once
// From q-Hessians to element matrices, and from these to the sums of a chunk. Included only by files in runtime/lanes.

#include "runtime/lanes/evaluate_parts.h"
#include "runtime/lanes/evaluate_table.h"

namespace ergon::lanes {
namespace {

// The element matrix of one vector of stencils: block (a, b <= a) = volume * sum_kl w_ka w_lb H_kl, summed over the
// points of quadrature; nine vectors, column by column, at a*(a + 1)/2 + b. `packed` is [quadrature][packed].
template <class S>
inline void sum_products(const Stencils& s, int block_index, const Scalar* packed, Scalar* element) {
  constexpr int kVectors = S::kVectors;
  const int n = S::points(s);
  const int last = S::kDensity ? n - 1 : n;  // a density's last diagonal block is minus the sum of those beside it
  for (int p = 0; p < s.quadrature; ++p, packed += S::kPacked * kWidth) {
    const Weights<S> w(s, block_index, p);
#pragma GCC unroll 4
    for (int b = 0; b < last; ++b) {
      Real scaled[kVectors];
      for (int l = 0; l < kVectors; ++l) scaled[l] = w.times_volume(w.at(l, b));
#pragma GCC unroll 9
      for (int e = 0; e < 9; ++e) {
        Real half[kVectors];
#pragma GCC unroll 4
        for (int k = 0; k < kVectors; ++k) {
#pragma GCC unroll 4
          for (int l = 0; l < kVectors; ++l) {
            const int i = 3 * k + e % 3, j = 3 * l + e / 3;
            const int entry = i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i;
            const Real term = scaled[l] * load(packed + entry * kWidth);
            half[k] = l == 0 ? term : half[k] + term;
          }
        }
#pragma GCC unroll 4
        for (int a = b; a < n; ++a) {
          Scalar* out = element + (9L * (a * (a + 1) / 2 + b) + e) * kWidth;
          Real sum = w.at(0, a) * half[0];
          for (int k = 1; k < kVectors; ++k) sum += w.at(k, a) * half[k];
          store(out, p == 0 ? sum : load(out) + sum);
        }
      }
    }
  }
  if (!S::kDensity) return;
  Scalar* row = element + 9L * (n * (n - 1) / 2) * kWidth;
  for (int e = 0; e < 9; ++e) {
    Real sum = load(row + e * kWidth);
    for (int b = 1; b < last; ++b) sum += load(row + (9L * b + e) * kWidth);
    store(row + (9L * last + e) * kWidth, -sum);
  }
}

// `room`: element_room doubles.
template <class S>
inline void element_matrix(const Stencils& s, int block_index, Scalar* packed, Scalar* element, Scalar* room) {
  if constexpr (S::kTable) {
    sum_table_products<S>(s, block_index, packed, element, room);
  } else {
    sum_products<S>(s, block_index, packed, element);
  }
}

// The same of Hessians that fall apart.
template <class S>
inline void part_matrix(const Stencils& s, const Parts& parts, int block_index, const Scalar* packed, Scalar* element,
                        Scalar* room) {
  if constexpr (S::kTable) {
    Scalar* const whole = room + table_room<S>(s);
    for (int p = 0; p < s.quadrature; ++p, packed += static_cast<long>(parts.first[parts.count]) * kWidth) {
      join_parts<S>(parts, packed, whole + static_cast<long>(p) * S::kPacked * kWidth);
    }
    sum_table_products<S>(s, block_index, whole, element, room);
  } else {
    sum_part_products<S>(s, parts, block_index, packed, element);
  }
}

template <class S>
inline int element_room(const Stencils& s) {
  if constexpr (S::kTable) {
    const int whole = s.kernel->parts != nullptr ? s.quadrature * S::kPacked * kWidth : 0;
    return table_room<S>(s) + whole;
  }
  return 0;
}

template <class S>
inline void add_element(const Stencils& s, int block_index, Scalar* element, double* sums) {
  const int n = S::points(s), pairs = n * (n + 1) / 2;
  const int* slots = s.slots + static_cast<long>(block_index) * pairs * kWidth;
  const unsigned short* turned = S::kAscending ? nullptr : s.turned + static_cast<long>(block_index) * pairs;
  for (int pair = 0; pair < pairs; ++pair) {
    if (!S::kAscending && turned[pair] != 0) transpose_lanes(element + 9L * pair * kWidth, turned[pair]);
    add_block(sums, slots + pair * kWidth, element + 9L * pair * kWidth);
  }
}

}  // namespace
}  // namespace ergon::lanes
