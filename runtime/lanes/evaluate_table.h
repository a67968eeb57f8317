#pragma once
// Element matrices of densities on elements whose gradients vary: the q-Hessians are carried to the axes of the
// reference element, where the weights are the same numbers in all lanes. Included only by files in runtime/lanes.

#include "runtime/lanes/evaluate_tensor.h"

namespace ergon::lanes {
namespace {

// Place of entry (r, c) of the 3x3 block (i, j) in a packed matrix.
constexpr int packed_entry(int i, int j, int r, int c) {
  const int row = 3 * i + r, column = 3 * j + c;
  return row >= column ? row * (row + 1) / 2 + column : column * (column + 1) / 2 + row;
}

// H -> volume * (map (x) I3) H (map (x) I3)^T, in place.
template <class S>
inline void to_reference_axes(const Weights<S>& w, Scalar* packed) {
  constexpr int Q = S::kVectors;
  Real half[Q][Q][9];
#pragma GCC unroll 3
  for (int l = 0; l < Q; ++l) {
#pragma GCC unroll 9
    for (int e = 0; e < 9; ++e) {
      Real h[Q];
#pragma GCC unroll 3
      for (int k = 0; k < Q; ++k) h[k] = load(packed + packed_entry(k, l, e % 3, e / 3) * kWidth);
#pragma GCC unroll 3
      for (int i = 0; i < Q; ++i) {
        Real sum = w.map(i, 0) * h[0];
        for (int k = 1; k < Q; ++k) sum += w.map(i, k) * h[k];
        half[i][l][e] = sum;
      }
    }
  }
#pragma GCC unroll 3
  for (int j = 0; j < Q; ++j) {
    Real scaled[Q];
    for (int l = 0; l < Q; ++l) scaled[l] = w.times_volume(w.map(j, l));
#pragma GCC unroll 3
    for (int i = j; i < Q; ++i) {
#pragma GCC unroll 9
      for (int e = 0; e < 9; ++e) {
        if (i == j && e % 3 < e / 3) continue;
        Real sum = scaled[0] * half[i][0][e];
        for (int l = 1; l < Q; ++l) sum += scaled[l] * half[i][l][e];
        store(packed + packed_entry(i, j, e % 3, e / 3) * kWidth, sum);
      }
    }
  }
}

// R components of the blocks (a, b) for G consecutive a: sum over `steps` of weights[step][a] half[step][r].
template <int G, int R>
inline void add_rows(const Scalar* half, const double* weights, int points, int steps, Scalar* const* out) {
  Real sum[G][R] = {};
  for (int step = 0; step < steps; ++step, half += R * kWidth, weights += points) {
    Real x[R];
#pragma GCC unroll 3
    for (int r = 0; r < R; ++r) x[r] = load(half + r * kWidth);
#pragma GCC unroll 12
    for (int g = 0; g < G; ++g) {
      const Real weight = splat(weights[g]);
#pragma GCC unroll 3
      for (int r = 0; r < R; ++r) sum[g][r] += weight * x[r];
    }
  }
#pragma GCC unroll 12
  for (int g = 0; g < G; ++g) {
#pragma GCC unroll 3
    for (int r = 0; r < R; ++r) store(out[g] + r * kWidth, sum[g][r]);
  }
}

// Rows whose sums add_rows keeps in registers.
template <int R>
constexpr int kRows = R == 1               ? 12
                      : sizeof(Real) == 64 ? 8
                                           : 4;

template <int R, int G = kRows<R>>
inline void add_some_rows(int rows, const Scalar* half, const double* weights, int points, int steps,
                          Scalar* const* out) {
  if constexpr (G > 1) {
    if (rows < G) return add_some_rows<R, G - 1>(rows, half, weights, points, steps, out);
  }
  add_rows<G, R>(half, weights, points, steps, out);
}

// R of the nine components of all blocks, from the one numbered `first`. The entries they need are copied to `room`, so
// that what is read again and again stays in the first-level cache.
template <class S, int R>
inline void sum_components(const Stencils& s, int first, const Scalar* packed, Scalar* element, Scalar* room) {
  constexpr int Q = S::kVectors;
  const int n = S::points(s), c = first / 3;
  Scalar* entries = room;  // [quadrature][Q][Q][R]
  for (int p = 0; p < s.quadrature; ++p, packed += S::kPacked * kWidth) {
    for (int i = 0; i < Q; ++i) {
      for (int j = 0; j < Q; ++j) {
        for (int r = first % 3; r < first % 3 + R; ++r, entries += kWidth) {
          store(entries, load(packed + packed_entry(i, j, r, c) * kWidth));
        }
      }
    }
  }
  Scalar* const half = entries;  // [quadrature][Q][R]
  Scalar* const out = element + static_cast<long>(first) * kWidth;
  for (int b = 0; b < n; ++b) {
    const Scalar* h = room;
    for (int p = 0; p < s.quadrature; ++p) {
      Real weight[Q];
      for (int j = 0; j < Q; ++j) weight[j] = splat(s.table[(p * Q + j) * n + b]);
#pragma GCC unroll 3
      for (int i = 0; i < Q; ++i, h += Q * R * kWidth) {
#pragma GCC unroll 3
        for (int r = 0; r < R; ++r) {
          Real sum = weight[0] * load(h + r * kWidth);
          for (int j = 1; j < Q; ++j) sum += weight[j] * load(h + (j * R + r) * kWidth);
          store(half + ((p * Q + i) * R + r) * kWidth, sum);
        }
      }
    }
    if (R == 1 && Q == 3 && s.axis != nullptr) {
      add_tensor_rows(s, half, b, first % 3, c, element);
      continue;
    }
    for (int a = b; a < n; a += kRows<R>) {
      const int rows = n - a < kRows<R> ? n - a : kRows<R>;
      Scalar* place[kRows<R>];
      for (int g = 0; g < rows; ++g) place[g] = out + 9L * ((a + g) * (a + g + 1) / 2 + b) * kWidth;
      add_some_rows<R>(rows, half, s.table + a, n, s.quadrature * Q, place);
    }
  }
}

// Three components at a time are quicker as long as their entries fit into the first-level cache.
constexpr int kFewPoints = 8;

template <class S>
inline int table_room(const Stencils& s) {
  const int entries = S::kVectors * (S::kVectors + 1) * s.quadrature * kWidth;
  return s.quadrature > kFewPoints ? entries : 3 * entries;
}

// As sum_products; `packed` is spoiled, `room` holds table_room doubles.
template <class S>
inline void sum_table_products(const Stencils& s, int block_index, Scalar* packed, Scalar* element, Scalar* room) {
  for (int p = 0; p < s.quadrature; ++p) {
    to_reference_axes<S>(Weights<S>(s, block_index, p), packed + static_cast<long>(p) * S::kPacked * kWidth);
  }
  if (s.quadrature > kFewPoints) {
    const bool halves = S::kVectors == 3 && s.axis != nullptr;  // one component gives its transpose
    for (int first = 0; first < 9; ++first) {
      if (!halves || first % 3 >= first / 3) sum_components<S, 1>(s, first, packed, element, room);
    }
  } else {
    for (int first = 0; first < 9; first += 3) sum_components<S, 3>(s, first, packed, element, room);
  }
}

}  // namespace
}  // namespace ergon::lanes
