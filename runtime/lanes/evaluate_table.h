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
inline void to_reference_axes(const Weights<S>& w, double* packed) {
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

// Column c of the blocks (a, b) for G consecutive a: sum over `steps` of weights[step][a] half[step], three vectors
// each, stored at out[g].
template <int G>
inline void add_rows(const double* half, const double* weights, int points, int steps, double* const* out) {
  Real sum[G][3] = {};
  for (int step = 0; step < steps; ++step, half += 3 * kWidth, weights += points) {
    const Real x = load(half), y = load(half + kWidth), z = load(half + 2 * kWidth);
#pragma GCC unroll 8
    for (int g = 0; g < G; ++g) {
      const Real weight = splat(weights[g]);
      sum[g][0] += weight * x;
      sum[g][1] += weight * y;
      sum[g][2] += weight * z;
    }
  }
#pragma GCC unroll 8
  for (int g = 0; g < G; ++g) {
    for (int r = 0; r < 3; ++r) store(out[g] + r * kWidth, sum[g][r]);
  }
}

// What add_rows keeps in registers: three vectors for each row.
constexpr int kRows = kWidth == 8 ? 8 : 4;

inline void add_some_rows(int rows, const double* half, const double* weights, int points, int steps,
                          double* const* out) {
  switch (rows) {
    case 1:
      return add_rows<1>(half, weights, points, steps, out);
    case 2:
      return add_rows<2>(half, weights, points, steps, out);
    case 3:
      return add_rows<3>(half, weights, points, steps, out);
    case 4:
      return add_rows<4>(half, weights, points, steps, out);
    case 5:
      return add_rows<5>(half, weights, points, steps, out);
    case 6:
      return add_rows<6>(half, weights, points, steps, out);
    case 7:
      return add_rows<7>(half, weights, points, steps, out);
    default:
      return add_rows<8>(half, weights, points, steps, out);
  }
}

// As sum_products; `packed` is spoiled, `room` holds 3 * q_vectors vectors for each point of quadrature.
template <class S>
inline void sum_table_products(const Stencils& s, int block_index, double* packed, double* element, double* room) {
  constexpr int Q = S::kVectors;
  const int n = S::points(s), steps = s.quadrature * Q;
  for (int p = 0; p < s.quadrature; ++p) {
    to_reference_axes<S>(Weights<S>(s, block_index, p), packed + static_cast<long>(p) * S::kPacked * kWidth);
  }
  for (int c = 0; c < 3; ++c) {
    for (int b = 0; b < n; ++b) {
      double* half = room;
      for (int p = 0; p < s.quadrature; ++p) {
        const double* h = packed + static_cast<long>(p) * S::kPacked * kWidth;
        Real weight[Q];
        for (int j = 0; j < Q; ++j) weight[j] = splat(s.table[(p * Q + j) * n + b]);
#pragma GCC unroll 3
        for (int i = 0; i < Q; ++i) {
#pragma GCC unroll 3
          for (int r = 0; r < 3; ++r, half += kWidth) {
            const auto entry = [&](int j) {
              const int row = 3 * i + r, column = 3 * j + c;
              return load(h +
                          (row >= column ? row * (row + 1) / 2 + column : column * (column + 1) / 2 + row) * kWidth);
            };
            Real sum = weight[0] * entry(0);
            for (int j = 1; j < Q; ++j) sum += weight[j] * entry(j);
            store(half, sum);
          }
        }
      }
      if (Q == 3 && s.axis != nullptr) {
        add_tensor_rows(s, room, b, element + 3L * c * kWidth);
        continue;
      }
      for (int a = b; a < n; a += kRows) {
        const int rows = n - a < kRows ? n - a : kRows;
        double* out[kRows];
        for (int g = 0; g < rows; ++g) {
          out[g] = element + (9L * ((a + g) * (a + g + 1) / 2 + b) + 3 * c) * kWidth;
        }
        add_some_rows(rows, room, s.table + a, n, steps, out);
      }
    }
  }
}

}  // namespace
}  // namespace ergon::lanes
