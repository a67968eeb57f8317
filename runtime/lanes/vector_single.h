// The middle of projection_vector.h for floats, inside of its namespace.

typedef float Real __attribute__((vector_size(4 * ERGON_LANES)));
typedef int Integer __attribute__((vector_size(4 * ERGON_LANES)));
inline Real splat(float a) { return a - Real{}; }
constexpr Integer kMagnitude = Integer{} + 0x7fffffff;
inline Real abs(Real a) { return (Real)((Integer)a & kMagnitude); }
inline Real copysign(Real a, Real b) { return (Real)(((Integer)a & kMagnitude) | ((Integer)b & ~kMagnitude)); }

#if ERGON_LANES == 16 && defined(__AVX512F__) && defined(__AVX512DQ__)

struct Mask {
  __mmask16 k;
};
inline Mask less(Real a, Real b) { return {_mm512_cmp_ps_mask(a, b, _CMP_LT_OQ)}; }
inline Mask less_equal(Real a, Real b) { return {_mm512_cmp_ps_mask(a, b, _CMP_LE_OQ)}; }
inline Real select(Mask m, Real a, Real b) { return _mm512_mask_blend_ps(m.k, b, a); }
inline Mask both(Mask a, Mask b) { return {static_cast<__mmask16>(a.k & b.k)}; }
inline Mask either(Mask a, Mask b) { return {static_cast<__mmask16>(a.k | b.k)}; }
inline Mask negate(Mask a) { return {static_cast<__mmask16>(~a.k)}; }
inline unsigned bits(Mask a) { return a.k; }
inline Mask from_bits(unsigned lanes) { return {static_cast<__mmask16>(lanes)}; }
inline Real sqrt(Real a) { return _mm512_maskz_sqrt_ps(0xffff, a); }

// 1/sqrt(a) for positive normal a: 14 bits from the processor, then one Newton step. Two units in the last place.
inline Real rsqrt(Real a) {
  const Real y = _mm512_maskz_rsqrt14_ps(0xffff, a);
  return y + y * (1 - a * y * y) * 0.5f;
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
  for (int l = 0; l < kWidth; ++l) m[l] = -static_cast<int>(lanes >> l & 1);
  return m;
}
#if ERGON_LANES == 8 && defined(__AVX__)
inline unsigned bits(Mask a) { return static_cast<unsigned>(_mm256_movemask_ps((Real)a)); }
inline Real sqrt(Real a) { return _mm256_sqrt_ps(a); }
#elif ERGON_LANES == 4 && defined(__SSE2__)
inline unsigned bits(Mask a) { return static_cast<unsigned>(_mm_movemask_ps((Real)a)); }
inline Real sqrt(Real a) { return _mm_sqrt_ps(a); }
#else
inline unsigned bits(Mask a) {
  unsigned b = 0;
  for (int l = 0; l < kWidth; ++l) b |= static_cast<unsigned>(a[l] & 1) << l;
  return b;
}
inline Real sqrt(Real a) {
  for (int l = 0; l < kWidth; ++l) a[l] = __builtin_sqrtf(a[l]);
  return a;
}
#endif
inline Real rsqrt(Real a) { return 1 / sqrt(a); }

#endif
