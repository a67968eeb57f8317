// gather and to_rows of evaluate_block.h for floats, inside of its namespace. Rows in memory are doubles.

typedef float ShortRow __attribute__((vector_size(16)));

#if ERGON_LANES == 1

inline Vector3 gather_rows(const ShortRow* rows) { return {{rows[0][0], rows[0][1], rows[0][2]}}; }
inline void to_rows(Real x, Real y, Real z, Row* lane) { lane[0] = Row{x, y, z, 0}; }

#else

// Four rows side by side make a vector; quarter j of vector i is row 4j + i. Within quarters, four such vectors are
// transposed to the four components, and back.
#if ERGON_LANES == 4
#define ERGON_QUARTERS(pattern) pattern(0)
#elif ERGON_LANES == 8
#define ERGON_QUARTERS(pattern) pattern(0), pattern(4)
#else
#define ERGON_QUARTERS(pattern) pattern(0), pattern(4), pattern(8), pattern(12)
#endif
#define ERGON_LOW(i) i, kWidth + i, i + 1, kWidth + i + 1
#define ERGON_HIGH(i) i + 2, kWidth + i + 2, i + 3, kWidth + i + 3

inline void transpose_quarters(Real (&v)[4]) {
  const Real low02 = __builtin_shufflevector(v[0], v[2], ERGON_QUARTERS(ERGON_LOW));
  const Real high02 = __builtin_shufflevector(v[0], v[2], ERGON_QUARTERS(ERGON_HIGH));
  const Real low13 = __builtin_shufflevector(v[1], v[3], ERGON_QUARTERS(ERGON_LOW));
  const Real high13 = __builtin_shufflevector(v[1], v[3], ERGON_QUARTERS(ERGON_HIGH));
  v[0] = __builtin_shufflevector(low02, low13, ERGON_QUARTERS(ERGON_LOW));
  v[1] = __builtin_shufflevector(low02, low13, ERGON_QUARTERS(ERGON_HIGH));
  v[2] = __builtin_shufflevector(high02, high13, ERGON_QUARTERS(ERGON_LOW));
  v[3] = __builtin_shufflevector(high02, high13, ERGON_QUARTERS(ERGON_HIGH));
}

inline Vector3 gather_rows(const ShortRow* rows) {
  Real v[4];
  for (int i = 0; i < 4; ++i) {
#if ERGON_LANES == 4
    v[i] = rows[i];
#elif ERGON_LANES == 8
    v[i] = __builtin_shufflevector(rows[i], rows[4 + i], 0, 1, 2, 3, 4, 5, 6, 7);
#else
    typedef float Half __attribute__((vector_size(32)));
    const Half low = __builtin_shufflevector(rows[i], rows[4 + i], 0, 1, 2, 3, 4, 5, 6, 7);
    const Half high = __builtin_shufflevector(rows[8 + i], rows[12 + i], 0, 1, 2, 3, 4, 5, 6, 7);
    v[i] = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#endif
  }
  transpose_quarters(v);
  return {{v[0], v[1], v[2]}};
}

inline void to_rows(Real x, Real y, Real z, Row* lane) {
  Real v[4] = {x, y, z, Real{}};
  transpose_quarters(v);
  for (int i = 0; i < 4; ++i) {
#if ERGON_LANES == 4
    lane[i] = __builtin_convertvector(v[i], Row);
#else
    lane[i] = __builtin_convertvector(__builtin_shufflevector(v[i], v[i], 0, 1, 2, 3), Row);
    lane[4 + i] = __builtin_convertvector(__builtin_shufflevector(v[i], v[i], 4, 5, 6, 7), Row);
#if ERGON_LANES == 16
    lane[8 + i] = __builtin_convertvector(__builtin_shufflevector(v[i], v[i], 8, 9, 10, 11), Row);
    lane[12 + i] = __builtin_convertvector(__builtin_shufflevector(v[i], v[i], 12, 13, 14, 15), Row);
#endif
#endif
  }
}

#endif

inline Vector3 gather(const double* rows, const int* vertices) {
  ShortRow row[kWidth];
  for (int l = 0; l < kWidth; ++l) row[l] = __builtin_convertvector(row_at(rows, 4L * vertices[l]), ShortRow);
  return gather_rows(row);
}

// Relative to other vertices, from which they are subtracted before rounding.
inline Vector3 gather(const double* rows, const int* vertices, const int* origins) {
  ShortRow row[kWidth];
  for (int l = 0; l < kWidth; ++l) {
    row[l] = __builtin_convertvector(row_at(rows, 4L * vertices[l]) - row_at(rows, 4L * origins[l]), ShortRow);
  }
  return gather_rows(row);
}
