#include "tools/exact_polynomial.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ergon::exact {
namespace {

std::vector<mpz_class> without_common_factor(std::vector<mpz_class> c) {
  mpz_class common = 0;
  for (const mpz_class& x : c) common = gcd(common, x);
  if (common > 1) {
    for (mpz_class& x : c) x /= common;
  }
  return c;
}

Polynomial greatest_common_divisor(Polynomial a, Polynomial b) {
  while (!b.zero()) {
    Polynomial rest;
    divide(a, b, rest);
    a = std::exchange(b, std::move(rest));
  }
  return a;
}

Polynomial without_repeated_roots(const Polynomial& f) {
  if (f.degree() < 2) return f;
  const Polynomial common = greatest_common_divisor(f, f.derivative());
  Polynomial rest;
  return common.degree() == 0 ? f : divide(f, common, rest);
}

// Sturm's theorem: f, without repeated roots, has as many in (a, b] as its chain has more changes of sign at a than at
// b.
class SturmChain {
 public:
  explicit SturmChain(const Polynomial& f) : chain_{f} {
    if (f.degree() == 0) return;
    chain_.push_back(f.derivative());
    while (chain_.back().degree() > 0) {
      Polynomial rest;
      divide(chain_[chain_.size() - 2], chain_.back(), rest);
      chain_.push_back(Polynomial() - rest);
    }
  }
  int count(const RootInterval& in) const {
    return changes(in.number, in.halvings) - changes(in.number + 1, in.halvings);
  }

 private:
  int changes(const mpz_class& number, unsigned long halvings) const {
    int last = 0, count = 0;
    for (const Polynomial& f : chain_) {
      const int sign = f.sign_at(number, halvings);
      if (sign == 0) continue;
      if (last * sign < 0) ++count;
      last = sign;
    }
    return count;
  }
  std::vector<Polynomial> chain_;
};

RootInterval half(const RootInterval& in, int upper) { return {in.number * 2 + upper, in.halvings + 1, false}; }

void isolate(const Polynomial& f, const SturmChain& chain, const RootInterval& in, std::vector<Root>& found) {
  const int count = chain.count(in);
  if (count == 1) found.push_back({f, in});
  if (count <= 1) return;
  isolate(f, chain, half(in, 0), found);
  isolate(f, chain, half(in, 1), found);
}

}  // namespace

Polynomial::Polynomial(std::vector<mpz_class> coefficients) : c_(std::move(coefficients)) {
  while (!c_.empty() && c_.back() == 0) c_.pop_back();
}

int Polynomial::sign_at(const mpz_class& number, unsigned long halvings) const {
  mpz_class value = 0;
  for (size_t i = c_.size(); i-- > 0;) value = value * number + (c_[i] << (halvings * (c_.size() - 1 - i)));
  return sgn(value);
}

int Polynomial::sign_on(const RootInterval& in) const {
  if (c_.empty() || in.halvings > 48) return 0;
  long largest = 0;
  for (const mpz_class& c : c_) largest = std::max(largest, static_cast<long>(mpz_sizeinbase(c.get_mpz_t(), 2)));
  const double low = std::ldexp(in.number.get_d(), -static_cast<int>(in.halvings));
  const double width = in.zero ? 0 : std::ldexp(1, -static_cast<int>(in.halvings));
  double value = 0, size = 0, slope = 0;
  for (size_t i = c_.size(); i-- > 0;) {
    long exponent = 0;
    const double mantissa = mpz_get_d_2exp(&exponent, c_[i].get_mpz_t());
    const double c = std::ldexp(mantissa, static_cast<int>(std::max(exponent - largest, -1000L)));
    value = value * low + c;
    size += std::abs(c);
    slope += static_cast<double>(i) * std::abs(c);
  }
  const double error = 0x1p-45 * size + width * slope;  // at most 20 roundings, and the change over the interval
  return value > error ? 1 : value < -error ? -1 : 0;
}

Polynomial Polynomial::derivative() const {
  std::vector<mpz_class> c;
  for (size_t i = 1; i < c_.size(); ++i) c.push_back(c_[i] * static_cast<unsigned long>(i));
  return Polynomial(std::move(c));
}

Polynomial operator+(const Polynomial& a, const Polynomial& b) {
  std::vector<mpz_class> c(std::max(a.c_.size(), b.c_.size()));
  for (size_t i = 0; i < a.c_.size(); ++i) c[i] += a.c_[i];
  for (size_t i = 0; i < b.c_.size(); ++i) c[i] += b.c_[i];
  return Polynomial(std::move(c));
}

Polynomial operator-(const Polynomial& a, const Polynomial& b) {
  std::vector<mpz_class> c(std::max(a.c_.size(), b.c_.size()));
  for (size_t i = 0; i < a.c_.size(); ++i) c[i] += a.c_[i];
  for (size_t i = 0; i < b.c_.size(); ++i) c[i] -= b.c_[i];
  return Polynomial(std::move(c));
}

Polynomial operator*(const Polynomial& a, const Polynomial& b) {
  if (a.zero() || b.zero()) return {};
  std::vector<mpz_class> c(a.c_.size() + b.c_.size() - 1);
  for (size_t i = 0; i < a.c_.size(); ++i) {
    for (size_t j = 0; j < b.c_.size(); ++j) c[i + j] += a.c_[i] * b.c_[j];
  }
  return Polynomial(std::move(c));
}

Polynomial divide(const Polynomial& a, const Polynomial& b, Polynomial& rest) {
  std::vector<mpz_class> r = a.c_, q;
  const size_t n = b.c_.size();
  if (r.size() >= n) q.resize(r.size() - n + 1);
  const mpz_class lead = abs(b.c_.back());
  for (size_t i = q.size(); i-- > 0;) {
    const mpz_class factor = sgn(b.c_.back()) * r[i + n - 1];
    for (mpz_class& x : q) x *= lead;
    for (mpz_class& x : r) x *= lead;
    q[i] = factor;
    for (size_t j = 0; j < n; ++j) r[i + j] -= factor * b.c_[j];
  }
  rest = Polynomial(without_common_factor(std::move(r)));
  return Polynomial(without_common_factor(std::move(q)));
}

std::vector<Root> roots(const Polynomial& f) {
  std::vector<Root> found;
  const Polynomial simple = without_repeated_roots(f);
  if (simple.sign_at(0, 0) == 0) found.push_back({simple, {0, 0, true}});
  isolate(simple, SturmChain(simple), {0, 0, false}, found);
  return found;
}

int sign_at(const Polynomial& f, const Root& root) {
  if (f.zero()) return 0;
  RootInterval in = root.in;
  if (in.zero) return f.sign_at(0, 0);
  const int sign_above = root.of.sign_at(in.number + 1, in.halvings);
  if (sign_above == 0) return f.sign_at(in.number + 1, in.halvings);
  // Halves the interval; returns whether the root was met.
  const auto halve = [&] {
    const RootInterval upper = half(in, 1);
    const int sign = root.of.sign_at(upper.number, upper.halvings);
    in = sign == 0 || sign == sign_above ? half(in, 0) : upper;
    return sign == 0;
  };
  for (; in.halvings <= 48;) {
    const int sign = f.sign_on(in);
    if (sign != 0) return sign;
    if (halve()) return f.sign_at(in.number + 1, in.halvings);
  }
  const Polynomial common = without_repeated_roots(greatest_common_divisor(root.of, f));
  if (common.degree() > 0 && SturmChain(common).count(in) > 0) return 0;
  // f is not zero at the root: the interval shrinks until f has no root in it.
  const SturmChain chain(without_repeated_roots(f));
  while (chain.count(in) > 0) {
    if (halve()) break;
  }
  return f.sign_at(in.number + 1, in.halvings);
}

}  // namespace ergon::exact
