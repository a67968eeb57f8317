#pragma once
// Numbers of twice the precision of double, as unevaluated sums of two doubles, and the exact sums and products that
// they are made of. It establishes relative errors below 2^-102 of every sum, product and quotient that neither
// overflows nor underflows.
// Source: Joldes, Muller, Popescu 2017, Tight and Rigorous Error Bounds for Basic Building Blocks of Double-Word
// Arithmetic, TOMS 44(2), algorithm 6 for sums and the products beside it.

#include <cmath>

namespace ergon {

struct DoubleDouble {
  double head = 0, tail = 0;  // head is the sum, rounded
  DoubleDouble() = default;
  DoubleDouble(double value) : head(value) {}
  DoubleDouble(double h, double t) : head(h), tail(t) {}
  explicit operator double() const { return head; }
};

// a + b = head + tail, exactly.
inline DoubleDouble two_sum(double a, double b) {
  const double sum = a + b, b_part = sum - a, a_part = sum - b_part;
  return {sum, (a - a_part) + (b - b_part)};
}
// The same for |a| >= |b| or a = 0.
inline DoubleDouble quick_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}
// a*b = head + tail, exactly unless the tail underflows.
inline DoubleDouble two_product(double a, double b) {
  const double product = a * b;
#ifdef __FP_FAST_FMA
  return {product, std::fma(a, b, -product)};
#else  // Dekker: halves of 26 bits have exact products
  const double big_a = 134217729.0 * a, big_b = 134217729.0 * b;
  const double a1 = big_a - (big_a - a), a0 = a - a1;
  const double b1 = big_b - (big_b - b), b0 = b - b1;
  return {product, a0 * b0 - (((product - a1 * b1) - a0 * b1) - a1 * b0)};
#endif
}

inline DoubleDouble operator-(const DoubleDouble& a) { return {-a.head, -a.tail}; }
inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble s = two_sum(a.head, b.head), t = two_sum(a.tail, b.tail);
  const DoubleDouble v = quick_two_sum(s.head, s.tail + t.head);
  return quick_two_sum(v.head, t.tail + v.tail);
}
inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }
inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble p = two_product(a.head, b.head);
  return quick_two_sum(p.head, p.tail + (a.head * b.tail + a.tail * b.head));
}
inline DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double quotient = a.head / b.head;
  const DoubleDouble rest = a - b * DoubleDouble(quotient);
  return quick_two_sum(quotient, rest.head / b.head);
}
inline bool operator<(const DoubleDouble& a, const DoubleDouble& b) {
  return a.head < b.head || (a.head == b.head && a.tail < b.tail);
}
inline bool operator>(const DoubleDouble& a, const DoubleDouble& b) { return b < a; }

}  // namespace ergon
