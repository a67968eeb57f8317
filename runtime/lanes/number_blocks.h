#pragma once
// Which blocks of the matrix a chunk of stencils adds to, each once, and which of them each pair of points is: pairs
// set bits of a triangular table of the chunk's vertices, and a block's number is that of the bits before its own.
// Included only by files in runtime/lanes.

#include "runtime/lanes/lanes.h"
#include "runtime/lanes/projection_vector.h"

namespace ergon::lanes {
namespace {

// Lanes from this one on are padding.
int lanes_of(const Stencils& s, int block) {
  const int whole = s.chunk * kWidth, first = block / s.chunk * s.chunk, left = s.count - first * kWidth;
  if (left >= whole) return kWidth;
  const int n = (left + kWidth - 1) / kWidth;
  return (left - (block - first) + n - 1) / n;
}

// Whether points a and b have weights in one part of a Hessian that falls apart (runtime/kernel.h).
inline bool coupled(const Stencils& s, int a, int b) {
  const ErgonKernel& kernel = *s.kernel;
  if (kernel.parts == nullptr || kernel.density != 0 || s.combined) return true;
  for (int k = 0; k < kernel.q_vectors; ++k) {
    for (int l = 0; l < kernel.q_vectors; ++l) {
      if (kernel.parts[k] >= 0 && kernel.parts[k] == kernel.parts[l] && s.weights[k * s.points + a] != 0 &&
          s.weights[l * s.points + b] != 0) {
        return true;
      }
    }
  }
  return false;
}

// Calls f(row, column, block, pair, lane) for all pairs of points; row < 0 or column < 0 for a fixed vertex.
template <class F>
inline void each_pair(int points, BlockRange range, const int* places, F f) {
  for (int block = range.first; block < range.last; ++block, places += points * kWidth) {
    for (int a = 0, pair = 0; a < points; ++a) {
      for (int b = 0; b <= a; ++b, ++pair) {
        for (int l = 0; l < kWidth; ++l) f(places[a * kWidth + l], places[b * kWidth + l], block, pair, l);
      }
    }
  }
}

inline int number_chunk_blocks(const Stencils& s, BlockRange range, const ChunkNumbering& n) {
  using Word = unsigned long long;
  const int points = s.points, pairs = points * (points + 1) / 2, words = (n.free + 63) / 64;
  const long first = static_cast<long>(range.first) * points * kWidth;
  const long size = static_cast<long>(range.last - range.first) * points * kWidth;
  for (long i = 0; i < size; ++i) n.places[i] = n.place[s.vertices[first + i]];
  bool kept[kMaxPoints * (kMaxPoints + 1) / 2];  // by pair: couplings that are identically zero have no place
  for (int a = 0, pair = 0; a < points; ++a) {
    for (int b = 0; b <= a; ++b, ++pair) kept[pair] = coupled(s, a, b);
  }

  // A column of the table is `words` words; a row is a bit of each.
  const auto word_of = [&](int row, int column) { return column * words + (row >> 6); };
  each_pair(points, range, n.places, [&](int a, int b, int, int pair, int) {
    if (a < 0 || b < 0 || !kept[pair]) return;
    const int row = a < b ? b : a, column = a < b ? a : b;
    n.bits[word_of(row, column)] |= Word{1} << (row & 63);
  });
  int count = 0;
  for (int column = 0; column < n.free; ++column) {
    for (int w = column >> 6; w < words; ++w) {
      n.rank[column * words + w] = count;
      for (Word rest = n.bits[column * words + w]; rest != 0; rest &= rest - 1, ++count) {
        n.row[count] = n.block[64 * w + __builtin_ctzll(rest)];
        n.column[count] = n.block[column];
      }
    }
  }
  int real = 0;
  each_pair(points, range, n.places, [&](int a, int b, int block, int pair, int l) {
    if (pair == 0 && l == 0) real = lanes_of(s, block);
    const long place = static_cast<long>(block) * pairs + pair;
    int slot = count;
    if (a >= 0 && b >= 0 && kept[pair] && l < real) {
      const int row = a < b ? b : a, column = a < b ? a : b, w = word_of(row, column);
      slot = n.rank[w] + __builtin_popcountll(n.bits[w] & ((Word{1} << (row & 63)) - 1));
      if (a < b) n.turned[place] |= static_cast<unsigned short>(1u << l);
    }
    n.slots[place * kWidth + l] = kSumDoubles * slot;
  });
  for (long w = 0; w < static_cast<long>(n.free) * words; ++w) n.bits[w] = 0;
  return count;
}

}  // namespace
}  // namespace ergon::lanes
