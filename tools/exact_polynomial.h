#pragma once
// Polynomials in one unknown with whole coefficients, and their signs at the roots of others. Everything is exact.

#include <gmpxx.h>

#include <vector>

namespace ergon::exact {

// (number, number + 1]/2^halvings; of the root 0 alone: [0, 0].
struct RootInterval {
  mpz_class number;
  unsigned long halvings = 0;
  bool zero = false;
};

// Coefficients from the constant on; the last is not zero, and zero has none.
class Polynomial {
 public:
  Polynomial() = default;
  explicit Polynomial(std::vector<mpz_class> coefficients);
  bool zero() const { return c_.empty(); }
  size_t degree() const { return c_.empty() ? 0 : c_.size() - 1; }
  int sign_at(const mpz_class& number, unsigned long halvings) const;  // at number/2^halvings
  // 1 or -1 where rounded arithmetic shows the sign on the whole interval, else 0.
  int sign_on(const RootInterval& interval) const;
  Polynomial derivative() const;
  friend Polynomial operator+(const Polynomial& a, const Polynomial& b);
  friend Polynomial operator-(const Polynomial& a, const Polynomial& b);
  friend Polynomial operator*(const Polynomial& a, const Polynomial& b);
  // m*a = quotient*b + rest for some m > 0; b is not zero. The factors that rest's coefficients have in common are
  // gone.
  friend Polynomial divide(const Polynomial& a, const Polynomial& b, Polynomial& rest);

 private:
  std::vector<mpz_class> c_;
};

// One root of a polynomial without repeated roots.
struct Root {
  Polynomial of;
  RootInterval in;
};
// All different roots in [0, 1] of a polynomial that is not zero.
std::vector<Root> roots(const Polynomial& f);
int sign_at(const Polynomial& f, const Root& root);

}  // namespace ergon::exact
