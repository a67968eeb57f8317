#pragma once
// Hessians that fall into parts which no entry couples: each part is projected by itself, and only within parts are
// entries carried to the points. Included only by files in runtime/lanes.

#include "runtime/lanes/evaluate_projection.h"
#include "runtime/lanes/evaluate_shape.h"

namespace ergon::lanes {
namespace {

struct Parts {
  int count = 0;  // 0: the Hessian is whole
  int vectors[kMaxVectors] = {};
  int member[kMaxVectors][kMaxVectors] = {};  // vectors of q, ascending
  int first[kMaxVectors + 1] = {};            // entry of each part; the last: of all together
  unsigned points[kMaxVectors] = {};          // bit a: point a has a weight in the part
};

template <class S>
inline Parts parts_of(const Stencils& s) {
  Parts parts;
  if (s.kernel->parts == nullptr) return parts;
  for (int k = 0; k < S::kVectors; ++k) {
    const int part = s.kernel->parts[k];
    if (part < 0) continue;
    if (part >= parts.count) parts.count = part + 1;
    parts.member[part][parts.vectors[part]++] = k;
    for (int a = 0; a < S::points(s); ++a) {
      if (S::kSource != Source::kernel || s.weights[k * S::points(s) + a] != 0) parts.points[part] |= 1u << a;
    }
  }
  for (int part = 0; part < parts.count; ++part) {
    const int size = 3 * parts.vectors[part];
    parts.first[part + 1] = parts.first[part] + size * (size + 1) / 2;
  }
  return parts;
}

// Entries of the 3x3 block (i, j) of a part: (r, c) in the lower triangle packed by rows.
inline int part_entry(int i, int j, int r, int c) {
  const int row = 3 * i + r, column = 3 * j + c;
  return row >= column ? row * (row + 1) / 2 + column : column * (column + 1) / 2 + row;
}

class PartProjection {
 public:
  explicit PartProjection(Negative mode) : one_(mode), two_(mode), three_(mode) {}

  // Those of the given lanes that a test does not find definite are projected by the next run(), or before.
  [[gnu::noinline]] void add(const Parts& parts, Scalar* packed, unsigned lanes) {
    const auto add_to = [lanes]<int N>(ProjectionBatch<N>& batch, Scalar* own) {
      if (batch.full()) batch.run();
      batch.add(own, ~definite<N>(own) & lanes);
    };
    for (int part = 0; part < parts.count; ++part) {
      Scalar* const own = packed + static_cast<long>(parts.first[part]) * kWidth;
      if (parts.vectors[part] == 1) {
        add_to(one_, own);
      } else if (parts.vectors[part] == 2) {
        add_to(two_, own);
      } else {
        add_to(three_, own);
      }
    }
  }
  [[gnu::noinline]] void run() {
    one_.run();
    two_.run();
    three_.run();
  }
  long changed() const { return one_.changed() + two_.changed() + three_.changed(); }

 private:
  ProjectionBatch<3> one_;
  ProjectionBatch<6> two_;
  ProjectionBatch<9> three_;
};

// As sum_products in runtime/lanes/evaluate_hessian.h.
template <class S>
inline void sum_part_products(const Stencils& s, const Parts& parts, int block_index, const Scalar* packed,
                              Scalar* element) {
  const int n = S::points(s);
  for (long i = 0; i < 9L * (n * (n + 1) / 2); ++i) store(element + i * kWidth, splat(0));
  for (int p = 0; p < s.quadrature; ++p, packed += static_cast<long>(parts.first[parts.count]) * kWidth) {
    const Weights<S> w(s, block_index, p);
    for (int part = 0; part < parts.count; ++part) {
      const Scalar* own = packed + static_cast<long>(parts.first[part]) * kWidth;
      const int vectors = parts.vectors[part], *const member = parts.member[part];
      for (int b = 0; b < n; ++b) {
        if ((parts.points[part] >> b & 1) == 0) continue;
        for (int e = 0; e < 9; ++e) {
          Real half[kMaxVectors];
          for (int k = 0; k < vectors; ++k) {
            half[k] = splat(0);
            for (int l = 0; l < vectors; ++l) {
              half[k] += w.times_volume(w.at(member[l], b)) * load(own + part_entry(k, l, e % 3, e / 3) * kWidth);
            }
          }
          for (int a = b; a < n; ++a) {
            if ((parts.points[part] >> a & 1) == 0) continue;
            Scalar* out = element + (9L * (a * (a + 1) / 2 + b) + e) * kWidth;
            Real sum = load(out);
            for (int k = 0; k < vectors; ++k) sum += w.at(member[k], a) * half[k];
            store(out, sum);
          }
        }
      }
    }
  }
}

// Parts in the places that they have in a whole Hessian, packed; zero elsewhere.
template <class S>
inline void join_parts(const Parts& parts, const Scalar* packed, Scalar* whole) {
  for (int i = 0; i < S::kPacked; ++i) store(whole + i * kWidth, splat(0));
  for (int part = 0; part < parts.count; ++part) {
    const Scalar* own = packed + static_cast<long>(parts.first[part]) * kWidth;
    for (int row = 0; row < 3 * parts.vectors[part]; ++row) {
      for (int column = 0; column <= row; ++column, own += kWidth) {
        const int i = 3 * parts.member[part][row / 3] + row % 3, j = 3 * parts.member[part][column / 3] + column % 3;
        store(whole + (i * (i + 1) / 2 + j) * kWidth, load(own));
      }
    }
  }
}

}  // namespace
}  // namespace ergon::lanes
