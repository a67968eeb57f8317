// Overlaps of the boxes of two leaves, for one vector width.

#include "runtime/lanes/overlaps.h"

#if (ERGON_LANES == 8 && defined(__AVX512F__)) || (ERGON_LANES == 4 && defined(__AVX2__))
#include <immintrin.h>
#endif

namespace ergon::lanes {

#define ERGON_JOIN(a, b) a##b
#define ERGON_OVERLAPS(width) ERGON_JOIN(overlap_operations_, width)
const OverlapOperations& ERGON_OVERLAPS(ERGON_LANES)();

namespace {

// Sixteen integers, compared with one: bit i of the answer belongs to integer i.
#if ERGON_LANES == 8 && defined(__AVX512F__)

struct Integers {
  __m512i v;
};
inline Integers load(const int* p) { return {_mm512_load_si512(p)}; }
inline Integers plus(Integers a, int b) { return {_mm512_add_epi32(a.v, _mm512_set1_epi32(b))}; }
inline unsigned at_most(Integers a, int b) { return _mm512_cmple_epi32_mask(a.v, _mm512_set1_epi32(b)); }
inline unsigned at_least(Integers a, int b) { return _mm512_cmpge_epi32_mask(a.v, _mm512_set1_epi32(b)); }
inline unsigned equal(Integers a, int b) { return _mm512_cmpeq_epi32_mask(a.v, _mm512_set1_epi32(b)); }

#elif ERGON_LANES == 4 && defined(__AVX2__)

struct Integers {
  __m256i v, w;
};
inline Integers load(const int* p) {
  return {_mm256_load_si256(reinterpret_cast<const __m256i*>(p)),
          _mm256_load_si256(reinterpret_cast<const __m256i*>(p + 8))};
}
inline Integers plus(Integers a, int b) {
  const __m256i s = _mm256_set1_epi32(b);
  return {_mm256_add_epi32(a.v, s), _mm256_add_epi32(a.w, s)};
}
inline unsigned bits(__m256i v, __m256i w) {
  return static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(v))) |
         static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(w))) << 8;
}
inline unsigned at_most(Integers a, int b) {
  const __m256i s = _mm256_set1_epi32(b);
  return 0xffffu & ~bits(_mm256_cmpgt_epi32(a.v, s), _mm256_cmpgt_epi32(a.w, s));
}
inline unsigned at_least(Integers a, int b) {
  const __m256i s = _mm256_set1_epi32(b);
  return 0xffffu & ~bits(_mm256_cmpgt_epi32(s, a.v), _mm256_cmpgt_epi32(s, a.w));
}
inline unsigned equal(Integers a, int b) {
  const __m256i s = _mm256_set1_epi32(b);
  return bits(_mm256_cmpeq_epi32(a.v, s), _mm256_cmpeq_epi32(a.w, s));
}

#else

struct Integers {
  int v[kLeaf];
};
inline Integers load(const int* p) {
  Integers a;
  for (int i = 0; i < kLeaf; ++i) a.v[i] = p[i];
  return a;
}
inline Integers plus(Integers a, int b) {
  for (int i = 0; i < kLeaf; ++i) a.v[i] += b;
  return a;
}
template <class Test>
inline unsigned where(const Integers& a, Test test) {
  unsigned bits = 0;
  for (int i = 0; i < kLeaf; ++i) bits |= static_cast<unsigned>(test(a.v[i])) << i;
  return bits;
}
inline unsigned at_most(const Integers& a, int b) {
  return where(a, [b](int v) { return v <= b; });
}
inline unsigned at_least(const Integers& a, int b) {
  return where(a, [b](int v) { return v >= b; });
}
inline unsigned equal(const Integers& a, int b) {
  return where(a, [b](int v) { return v == b; });
}

#endif

struct BoxRow {
  Integers lower[3], upper[3];

  BoxRow(const BoxLeaf& leaf, const int* shift_lower, const int* shift_upper) {
    for (int k = 0; k < 3; ++k) {
      lower[k] = plus(load(leaf.lower[k]), shift_lower[k]);
      upper[k] = plus(load(leaf.upper[k]), shift_upper[k]);
    }
  }
  unsigned meets(int x0, int y0, int z0, int x1, int y1, int z1) const {
    return at_most(lower[0], x1) & at_most(lower[1], y1) & at_most(lower[2], z1) & at_least(upper[0], x0) &
           at_least(upper[1], y0) & at_least(upper[2], z0);
  }
};

template <int CornersA, int CornersB, bool Same>
long overlaps_of(const OverlapTask& task, const LeafPair* pairs, long count, IdPair* out, long room, long* found) {
  const int none[3] = {0, 0, 0};
  IdPair* const first = out;
  long done = 0;
  for (; done < count && (out - first) + kMostOverlaps <= room; ++done) {
    const BoxLeaf& a = task.a[pairs[done].a];
    const BoxLeaf& b = task.b[pairs[done].b];
    const int *down = task.shift_lower, *up = task.shift_upper;
    // The primitives of a that meet the box around those of b.
    unsigned rows = BoxRow(a, none, none)
                        .meets(b.lowest[0] + down[0], b.lowest[1] + down[1], b.lowest[2] + down[2],
                               b.highest[0] + up[0], b.highest[1] + up[1], b.highest[2] + up[2]);
    const BoxRow row(b, down, up);
    Integers corners[CornersB > 0 ? CornersB : 1];
    for (int j = 0; j < CornersB; ++j) corners[j] = load(b.vertex[j]);
    const bool itself = Same && &a == &b;
    for (; rows != 0; rows &= rows - 1) {
      const int i = __builtin_ctz(rows);
      unsigned hits =
          row.meets(a.lower[0][i], a.lower[1][i], a.lower[2][i], a.upper[0][i], a.upper[1][i], a.upper[2][i]);
      if ((a.moving >> i & 1u) == 0) hits &= b.moving;
      if (itself) hits &= ~((2u << i) - 1);
      if (hits == 0) continue;
      for (int k = 0; k < CornersA; ++k) {
        for (int j = 0; j < CornersB; ++j) hits &= ~equal(corners[j], a.vertex[k][i]);
      }
      const int id = a.id[i];
      for (; hits != 0; hits &= hits - 1) {
        const int other = b.id[__builtin_ctz(hits)];
        *out++ = !Same || id < other ? IdPair{id, other} : IdPair{other, id};
      }
    }
  }
  *found += out - first;
  return done;
}

long overlaps(const OverlapTask& task, const LeafPair* pairs, long count, IdPair* out, long room, long* found) {
  if (task.corners_a == 2 && task.corners_b == 2) return overlaps_of<2, 2, true>(task, pairs, count, out, room, found);
  if (task.corners_a == 1 && task.corners_b == 3) return overlaps_of<1, 3, false>(task, pairs, count, out, room, found);
  if (task.same) return overlaps_of<0, 0, true>(task, pairs, count, out, room, found);
  return overlaps_of<0, 0, false>(task, pairs, count, out, room, found);
}

}  // namespace

const OverlapOperations& ERGON_OVERLAPS(ERGON_LANES)() {
  static const OverlapOperations operations{overlaps};
  return operations;
}

}  // namespace ergon::lanes
