#pragma once
// ERGON_LANES adjacent doubles, or floats where ERGON_SINGLE is defined, as one value, with the few operations that
// evaluation and projections need. It establishes that the
// same text compiles to scalar code, to vectors with vector masks, and to vectors with mask registers.
//
// Everything is in an unnamed namespace: code for one width must never be merged with that of another by the linker.

#ifndef ERGON_LANES
#error "files in runtime/lanes are compiled once per width, with -DERGON_LANES=1, 2, 4 or 8 (16 of floats)"
#endif
#ifdef ERGON_SINGLE
#define ERGON_VECTOR_BYTES (4 * ERGON_LANES)
#else
#define ERGON_VECTOR_BYTES (8 * ERGON_LANES)
#endif
#if (ERGON_VECTOR_BYTES == 64 && defined(__AVX512F__) && defined(__AVX512DQ__)) || \
    (ERGON_VECTOR_BYTES == 32 && defined(__AVX__))
#include <immintrin.h>
#elif ERGON_VECTOR_BYTES == 16 && defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace ergon::lanes {
namespace {

constexpr int kWidth = ERGON_LANES;
constexpr unsigned kAllLanes = (1u << kWidth) - 1;

#ifdef ERGON_SINGLE
using Scalar = float;
constexpr Scalar kNegligible = 1e-30f,
                 kHuge = 1e30f;     // below and above what is worth telling apart from 0 and infinity
constexpr Scalar kShift = 2.5e-7f;  // of the test for definiteness, in projection.h
#else
using Scalar = double;
constexpr Scalar kNegligible = 1e-290, kHuge = 1e290;
constexpr Scalar kShift = 5e-16;
#endif

#if ERGON_LANES == 1

using Real = Scalar;
using Mask = bool;
inline Real splat(Scalar a) { return a; }
inline Mask less(Real a, Real b) { return a < b; }
inline Mask less_equal(Real a, Real b) { return a <= b; }
inline Real select(Mask m, Real a, Real b) { return m ? a : b; }
inline Mask both(Mask a, Mask b) { return a && b; }
inline Mask either(Mask a, Mask b) { return a || b; }
inline Mask negate(Mask a) { return !a; }
inline unsigned bits(Mask a) { return a; }
inline Mask from_bits(unsigned lanes) { return lanes & 1; }
inline Real abs(Real a) { return a < 0 ? -a : a; }
inline Real sqrt(Real a) { return static_cast<Real>(__builtin_sqrt(a)); }
inline Real rsqrt(Real a) { return 1 / sqrt(a); }
inline Real copysign(Real a, Real b) { return __builtin_copysign(a, b); }
inline Real half_sign_product(Real a, Real b) { return __builtin_copysign(0.5, a * b); }

#elif defined(ERGON_SINGLE)
#include "runtime/lanes/vector_single.h"
#else

typedef double Real __attribute__((vector_size(8 * ERGON_LANES)));
typedef long long Integer __attribute__((vector_size(8 * ERGON_LANES)));
inline Real splat(double a) { return a - Real{}; }
constexpr Integer kMagnitude = Integer{} + 0x7fffffffffffffffLL;
inline Real abs(Real a) { return (Real)((Integer)a & kMagnitude); }
inline Real copysign(Real a, Real b) { return (Real)(((Integer)a & kMagnitude) | ((Integer)b & ~kMagnitude)); }
// 0.5 with the sign of a*b.
inline Real half_sign_product(Real a, Real b) {
  return (Real)((((Integer)a ^ (Integer)b) & ~kMagnitude) | (Integer)splat(0.5));
}

#if ERGON_LANES == 8 && defined(__AVX512F__) && defined(__AVX512DQ__)

struct Mask {
  __mmask8 k;
};
inline Mask less(Real a, Real b) { return {_mm512_cmp_pd_mask(a, b, _CMP_LT_OQ)}; }
inline Mask less_equal(Real a, Real b) { return {_mm512_cmp_pd_mask(a, b, _CMP_LE_OQ)}; }
inline Real select(Mask m, Real a, Real b) { return _mm512_mask_blend_pd(m.k, b, a); }
inline Mask both(Mask a, Mask b) { return {static_cast<__mmask8>(a.k & b.k)}; }
inline Mask either(Mask a, Mask b) { return {static_cast<__mmask8>(a.k | b.k)}; }
inline Mask negate(Mask a) { return {static_cast<__mmask8>(~a.k)}; }
inline unsigned bits(Mask a) { return a.k; }
inline Mask from_bits(unsigned lanes) { return {static_cast<__mmask8>(lanes)}; }
inline Real sqrt(Real a) { return _mm512_maskz_sqrt_pd(0xff, a); }

// 1/sqrt(a) for positive normal a: 14 bits from the processor, then one step of fourth order. Two units in the last
// place.
inline Real rsqrt(Real a) {
  Real y = _mm512_maskz_rsqrt14_pd(0xff, a);
  Real h = 1 - a * y * y;
  return y + y * h * (0.5 + h * (0.375 + h * 0.3125));
}

#else

using Mask = Integer;
inline Mask less(Real a, Real b) { return a < b; }
inline Mask less_equal(Real a, Real b) { return a <= b; }
inline Real select(Mask m, Real a, Real b) { return m ? a : b; }
inline Mask both(Mask a, Mask b) { return a & b; }
inline Mask either(Mask a, Mask b) { return a | b; }
inline Mask negate(Mask a) { return ~a; }
inline Mask from_bits(unsigned lanes) {
  Mask m;
  for (int l = 0; l < kWidth; ++l) m[l] = -static_cast<long long>(lanes >> l & 1);
  return m;
}
#if ERGON_LANES == 4 && defined(__AVX__)
inline unsigned bits(Mask a) { return static_cast<unsigned>(_mm256_movemask_pd((Real)a)); }
inline Real sqrt(Real a) { return _mm256_sqrt_pd(a); }
#elif ERGON_LANES == 2 && defined(__SSE2__)
inline unsigned bits(Mask a) { return static_cast<unsigned>(_mm_movemask_pd((Real)a)); }
inline Real sqrt(Real a) { return _mm_sqrt_pd(a); }
#else
inline unsigned bits(Mask a) {
  unsigned b = 0;
  for (int l = 0; l < kWidth; ++l) b |= static_cast<unsigned>(a[l] & 1) << l;
  return b;
}
inline Real sqrt(Real a) {
  for (int l = 0; l < kWidth; ++l) a[l] = __builtin_sqrt(a[l]);
  return a;
}
#endif
inline Real rsqrt(Real a) { return 1 / sqrt(a); }

#endif
#endif

inline bool any(Mask m) { return bits(m) != 0; }
// A NaN in a is dropped.
inline Real max(Real a, Real b) { return select(less(b, a), a, b); }
inline Real min(Real a, Real b) { return select(less(a, b), a, b); }

// Sum of a[i]*b[i] over i < n, in four parts so that they need not wait for each other.
template <int n>
inline Real dot(const Real* a, const Real* b) {
  Real s[4] = {splat(0), splat(0), splat(0), splat(0)};
#pragma GCC unroll 12
  for (int i = 0; i < n; ++i) s[i & 3] += a[i] * b[i];
  return (s[0] + s[1]) + (s[2] + s[3]);
}

// p is aligned to 64 bytes, or to the vector where that is smaller.
constexpr int kAligned = sizeof(Real) < 64 ? sizeof(Real) : 64;
inline Real load(const Scalar* p) {
  Real a;
  __builtin_memcpy(&a, __builtin_assume_aligned(p, kAligned), sizeof(a));
  return a;
}
inline void store(Scalar* p, Real a) { __builtin_memcpy(__builtin_assume_aligned(p, kAligned), &a, sizeof(a)); }
#ifdef ERGON_SINGLE
// What is kept in doubles, rounded.
inline Real load(const double* p) {
#if ERGON_LANES == 1
  return static_cast<float>(*p);
#else
  typedef double Wide __attribute__((vector_size(8 * ERGON_LANES)));
  Wide a;
  __builtin_memcpy(&a, __builtin_assume_aligned(p, 8 * kWidth < 64 ? 8 * kWidth : 64), sizeof(a));
  return __builtin_convertvector(a, Real);
#endif
}
#endif

}  // namespace
}  // namespace ergon::lanes
